import numpy as np
import pytest

from tracker.perception.verdict.belief import (
    CALLS_FROM,
    FIRST_LOG_ODDS,
    IMAGE_SHARE,
    LOG_ODDS_MAX,
    LOG_ODDS_MIN,
    update_belief,
)


def after(evidence, images, before=float("nan"), passed_s=0.1):
    for _ in range(images):
        before = update_belief(before, passed_s, evidence)
    return before


def test_a_new_hand_begins_with_what_is_believed_of_any(upright_hand):
    assert after(0.0, 1) == FIRST_LOG_ODDS < 0.0
    assert after(1.0, 1) == pytest.approx(FIRST_LOG_ODDS + IMAGE_SHARE)


def test_images_that_speak_for_a_call_add_up_to_a_limit():
    beliefs = [after(2.0, images) for images in range(1, 30)]
    assert np.all(np.diff(beliefs) >= 0.0)
    assert beliefs[0] < 0.0 < beliefs[-1] <= LOG_ODDS_MAX


def test_one_odd_image_changes_no_settled_mind():
    assert update_belief(after(4.0, 10), 0.1, -3.0) > 0.0
    assert update_belief(after(-4.0, 10), 0.1, 3.0) < 0.0


def test_a_belief_without_evidence_fades_to_the_first():
    assert update_belief(5.0, 30.0, 0.0) == pytest.approx(FIRST_LOG_ODDS, abs=1e-3)
    assert FIRST_LOG_ODDS < update_belief(5.0, 0.5, 0.0) < 5.0


def test_a_hand_that_goes_down_is_down_within_half_a_second():
    assert after(-4.0, 5, before=LOG_ODDS_MAX) < 0.0


def test_a_hand_that_was_at_the_face_for_long_calls_soon_once_it_goes_up():
    assert after(-9.0, 30) == LOG_ODDS_MIN
    assert after(4.0, 3, before=LOG_ODDS_MIN) > 0.0


def test_a_hand_of_which_nobody_knows_the_shoulder_need_not_stay():
    assert after(3.0, 3) > 0.0 > update_belief(float("nan"), 0.1, 3.0, 0.0)


def test_a_hand_that_called_and_is_still_up_passes_the_face_in_a_wave():
    down = before = LOG_ODDS_MAX
    for _ in range(5):
        before = update_belief(before, 0.1, -4.0, 0.5)
        down = update_belief(down, 0.1, -4.0)
    assert before > 0.0 > down


def test_a_hand_that_stays_at_the_face_is_given_up_in_the_end():
    before = LOG_ODDS_MAX
    for _ in range(20):
        before = update_belief(before, 0.1, -4.0, 0.5)
    assert before < 0.0


def test_a_palm_that_is_not_up_must_stay_longer_than_one_of_people_who_talk():
    low = up = float("nan")
    raised = []
    for _ in range(10):
        low, up = update_belief(low, 0.1, 3.0, 0.0), update_belief(up, 0.1, 3.0, 0.5)
        raised.append((low > 0.0, up > 0.0))
    first_low, first_up = (np.array(raised)[:, row].argmax() for row in (0, 1))
    assert first_up <= 2
    assert 5 <= first_low <= 7


def test_an_old_look_at_the_owner_is_not_the_same_evidence_once_more():
    new, old = float("nan"), float("nan")
    for number in range(3):
        new = update_belief(new, 0.1, 3.0)
        old = update_belief(old, 0.1, 3.0, is_old_look=number > 0)
    assert new > CALLS_FROM > old
    assert update_belief(old, 0.1, -3.0, is_old_look=True) == update_belief(old, 0.1, -3.0)


def test_one_image_alone_makes_no_call_whatever_it_shows():
    assert after(9.0, 1) < CALLS_FROM < after(9.0, 2)


def test_what_speaks_for_a_call_but_faintly_makes_none_however_long():
    assert after(0.4, 300) < CALLS_FROM < after(0.75, 300)


def test_a_hand_that_calls_is_believed_longer_than_one_that_does_not():
    lost = [
        (before - update_belief(before, 0.5, 0.0)) for before in (CALLS_FROM, CALLS_FROM - 0.1)
    ]
    assert lost[0] < lost[1]
