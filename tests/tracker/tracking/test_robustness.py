from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

from tracker import Config, Measurements, PersonTracker
from tracker.tracking import View

pytestmark = pytest.mark.usefixtures("machine_code")

NOISE = 0.08**2 * np.eye(2)
CONFIGS = {
    "everything on": Config(confirmation="existence"),
    "plain": Config(motion="cv", association="hungarian", outlier_dof=0.0),
    "one mode": Config(motion="cv", confirmation="m_of_n"),
    "joint probabilities": Config(association="jpda"),
    "joint probabilities, one mode": Config(association="jpda", motion="cv"),
}
ANY = st.floats(allow_nan=True, allow_infinity=True)
LIKELY = st.one_of(st.floats(-10, 10), ANY)


def assert_sound(tracks):
    assert np.isfinite(tracks.mean).all()
    assert (np.linalg.eigvalsh(tracks.covariance) > 0).all()
    np.testing.assert_allclose(
        tracks.covariance, np.swapaxes(tracks.covariance, 1, 2), rtol=1e-9, atol=1e-12
    )
    assert ((tracks.existence >= 0) & (tracks.existence <= 1)).all()
    assert len(set(tracks.id)) == len(tracks)


def some_people(tracker):
    for number in range(3):
        tracker.step(number * 10**8, Measurements.cartesian([[2, 1], [1, 0], [2.3, 1.2]], NOISE))


@pytest.mark.parametrize("config", CONFIGS.values(), ids=CONFIGS)
@settings(max_examples=25, deadline=None)
@given(
    values=hnp.arrays(float, (6, 2), elements=LIKELY),
    std=hnp.arrays(float, (6, 2), elements=st.one_of(st.floats(1e-3, 1.0), ANY)),
    mixed=st.one_of(st.just(0.0), ANY),
    pose=hnp.arrays(float, (6, 3), elements=LIKELY),
    doubt=hnp.arrays(float, (3,), elements=st.one_of(st.just(0.0), st.floats(0, 1), ANY)),
    raised=hnp.arrays(bool, 6),
    gaps_ns=st.lists(
        st.sampled_from([-1, 0, 1, 10**7, 10**8, 10**10, 86_400 * 10**9]), max_size=4
    ),
)
def test_whatever_comes_the_state_stays_sound(
    tracker_of, config, values, std, mixed, pose, doubt, raised, gaps_ns
):
    tracker = tracker_of(config)
    some_people(tracker)
    polar, place = slice(3), slice(3, 6)
    noise = np.array([[0.1, mixed], [mixed, 0.1]])
    claims = Measurements.concatenate(
        Measurements.polar(
            *values[polar].T, *std[polar].T, pose[polar], raised=raised[polar],
            sensor_pose_covariance=np.diag(doubt), refuse="drop",
        ),
        Measurements.cartesian(values[place], noise, raised=raised[place], refuse="drop"),
    )  # fmt: skip
    stamp_ns = 3 * 10**8
    view = View(np.array([0.0, 0.0, 0.1]), 1.2)
    assert_sound(tracker.step(stamp_ns, claims, view=view))
    for gap_ns in gaps_ns:
        stamp_ns += gap_ns
        assert_sound(tracker.step(stamp_ns, claims, view=view))
        assert_sound(tracker.step(stamp_ns, replace(claims, raised=~claims.raised)))


@pytest.mark.parametrize("config", CONFIGS.values(), ids=CONFIGS)
def test_a_thousand_measurements_at_once(config):
    tracker = PersonTracker(config)
    rng = np.random.default_rng(0)
    for number in range(3):
        xy = rng.uniform(-20, 20, (1000, 2))
        tracks = tracker.step(number * 10**8, Measurements.cartesian(xy, NOISE))
        assert_sound(tracks)
    assert len(tracks) > 300


@pytest.mark.parametrize("config", CONFIGS.values(), ids=CONFIGS)
def test_a_thousand_copies_of_one_measurement_are_one_person(config):
    tracker = PersonTracker(config)
    for number in range(3):
        tracks = tracker.step(number * 10**8, Measurements.cartesian([[2, 1]] * 1000, NOISE))
    assert_sound(tracks)
    assert len(tracks) == 1


def test_equal_stamps_add_information_and_no_time():
    tracker = PersonTracker()
    claims = Measurements.cartesian([[2, 1]], NOISE)
    first = tracker.step(0, claims)
    second = tracker.step(0, claims)
    assert second.id.tolist() == first.id.tolist()
    assert second.age_s.tolist() == [0.0]
    assert second.covariance[0, 0, 0] < first.covariance[0, 0, 0]


def test_after_a_day_everybody_is_gone():
    tracker = PersonTracker()
    some_people(tracker)
    assert len(tracker.step(86_400 * 10**9, Measurements.none())) == 0


@pytest.mark.parametrize("config", CONFIGS.values(), ids=CONFIGS)
def test_the_same_input_gives_the_same_output_to_the_bit(config):
    def run():
        tracker, rng = PersonTracker(config), np.random.default_rng(5)
        for number in range(20):
            xy = np.array([[2, 1], [1, 0], [2.3, 1.2]]) + rng.normal(scale=0.08, size=(3, 2))
            tracks = tracker.step(number * 10**8, Measurements.cartesian(xy, NOISE))
        return tracks

    one, other = run(), run()
    assert (one.mean == other.mean).all()
    assert (one.covariance == other.covariance).all()
    assert one.id.tolist() == other.id.tolist()
    assert one.existence.tolist() == other.existence.tolist()


def test_a_bias_of_the_hand_keeps_many_looks_from_being_more_certain_than_one():
    spread = {}
    for offset_m in (0.0, 0.2):
        tracker = PersonTracker(Config(motion="cv"))
        start = Measurements.cartesian([[2.5, 0.0]], NOISE)
        tracker.step(0, start)
        for number in range(1, 30):
            bias = np.diag([0.0, offset_m**2])
            claims = Measurements.bearings(0.0, 0.08, bias_covariance=bias)
            tracks = tracker.step(number * 10**8, claims)
        spread[offset_m] = np.sqrt(tracks.covariance[0, 1, 1])
    # The hand stands 0.08 rad * 2.5 m = 0.2 m off, and stays there.
    assert spread[0.0] < 0.15 < spread[0.2]


@pytest.mark.parametrize("config", CONFIGS.values(), ids=CONFIGS)
@pytest.mark.parametrize("far_m", [(467_000.25, 5_540_000.5), (-1e8, 1e8)], ids=["UTM", "1e8 m"])
def test_people_are_tracked_alike_on_a_map_whose_origin_is_far_away(tracker_of, config, far_m):
    here, there = tracker_of(config), tracker_of(config)
    far = np.array(far_m)
    rng = np.random.default_rng(4)
    for number in range(60):
        robot = np.array([0.02 * number, -0.3])
        toward = np.array([[2.0, 0.5 + 0.01 * number], [3.0, -1.0]]) - robot
        toward += rng.normal(0.0, 0.05, toward.shape)
        bearing, range_m = np.arctan2(toward[:, 1], toward[:, 0]), np.hypot(*toward.T)
        near, away = (
            tracker.step(
                number * 10**8,
                Measurements.polar(bearing, [range_m[0], np.nan], 0.03, 0.08, [*origin, 0.0]),
                origin,
            )
            for tracker, origin in ((here, robot), (there, robot + far))
        )
        assert away.id.tolist() == near.id.tolist()
        np.testing.assert_allclose(away.mean[:, :2] - far, near.mean[:, :2], atol=1e-4)
        np.testing.assert_allclose(away.covariance, near.covariance, atol=1e-4)
    assert len(near) == 2
    assert near.raised.all()
