"""How much does each quantity count? One table, fitted by `benchmarks/fit_verdict.py`.

Log-odds per unit of a quantity of `evidence`, by logistic regression with a ridge.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from tracker.containers import FloatArray, IntArray, Refusal
from tracker.perception.verdict.evidence import NAMES

#: What is believed of a hand that was never seen, and how fast a belief fades to it, s.
FIRST_LOG_ODDS, FADE_S = -2.0, 0.7
#: Images of one hand are alike; each adds this share of its evidence.
IMAGE_SHARE = 0.5
#: No belief is stronger than this, so that a hand that goes down is soon noticed.
LOG_ODDS_MAX = 5.0
#: The log-odds of a hand of which every quantity is 0.
BIAS = -3.62


class Weight(NamedTuple):
    """One row of the table.

    Attributes:
        log_odds: For a unit of the quantity.
        reason: What to say where this speaks most against a call.
    """

    log_odds: float
    reason: Refusal = Refusal.NOT_UP


WEIGHTS: dict[str, Weight] = {
    "found": Weight(0.98),
    "score": Weight(0.64, Refusal.UNSURE),
    "small": Weight(0.0, Refusal.UNSURE),
    "rise": Weight(1.40),
    "lean": Weight(-1.06, Refusal.LEANS),
    "fingers": Weight(0.0),
    "longest": Weight(0.0),
    "spread": Weight(0.12),
    "thumb": Weight(-2.90),
    "owned": Weight(0.59),
    "unowned": Weight(-0.33, Refusal.OWNER_UNKNOWN),
    "alone": Weight(2.26),
    "low": Weight(-4.14, Refusal.BELOW_SHOULDERS),
    "palm_low": Weight(-2.23, Refusal.BELOW_SHOULDERS),
    "high": Weight(3.56),
    "overhead": Weight(1.12),
    "forearm": Weight(3.58, Refusal.ARM_DOWN),
    "head": Weight(-5.46, Refusal.AT_HEAD),
    "fist_low": Weight(-1.20, Refusal.BELOW_SHOULDERS),
    "palm_on_head": Weight(-4.17, Refusal.AT_HEAD),
    "inside": Weight(-2.25, Refusal.BEFORE_BODY),
    "together": Weight(-2.07, Refusal.BEFORE_BODY),
    "doubt": Weight(-0.71, Refusal.OWNER_UNKNOWN),
    "faint": Weight(-2.89, Refusal.OWNER_UNKNOWN),
    "apart": Weight(-1.03, Refusal.OWNER_UNKNOWN),
    "swing": Weight(0.90),
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
