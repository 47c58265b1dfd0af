import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

from tracker import Config, Measurements, PersonTracker
from tracker.errors import ClockError

pytestmark = pytest.mark.usefixtures("machine_code")

PERIOD_NS = 100_000_000
NOISE = 0.08**2 * np.eye(2)


def raised_at(*points):
    return Measurements.cartesian(np.array(points, float).reshape(-1, 2), NOISE)


def seen_at(*points):
    return Measurements.cartesian(np.array(points, float).reshape(-1, 2), NOISE, raised=False)


def run(tracker, frames, start=0):
    for number, claims in enumerate(frames, start):
        tracks = tracker.step(number * PERIOD_NS, claims)
    return tracks


def test_two_raised_hands_make_a_customer():
    tracker = PersonTracker()
    first = run(tracker, [raised_at((2, 1))])
    assert not first.confirmed.any()
    assert not first.raised.any()
    second = run(tracker, [raised_at((2, 1))], start=1)
    assert second.confirmed.all()
    assert second.raised.all()
    assert second.selected_id == second.id[0] == 1
    assert second.mean[0] == pytest.approx([2, 1, 0, 0], abs=1e-6)


def test_one_raised_hand_and_no_more_is_forgotten():
    tracker = PersonTracker()
    tracks = run(tracker, [raised_at((2, 1)), *[Measurements.none()] * 2])
    assert len(tracks) == 0


def test_people_who_do_not_raise_a_hand_are_no_customers():
    assert len(run(PersonTracker(), [seen_at((2, 1))] * 10)) == 0


def test_a_lowered_hand_lowers_the_streak_and_not_existence():
    tracker = PersonTracker()
    up = run(tracker, [raised_at((2, 1))] * 5)
    down = run(tracker, [seen_at((2, 1))] * 50, start=5)
    assert down.raised.tolist() == [False]
    assert down.selected_id is None
    assert down.existence[0] >= up.existence[0]
    assert down.id.tolist() == up.id.tolist()


def test_hands_that_are_lowered_from_outside_need_a_new_streak_and_keep_their_identity():
    tracker = PersonTracker()
    up = run(tracker, [raised_at((2, 1), (4, -1))] * 5)
    tracker.lower_hands()
    first = run(tracker, [raised_at((2, 1), (4, -1))], start=20)
    assert not first.raised.any()
    assert first.confirmed.all()
    again = run(tracker, [raised_at((2, 1), (4, -1))], start=21)
    assert again.raised.all()
    assert again.id.tolist() == up.id.tolist()
    assert again.selected_id == up.selected_id


def test_the_same_hand_up_again_is_the_same_person():
    tracker = PersonTracker()
    run(tracker, [raised_at((2, 1))] * 5)
    run(tracker, [seen_at((2, 1))] * 100, start=5)
    again = run(tracker, [raised_at((2.05, 1))] * 3, start=105)
    assert again.id.tolist() == [1]
    assert again.raised.tolist() == [True]


def test_a_customer_whom_nothing_shows_is_gone_after_delete_after_s():
    tracker = PersonTracker(Config(delete_after_s=2.05))
    run(tracker, [raised_at((2, 1))] * 5)
    assert len(run(tracker, [Measurements.none()] * 20, start=5)) == 1
    assert len(run(tracker, [Measurements.none()], start=25)) == 0


def test_a_customer_who_does_not_call_is_forgotten_after_forget_after_s():
    tracker = PersonTracker(Config(forget_after_s=3.0))
    run(tracker, [raised_at((2, 1))] * 5)
    assert len(run(tracker, [seen_at((2, 1))] * 40, start=5)) == 0


def test_a_customer_out_of_sight_does_not_take_over_a_bystander():
    tracker = PersonTracker()
    run(tracker, [raised_at((2, 0))] * 5)
    run(tracker, [seen_at((2, 0), (2.5, 0.6))] * 10, start=5)
    tracks = run(tracker, [seen_at((2.4 - 0.02 * step, 0.5)) for step in range(15)], start=15)
    assert tracks.id.tolist() == [1]
    assert tracks.unseen_s[0] == pytest.approx(1.5)


def test_a_bystander_s_raised_hand_is_not_the_neighbor_s_who_went_out_of_sight():
    tracker = PersonTracker()
    run(tracker, [raised_at((2, 0))] * 5)
    run(tracker, [seen_at((2, 0), (2, 0.7))] * 10, start=5)
    run(tracker, [seen_at((2, 0.7))] * 15, start=15)
    tracks = run(tracker, [raised_at((2, 0.7))] * 3, start=30)
    assert tracks.id.tolist() == [1, 2]
    assert tracks.raised.tolist() == [False, True]
    assert tracks.mean[1, :2] == pytest.approx([2, 0.7], abs=0.1)


def test_a_customer_who_has_long_stood_and_suddenly_walks_off_is_still_the_same():
    tracker = PersonTracker()
    run(tracker, [raised_at((2, 0))] * 5)
    run(tracker, [seen_at((2, 0))] * 100, start=5)
    tracks = run(tracker, [seen_at((2, 0.12 * step)) for step in range(1, 21)], start=105)
    assert tracks.id.tolist() == [1]
    assert tracks.mean[0, :2] == pytest.approx([2, 2.4], abs=0.1)


def test_customers_come_in_the_order_of_their_identities_whoever_was_seen_first():
    tracker = PersonTracker()
    run(tracker, [seen_at((2, 1))] * 10)
    run(tracker, [raised_at((4, -1))] * 3, start=10)
    tracks = run(tracker, [raised_at((4, -1), (2, 1))] * 3, start=13)
    assert tracks.id.tolist() == [1, 2]
    assert tracks.mean[:, 0] == pytest.approx([4, 2], abs=0.1)


def test_everybody_is_there_bystanders_with_identities_below_0():
    tracker = PersonTracker()
    assert len(tracker.people) == 0
    run(tracker, [seen_at((2, 1))] * 10)
    tracks = run(tracker, [Measurements.concatenate(raised_at((4, -1)), seen_at((2, 1)))] * 3, 10)
    everybody = tracker.people
    assert sorted(everybody.id.tolist()) == [-1, 1]
    bystander, customer = everybody[everybody.id == -1], everybody[everybody.id == 1]
    assert bystander.mean[0, :2] == pytest.approx([2, 1], abs=0.01)
    assert bystander.raised.tolist() == [False]
    np.testing.assert_array_equal(customer.mean, tracks.mean)
    assert everybody.stamp_ns == tracks.stamp_ns
    np.testing.assert_array_equal(tracker.positions_m, everybody.mean[:, :2])


def test_a_bystander_who_calls_is_a_customer_under_another_identity():
    tracker = PersonTracker()
    run(tracker, [seen_at((2, 1), (4, -1))] * 10)
    assert tracker.people.id.tolist() == [-1, -2]
    run(tracker, [Measurements.concatenate(raised_at((4, -1)), seen_at((2, 1)))] * 3, 10)
    assert tracker.people.id.tolist() == [-1, 1]


def test_identities_of_bystanders_are_not_reused_either():
    tracker = PersonTracker()
    run(tracker, [seen_at((2, 1))] * 3)
    tracker.reset()
    run(tracker, [seen_at((2, 1))] * 3, start=3)
    assert tracker.people.id.tolist() == [-2]


def test_a_doubted_motion_widens_what_is_believed_of_everybody_by_it():
    tracker = PersonTracker()
    before = run(tracker, [raised_at((2, 0), (4, 1))] * 5)
    tracker.doubt(np.array([0.3, 0.0, 0.1]), 0.5)
    turn = np.array([[np.cos(0.1), -np.sin(0.1)], [np.sin(0.1), np.cos(0.1)]])
    off = before.mean[:, :2] @ turn.T + [0.3, 0.0] - before.mean[:, :2]
    grown = tracker.people.covariance[:, :2, :2] - before.covariance[:, :2, :2]
    np.testing.assert_allclose(grown, off[:, :, None] * off[:, None], atol=1e-12)
    np.testing.assert_array_equal(tracker.people.mean, before.mean)


def test_only_customers_count_as_tracks():
    tracker = PersonTracker()
    run(tracker, [seen_at((2, 1))] * 10)
    assert not tracker.has_tracks
    run(tracker, [raised_at((2, 1))], start=10)
    assert tracker.has_tracks


def test_two_people_are_two_customers_with_streaks_of_their_own():
    tracker = PersonTracker()
    run(tracker, [raised_at((2, 1), (2, -1))] * 5)
    tracks = run(tracker, [raised_at((2, -1))] * 4, start=5)
    assert tracks.id.tolist() == [1, 2]
    assert tracks.raised.tolist() == [False, True]
    assert tracks.selected_id == 2


def test_two_raised_hands_of_one_person_count_once():
    tracker = PersonTracker()
    tracks = run(tracker, [raised_at((2, 0.15), (2, -0.15))] * 5)
    assert len(tracks) == 1


def test_two_raised_hands_at_one_scan_segment_count_once_however_far_apart():
    claims = Measurements.cartesian([[2, 0.6], [2, -0.6]], NOISE, person=[3, 3])
    assert len(run(PersonTracker(), [claims] * 5)) == 1


def test_crossing_people_keep_their_identities():
    tracker = PersonTracker()
    rng = np.random.default_rng(1)
    for number in range(60):
        y = -1.5 + 0.05 * number
        points = np.array([[2.0, y], [2.6, -y]]) + rng.normal(scale=0.05, size=(2, 2))
        tracks = tracker.step(number * PERIOD_NS, raised_at(*points))
    assert tracks.id.tolist() == [1, 2]
    assert tracks.mean[0, 1] > 1.0
    assert tracks.mean[1, 1] < -1.0
    assert tracks.mean[:, 3] == pytest.approx([0.5, -0.5], abs=0.25)


def test_callers_who_pass_within_a_hand_s_reach_are_both_heard_all_the_time(tracker_of):
    tracker = tracker_of()
    for number in range(60):
        y = -1.5 + 0.05 * number
        tracks = tracker.step(number * PERIOD_NS, raised_at((2.0, y), (2.25, -y)))
        assert (tracks.unseen_s == 0.0).all()
    assert tracks.id.tolist() == [1, 2]
    assert tracks.raised.all()


def test_bearings_alone_raise_a_hand_too():
    tracker = PersonTracker()
    tracks = run(tracker, [Measurements.polar(0.2, np.nan, 0.05, 0.1)] * 3)
    assert tracks.raised.tolist() == [True]
    assert np.sqrt(np.linalg.eigvalsh(tracks.covariance[0, :2, :2])[-1]) > 1.0


def test_a_jump_back_of_the_clock_forgets_everybody_and_reuses_no_identity():
    tracker = PersonTracker()
    run(tracker, [raised_at((2, 1))] * 3, start=100)
    assert len(tracker.step(0, Measurements.none())) == 0
    tracks = run(tracker, [raised_at((2, 1))] * 3, start=1)
    assert tracks.id.tolist() == [2]


def test_identities_belong_to_the_tracker():
    assert run(PersonTracker(), [raised_at((2, 1))]).id.tolist() == [1]
    assert run(PersonTracker(), [raised_at((2, 1))]).id.tolist() == [1]


def test_time_steps_come_from_stamps():
    tracker = PersonTracker()
    stamps = [0, 70_000_000, 180_000_000, 250_000_000, 390_000_000, 1_000_000_000]
    for stamp in stamps:
        tracks = tracker.step(stamp, raised_at((1.0 + stamp / 1e9, 0.0)))
    assert tracks.mean[0, 2] == pytest.approx(1.0, abs=0.2)


def test_a_negative_stamp_is_an_error():
    with pytest.raises(ClockError, match="-1"):
        PersonTracker().step(-1, Measurements.none())


def test_changed_parameters_keep_the_tracks():
    tracker = PersonTracker()
    run(tracker, [raised_at((2, 1))] * 5)
    tracker.config = Config(confirm_window=5, lower_streak=1)
    tracks = run(tracker, [seen_at((2, 1))], start=5)
    assert tracks.id.tolist() == [1]
    assert tracks.raised.tolist() == [False]


def test_stamps_that_are_no_times_are_an_error():
    for stamp_ns in (1.5, "now", 2**64, np.int64(-3)):
        with pytest.raises(ClockError):
            PersonTracker().step(stamp_ns, Measurements.none())


@settings(max_examples=60, deadline=None)
@given(
    values=hnp.arrays(float, (6, 2), elements=st.floats(allow_nan=True, allow_infinity=True)),
    noise=hnp.arrays(float, (6, 2, 2), elements=st.floats(allow_nan=True, allow_infinity=True)),
    stamp_ns=st.integers(0, 10**18),
)
def test_no_well_typed_input_breaks_a_step(values, noise, stamp_ns):
    tracker = PersonTracker()
    run(tracker, [raised_at((2, 1), (1, 0))] * 3)
    tracker.step(stamp_ns, Measurements.cartesian(values, noise, refuse="drop"))
    tracks = tracker.step(stamp_ns, raised_at((2, 1)))
    assert np.isfinite(tracks.mean).all()
    assert (np.linalg.eigvalsh(tracks.covariance) > 0).all()
