import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

from tracker import Config, Measurements, PersonTracker
from tracker.tracking import View
from tracker.tracking.appearance import Appearance, hellinger, recognizable
from tracker.tracking.gating import gate_limit

NOISE = 0.08**2 * np.eye(2)
RED, BLUE, GREEN = np.eye(3)
UNKNOWN = np.full(3, np.nan)
NOBODY = View(np.zeros(3), 0.1)  # looks past everybody: silence tells nothing

HISTOGRAMS = st.lists(
    st.lists(st.floats(0.01, 1.0), min_size=3, max_size=3).map(
        lambda row: np.array(row) / sum(row)
    ),
    min_size=1,
    max_size=6,
).map(np.array)


#: Settings of their own, whatever the defaults are.
CLOTHED = Config(
    appearance_weight=1.0, association="hungarian", acceleration_density=0.3,
    stand_duration_s=10.0, gate_probability=0.99, newcomer_density=0.02, delete_after_s=3.0,
)  # fmt: skip
NAKED = CLOTHED.replace(appearance_weight=0.0)


def raised_at(points, clothes):
    return Measurements.cartesian(np.array(points, float), NOISE, appearance=np.array(clothes))


def two_customers(red_at=(2, 0.5), blue_at=(2, -0.5), config=None, silent_frames=0):
    """Somebody in red and somebody in blue, known for a second; then nothing is measured."""
    tracker = PersonTracker(config or CLOTHED, compiled=False)
    for number in range(10):
        tracker.step(number * 10**8, raised_at([red_at, blue_at], [RED, BLUE]), view=NOBODY)
    for number in range(10, 10 + silent_frames):
        tracker.step(number * 10**8, Measurements.none(), view=NOBODY)
    return tracker


def caller(tracker, clothes, point=(2, 0), frame=40, count=2):
    """Whose hand counts as raised after one that came up at a point."""
    for number in range(count):
        claims = raised_at([point], [clothes])
        tracks = tracker.step((frame + number) * 10**8, claims, view=NOBODY)
    return tracks.id[tracks.raised].tolist()


@pytest.mark.parametrize("association", ["hungarian", "jpda"])
@pytest.mark.parametrize(("clothes", "owner"), [(RED, 1), (BLUE, 2)], ids=["red", "blue"])
def test_of_two_who_are_as_near_the_one_in_the_same_clothes_has_raised_the_hand(
    clothes, owner, association
):
    config = CLOTHED.replace(association=association)
    tracker = two_customers(config=config, silent_frames=30)
    assert caller(tracker, clothes) == [owner]


def test_without_weight_the_nearer_one_has_raised_it_whatever_the_clothes():
    tracker = two_customers(config=NAKED, silent_frames=30)
    assert caller(tracker, RED, point=(2, -0.35)) == [2]


def test_clothes_never_bring_in_who_is_far_outside_the_gate():
    tracker = two_customers(red_at=(2, 2), blue_at=(2, -2))
    tracks = tracker.step(10 * 10**8, raised_at([(2, -2)], [RED]), view=NOBODY)
    assert tracks.unseen_s[tracks.id == 1].tolist() == [0.1]


def test_clothes_weigh_no_more_than_a_hand_at_the_gate_s_edge():
    looks = np.eye(3)
    ratio = Appearance(looks).log_ratio(looks, np.array([0, 0]), np.array([0, 1]))
    assert (np.abs(ratio) < 0.5 * gate_limit(True, Config().gate_probability)).all()


def other_hands(tracker, clothes):
    for number in range(10, 20):
        points = [(2, 0.45), (2, -0.4)]
        tracks = tracker.step(number * 10**8, raised_at(points, clothes))
    return tracks


@pytest.mark.parametrize(
    "clothes", [UNKNOWN, [0, 0, 0], [0.2, 0.9, -0.1], [5, 3, 1], [np.inf] * 3]
)
def test_unknown_clothes_change_nothing(clothes):
    without = other_hands(two_customers(config=NAKED), [RED, BLUE])
    unknown = other_hands(two_customers(), [clothes, clothes])
    np.testing.assert_array_equal(unknown.mean, without.mean)
    np.testing.assert_array_equal(unknown.covariance, without.covariance)
    assert unknown.id.tolist() == without.id.tolist()


def test_the_same_clothes_on_everybody_prefer_nobody():
    tracks = []
    for config in (NAKED, CLOTHED):
        tracker = PersonTracker(config)
        for number in range(10):
            points = [(2, 0.5), (2, -0.5)]
            tracker.step(number * 10**8, raised_at(points, [RED, RED]), view=NOBODY)
        tracks.append(tracker.step(40 * 10**8, raised_at([(2, -0.35)], [RED]), view=NOBODY))
    np.testing.assert_array_equal(tracks[0].mean, tracks[1].mean)
    assert tracks[0].id.tolist() == tracks[1].id.tolist()


def test_somebody_else_s_clothes_make_a_newcomer():
    ids = []
    for clothes in (RED, GREEN):
        tracker = PersonTracker(CLOTHED)
        for number in range(10):
            tracker.step(number * 10**8, raised_at([(2, 1)], [RED]), view=NOBODY)
        tracks = tracker.step(40 * 10**8, raised_at([(2, 1.5)], [clothes]), view=NOBODY)
        ids.append(tracks.id.tolist())
    assert ids == [[1], [1, 2]]


@given(looks=HISTOGRAMS, more=HISTOGRAMS, data=st.data())
def test_what_is_remembered_stays_a_histogram(looks, more, data):
    count = 4
    appearance = Appearance.unknown(count)
    for batch in (looks, more):
        batch = np.concatenate([batch, np.zeros((1, 3))])
        rows = st.integers(-1, len(batch) - 1)
        look_of = np.array(data.draw(st.lists(rows, min_size=count, max_size=count)))
        appearance = appearance.remember(batch, look_of)
        assert (appearance.histogram >= 0.0).all()
        total = appearance.histogram.sum(axis=1)
        assert ((np.abs(total - 1.0) < 1e-9) | (total == 0.0)).all()


@given(looks=HISTOGRAMS, seed=st.integers(0, 1000))
def test_permuted_looks_permute_the_ratios(looks, seed):
    known = Appearance(np.array([RED, BLUE, 0 * RED]))
    order = np.random.default_rng(seed).permutation(len(looks))
    person, look = np.divmod(np.arange(3 * len(looks)), len(looks))
    ratios = known.log_ratio(looks, person, look).reshape(3, -1)
    permuted = known.log_ratio(looks[order], person, look).reshape(3, -1)
    np.testing.assert_array_equal(permuted, ratios[:, order])


def test_a_first_look_counts_in_full_and_later_ones_are_averaged():
    first = Appearance.unknown(2).remember(np.array([RED]), np.array([0, -1]))
    assert first.histogram.tolist() == [[1, 0, 0], [0, 0, 0]]
    later = first
    for _ in range(200):
        later = later.remember(np.array([BLUE]), np.array([0, -1]))
    assert later.histogram[0] == pytest.approx(BLUE, abs=1e-3)


def test_histograms_of_another_length_begin_a_new_memory():
    old = Appearance(np.array([RED, BLUE]))
    new = old.remember(np.array([[0.5, 0.5]]), np.array([-1, 0]))
    assert new.histogram.tolist() == [[0, 0], [0.5, 0.5]]
    assert old.log_ratio(np.array([[0.5, 0.5]]), np.array([0]), np.array([0])).tolist() == [0.0]


def test_people_never_looked_at_join_those_who_were():
    both = Appearance(np.array([RED])).append(Appearance.unknown(1))
    assert both.histogram.tolist() == [[1, 0, 0], [0, 0, 0]]


def test_the_distance_is_hellinger_s():
    half = np.array([0.5, 0.5, 0.0])
    assert hellinger(RED, half) == pytest.approx(np.sqrt(1 - np.sqrt(0.5)))
    assert hellinger(RED, BLUE) == 1.0
    assert hellinger(half, half) == pytest.approx(0.0, abs=1e-7)


@given(
    rows=hnp.arrays(
        float,
        st.tuples(st.just(3), st.integers(0, 4)),
        elements=st.one_of(st.floats(0, 1), st.floats(allow_nan=True, allow_infinity=True)),
    )
)
def test_no_histogram_breaks_a_step(rows):
    tracker = two_customers()
    points = [(2, 0.5), (2, -0.5), (1, 0)]
    for number in range(10, 13):
        tracks = tracker.step(number * 10**8, raised_at(points, rows))
        assert np.isfinite(tracks.mean).all()
    assert (recognizable(rows).sum(axis=1) < 1.01).all()


def test_measurements_with_and_without_clothes_may_take_turns():
    tracker = PersonTracker()
    claims = raised_at([(2, 0), (1, 1)], [RED, BLUE])
    plain = Measurements.cartesian(claims.values, NOISE)
    for number, each in enumerate([plain, claims, claims[:1], plain, claims]):
        tracks = tracker.step(number * 10**8, each)
    assert tracks.id.tolist() == [1, 2]
