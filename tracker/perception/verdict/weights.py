"""How much does each quantity count? One table, fitted by `benchmarks/fit_verdict.py`.

Log-odds per unit of a quantity of `evidence`, by logistic regression around `fitting.PRIORS`. The
data: 370 photos of 24 people who call or do not (custom-gesture-dataset, MediaPipe and others,
14 looks each), 15 clips of signing, waving and ordinary life, 104 drawn scenes of callers at
1 to 5 m and of people who do something else (seed 901).
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from tracker.containers import FloatArray, IntArray, Refusal
from tracker.perception.verdict.evidence import NAMES

#: What is believed of a hand that was never seen, and how fast a belief fades to it, s.
FIRST_LOG_ODDS, FADE_S = -1.75, 2.0
#: Images of one hand are alike; each adds this share of its evidence.
IMAGE_SHARE = 0.5
#: No belief is stronger than this, so that a hand that goes down is soon noticed.
LOG_ODDS_MAX = 6.0
#: Wrists lower above the shoulder than the first, in widths of the shoulders, are not up; those
#: higher than the second are.
UP_SHOULDERS = (0.1, 0.3)
#: Of a hand that calls and is still up no image tells more than this against it, and of one that
#: is not up none tells more than that for it.
STILL_UP_MIN, NOT_UP_MAX = -0.5, 0.75
#: The log-odds of a hand of which every quantity is 0.
BIAS = -3.28


class Weight(NamedTuple):
    """One row of the table.

    Attributes:
        log_odds: For a unit of the quantity.
        reason: What to say where this speaks most against a call.
    """

    log_odds: float
    reason: Refusal = Refusal.NOT_UP


WEIGHTS: dict[str, Weight] = {
    "found": Weight(0.64),
    "score": Weight(0.53, Refusal.UNSURE),
    "rise": Weight(1.37),
    "lean": Weight(-0.98, Refusal.LEANS),
    "spread": Weight(0.22),
    "thumb": Weight(-2.86),
    "owned": Weight(0.51),
    "unowned": Weight(-0.29, Refusal.OWNER_UNKNOWN),
    "alone": Weight(2.32),
    "low": Weight(-4.23, Refusal.BELOW_SHOULDERS),
    "palm_low": Weight(-2.26, Refusal.BELOW_SHOULDERS),
    "high": Weight(3.68),
    "overhead": Weight(1.36),
    "forearm": Weight(3.64, Refusal.ARM_DOWN),
    "head": Weight(-5.50, Refusal.AT_HEAD),
    "fist_low": Weight(-1.20, Refusal.BELOW_SHOULDERS),
    "palm_on_head": Weight(-4.17, Refusal.AT_HEAD),
    "inside": Weight(-2.19, Refusal.BEFORE_BODY),
    "together": Weight(-2.05, Refusal.BEFORE_BODY),
    "doubt": Weight(-1.05, Refusal.OWNER_UNKNOWN),
    "faint": Weight(-4.60, Refusal.OWNER_UNKNOWN),
    "apart": Weight(-1.03, Refusal.OWNER_UNKNOWN),
    "swing": Weight(3.00),
}
_LOG_ODDS = np.array([WEIGHTS[name].log_odds for name in NAMES])
_REASONS = np.array([WEIGHTS[name].reason for name in NAMES])


def log_odds(evidence: FloatArray) -> FloatArray:
    """The log-odds of one image that each hand calls, shape (H,).

    Args:
        evidence: Shape (H, F), in the order of `NAMES`.
    """
    return np.asarray(BIAS + evidence @ _LOG_ODDS)


def reasons(evidence: FloatArray) -> IntArray:
    """What spoke most against each hand, shape (H,): of `Refusal`.

    Args:
        evidence: Shape (H, F), in the order of `NAMES`.
    """
    return np.asarray(_REASONS[np.argmin(evidence * _LOG_ODDS, axis=1)], dtype=np.int64)
