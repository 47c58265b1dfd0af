import numpy as np

from tracker.containers import Refusal
from tracker.perception.verdict.weights import BIAS, NAMES, WEIGHTS, log_odds, reasons


def row(**quantities):
    return np.array([[quantities.get(name, 0.0) for name in NAMES]])


def test_evidence_adds_up():
    assert log_odds(row()).tolist() == [BIAS]
    both = log_odds(row(high=1.0, head=0.5))
    np.testing.assert_allclose(
        both, BIAS + WEIGHTS["high"].log_odds + WEIGHTS["head"].log_odds / 2
    )


def test_what_speaks_most_against_a_hand_is_the_reason():
    assert reasons(row(high=1.0, head=1.0)).tolist() == [Refusal.AT_HEAD]
    assert reasons(row(low=1.0, fingers=1.0)).tolist() == [Refusal.BELOW_SHOULDERS]
    assert reasons(np.zeros((0, len(NAMES)))).tolist() == []


def test_weights_have_the_signs_that_their_meaning_asks_for():
    against = {"lean", "low", "head", "inside", "together", "apart"}
    assert all(WEIGHTS[name].log_odds <= 0.0 for name in against)
    assert all(WEIGHTS[name].log_odds >= 0.0 for name in ("rise", "high", "overhead", "forearm"))
