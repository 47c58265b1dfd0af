"""Does this hand call, after all that was seen of it? A filter of two states, in log-odds."""

from __future__ import annotations

import numpy as np

from tracker.perception.verdict.weights import (
    FADE_S,
    FIRST_LOG_ODDS,
    IMAGE_SHARE,
    LOG_ODDS_MAX,
    STILL_UP_MIN,
)


def update_belief(
    before: float, passed_s: float, evidence: float, *, is_up: bool = False
) -> float:
    """The log-odds that a hand calls, after one more image.

    Without evidence a belief fades toward what is believed of a hand that was never seen. Images
    of one hand are alike: each adds but a share of its evidence.

        l' = l0 + (l - l0) exp(-dt / tau);   l = l' + share * evidence

    Args:
        before: Log-odds before this image; NaN for a hand that is new.
        passed_s: Since then.
        evidence: Log-odds of this image alone.
        is_up: Whether the wrist is above the shoulder: a hand that called a moment ago and is
            still up may pass before the face, as in a wave; it is given up but slowly.
    """
    if is_up and before > 0.0:
        evidence = max(evidence, STILL_UP_MIN)
    faded = FIRST_LOG_ODDS
    if np.isfinite(before):
        faded += (before - FIRST_LOG_ODDS) * float(np.exp(-passed_s / FADE_S))
    return float(np.clip(faded + IMAGE_SHARE * evidence, -LOG_ODDS_MAX, LOG_ODDS_MAX))
