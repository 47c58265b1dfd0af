"""How much does each quantity count? One table, fitted by `benchmarks/fit_verdict.py`.

Log-odds per unit of a quantity of `evidence`, by logistic regression around what is known
beforehand. The data: 370 photos of 24 people who call or do not (custom-gesture-dataset, MediaPipe
and others, 14 looks each), 15 clips of signing, waving and ordinary life, 128 drawn scenes of
callers at 1 to 5 m and of people who do something else (seed 901).
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from tracker.containers import FloatArray, IntArray, Refusal

#: The log-odds of a hand of which every quantity is 0.
BIAS = -3.60


class Weight(NamedTuple):
    """One row of the table.

    Attributes:
        log_odds: For a unit of the quantity.
        prior: What is supposed of it before any data, by what the quantity means; the weight
            keeps this sign, where it has one.
        stiffness: How much it takes to move it from there; 1 is broad. Few people show fingers,
            swing their hand or stand far away, so that those weights should follow few data.
        reason: What to say where this speaks most against a call.
    """

    log_odds: float
    prior: float
    stiffness: float = 1.0
    reason: Refusal = Refusal.NOT_UP


WEIGHTS = {
    "found": Weight(1.00, 0.0),
    "score": Weight(0.59, 1.0, 10.0, Refusal.UNSURE),
    "rise": Weight(1.53, 2.0, 10.0),
    "lean": Weight(-0.85, -1.0, reason=Refusal.LEANS),
    "spread": Weight(0.13, 0.4, 5.0),
    "thumb": Weight(-3.33, -2.0),
    "owned": Weight(0.34, 0.0),
    "unowned": Weight(-0.17, -1.0, reason=Refusal.OWNER_UNKNOWN),
    "alone": Weight(1.65, 2.0),
    "low": Weight(-4.55, -3.0, reason=Refusal.BELOW_SHOULDERS),
    "palm_low": Weight(-2.28, -2.0, 5.0, Refusal.BELOW_SHOULDERS),
    "high": Weight(4.61, 3.0),
    "fist_low": Weight(-1.83, -2.0, reason=Refusal.BELOW_SHOULDERS),
    "overhead": Weight(1.46, 2.0),
    "forearm": Weight(3.74, 2.0, reason=Refusal.ARM_DOWN),
    "head": Weight(-7.82, -8.0, 10.0, Refusal.AT_HEAD),
    "inside": Weight(-1.94, -2.0, reason=Refusal.BEFORE_BODY),
    "together": Weight(-2.02, -2.0, 10.0, Refusal.BEFORE_BODY),
    "doubt": Weight(-1.21, -0.5, reason=Refusal.OWNER_UNKNOWN),
    "faint": Weight(-4.86, -4.0, reason=Refusal.OWNER_UNKNOWN),
    "apart": Weight(-1.05, -1.0, 10.0, Refusal.OWNER_UNKNOWN),
    "swing": Weight(3.00, 3.0, 10.0),
}
#: The names of the quantities, in the order of the columns.
NAMES = tuple(WEIGHTS)
_LOG_ODDS = np.array([row.log_odds for row in WEIGHTS.values()])
_REASONS = np.array([row.reason for row in WEIGHTS.values()])


def log_odds(evidence: FloatArray) -> FloatArray:
    """The log-odds of one image that each hand calls, (H,); from evidence of shape (H, F)."""
    return np.asarray(BIAS + evidence @ _LOG_ODDS)


def reasons(evidence: FloatArray) -> IntArray:
    """What spoke most against each hand, (H,): of `Refusal`; from evidence of shape (H, F)."""
    return np.asarray(_REASONS[np.argmin(evidence * _LOG_ODDS, axis=1)], dtype=np.int64)
