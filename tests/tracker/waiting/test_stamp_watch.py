import pytest

from tracker.waiting.stamp_watch import StampWatch, Step

S = 1_000_000_000


def judged(*stamps_s, late_s=0.0, ahead_s=10.0):
    watch = StampWatch(int(late_s * S), int(ahead_s * S))
    return [watch.judge(int(stamp_s * S)) for stamp_s in stamps_s]


def test_an_ordinary_stream_goes_onward():
    assert judged(0, 0.1, 0.2, 0.3, 9.0) == [Step.ONWARD] * 5


@pytest.mark.parametrize("odd_s", [0.0, 2e9, 99.9], ids=["zero", "far-future", "a-little-back"])
def test_one_odd_stamp_is_an_error_and_leaves_no_trace(odd_s):
    assert judged(100, odd_s, 100.1, 100.2) == [Step.ONWARD, Step.ODD, Step.ONWARD, Step.ONWARD]


def test_two_that_agree_on_an_earlier_time_are_a_jump_back():
    steps = judged(100, 5.0, 5.1, 5.2)
    assert steps == [Step.ONWARD, Step.ODD, Step.JUMPED_BACK, Step.ONWARD]


def test_two_that_agree_on_a_later_time_go_onward():
    assert judged(100, 500.0, 500.1) == [Step.ONWARD, Step.ODD, Step.ONWARD]


def test_a_slow_source_is_believed_again_after_a_pause():
    assert judged(100, 160, 165, 170) == [Step.ONWARD, Step.ODD, Step.ONWARD, Step.ONWARD]


def test_odd_stamps_that_do_not_agree_are_never_believed():
    assert judged(100, 7.0, 3.0, 80.0, 1.0, 100.1)[1:] == [Step.ODD] * 4 + [Step.ONWARD]


def test_messages_out_of_order_are_late_and_however_many_make_no_new_time():
    steps = judged(100, 99.5, 99.6, 99.7, 100.2, late_s=1.0)
    assert steps == [Step.ONWARD, Step.LATE, Step.LATE, Step.LATE, Step.ONWARD]


def test_a_clock_that_was_set_back_a_little_for_good_is_a_jump_in_the_end():
    steps = judged(100, *(99.2 + number * 1e-3 for number in range(200)), late_s=1.0)
    assert steps.count(Step.JUMPED_BACK) == 1
    assert steps[-1] is Step.ONWARD


def test_after_a_reset_any_stamp_is_believed():
    watch = StampWatch(0, S)
    watch.judge(100 * S)
    watch.reset()
    assert watch.judge(3 * S) is Step.ONWARD


def test_one_and_the_same_odd_stamp_is_never_believed():
    assert judged(100, 7.0, 7.0, 7.0)[1:] == [Step.ODD] * 3


def test_the_first_stamp_is_held_against_the_others_of_its_clock():
    assert StampWatch(S, S, last_ns=100 * S).judge(2**31 * S) is Step.ODD
    assert StampWatch(S, S, last_ns=100 * S).judge(100 * S + 1) is Step.ONWARD
