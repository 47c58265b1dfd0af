"""Does this hand call, by all images so far? A filter with two states, in log-odds."""

from __future__ import annotations

import numpy as np

#: What is believed of a hand that was never seen, and how fast a belief fades to it, s: what ten
#: images of a second have said alike, ten more do not make surer. With 2 s throughout, near people
#: who talk or telephone were raised five times as often (in 45 minutes drawn), and no more callers
#: were found. A hand that calls is believed longer, as the evidence of a wave comes and goes.
FIRST_LOG_ODDS, FADE_S, CALL_FADES_S = -1.75, 1.0, 2.0
#: A hand begins to call when so much is believed of it, and calls until less than nothing is.
CALLS_FROM = 1.0
#: Images of one hand are alike; each adds this share of its evidence.
IMAGE_SHARE = 0.5
#: One image alone makes no call of a new hand, whatever it shows, since a pose that was misread
#: lasts for one: less than (CALLS_FROM - FIRST_LOG_ODDS) / IMAGE_SHARE.
IMAGE_MAX = 5.4
#: No belief is weaker or stronger, so that a hand that goes up, or down, is soon noticed.
LOG_ODDS_MIN, LOG_ODDS_MAX = -3.0, 6.0
#: Wrists lower above the shoulder than the first, in widths of the shoulders, are not up; those
#: higher than the second are.
UP_SHOULDERS = (0.1, 0.3)
#: Of a hand that calls and is still up no image tells more than this against it, and of one that
#: is not up none tells more than that for it.
STILL_UP_MIN, NOT_UP_MAX = -0.5, 0.75
#: Without a new look at the owner, an image adds no more evidence for a call than this. A hand on
#: its way to a telephone is beside the head for a moment; the next look at the body shows that.
OLD_LOOK_MAX = 0.75


def update_belief(
    before: float,
    passed_s: float,
    evidence: float,
    high_shoulders: float = np.nan,
    is_old_look: bool = False,
) -> float:
    """The log-odds that a hand calls, after one more image.

    Without evidence a belief fades toward what is believed of a hand that was never seen. Images
    of one hand are alike: each adds but a share of its evidence.

        l' = l0 + (l - l0) exp(-dt / tau);   l = l' + share * evidence

    Args:
        before: Log-odds before this image; NaN for a hand that is new.
        passed_s: Since then.
        evidence: Log-odds of this image alone.
        high_shoulders: How far the wrist is above the shoulder, in their widths, or how surely it
            waves; NaN where nobody knows. A hand that called a moment ago and is still up may pass
            before the face: it is given up but slowly. One that is not up must stay: hands of
            people who talk show their palms for half a second.
        is_old_look: What is known of the owner is known from an earlier image.
    """
    evidence = min(evidence, OLD_LOOK_MAX if is_old_look else IMAGE_MAX)
    if high_shoulders > UP_SHOULDERS[1] and before > 0.0:
        evidence = max(evidence, STILL_UP_MIN)
    if high_shoulders < UP_SHOULDERS[0]:
        evidence = min(evidence, NOT_UP_MAX)
    faded = FIRST_LOG_ODDS
    if np.isfinite(before):
        fade_s = CALL_FADES_S if before >= CALLS_FROM else FADE_S
        faded += (before - FIRST_LOG_ODDS) * float(np.exp(-max(passed_s, 0.0) / fade_s))
    return float(np.clip(faded + IMAGE_SHARE * evidence, LOG_ODDS_MIN, LOG_ODDS_MAX))
