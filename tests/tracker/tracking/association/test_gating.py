"""Which measurements could belong to which tracks, and how likely is each pair?"""

from dataclasses import replace

import numpy as np
import pytest
from scipy.stats import chi2, multivariate_normal
from scipy.stats import t as student_t

from tracker import Config, Measurements
from tracker.containers import SensorKind
from tracker.tracking.association.gating import LOG_IDENTITY, log_of_sum
from tracker.tracking.people import TAG
from tracker.tracking.sensing.claims import claims_of
from tracker.tracking.sensing.innovation import (
    innovation_of,
    noise_of,
    seen_from,
    squared_distance,
)
from tracker.tracking.settings import gate_limit

CONFIG = Config(motion="cv", outlier_dof=0.0, innovation_floor_m=0.0, gate_probability=0.99)
ONE = Measurements.cartesian([[1.2, 0.4]], 0.05 * np.eye(2))


@pytest.fixture
def person(people_of):
    return people_of([[1.0, 0.5, 0.0, 0.0]], np.diag([0.1, 0.2, 1.0, 1.0]))


@pytest.fixture
def crowd(people_of):
    rng = np.random.default_rng(12)
    mean = np.concatenate([rng.uniform(-3, 3, (30, 2)), np.zeros((30, 2))], axis=1)
    root = rng.normal(scale=0.2, size=(30, 4, 4))
    return people_of(mean, root @ np.swapaxes(root, -1, -2) + 0.01 * np.eye(4))


def mixed_claims(rng):
    """Of every kind, from sensors all over the place, and the rows of each sensor."""
    parts = [
        Measurements.polar(
            rng.uniform(-3.1, 3.1, 6), rng.uniform(1, 5, 6), 0.05, 0.1, rng.uniform(-3, 3, 3)
        )
        for _ in range(4)
    ]
    camera = Measurements.polar(0.4, 3.0, 0.05, 0.1, (5.0, 5.0, -2.0))
    alone = Measurements.bearings(rng.uniform(-3, 3, 5), 0.05, (5.0, 5.0, -2.0))
    parts.append(Measurements.concatenate(camera, alone))
    parts.append(Measurements.ranges(rng.uniform(1, 5, 4), 0.1, (-4.0, 0.0, 0.0)))
    parts.append(Measurements.cartesian(rng.uniform(-3, 3, (7, 2)), 0.02 * np.eye(2)))
    measured = Measurements.concatenate(*parts)
    return measured, np.split(np.arange(len(measured)), np.cumsum([*map(len, parts)])[:-1])


@pytest.fixture
def odds_of(pairs_of):
    """Log-odds of every pair of some rows of each sensor, by track and claim."""

    def odds(people, measured, sensors, config):
        found = {}
        for rows in sensors:
            pairs = pairs_of(people, measured, config, rows=rows)
            assert (np.diff(pairs.track) >= 0).all()
            both = zip(pairs.track.tolist(), pairs.claim.tolist(), strict=True)
            found |= zip(both, pairs.log_odds.tolist(), strict=True)
        return found

    return odds


def spread_of(people, claims, track, row):
    """Innovation and S of a pair."""
    kind = claims.kind[row]
    expected, _, own, doubt = seen_from(
        kind, people.mean, people.covariance, 0, track, claims, row
    )
    s00, s01, s11 = np.sum([own, doubt, noise_of(kind, claims, row)], axis=0)
    y = np.array(innovation_of(kind, expected, claims, row))
    return y, np.array([[s00, s01], [s01, s11]])


def test_the_gate_keeps_the_share_it_is_told():
    rng = np.random.default_rng(5)
    draws = rng.multivariate_normal([0, 0], [[0.3, 0.1], [0.1, 0.2]], size=20_000)
    distances, _ = squared_distance(draws.T, (0.3, 0.1, 0.2), 0.0)
    inside = distances <= gate_limit(2, 0.9)
    # Five standard errors of a binomial share.
    assert inside.mean() == pytest.approx(0.9, abs=5 * np.sqrt(0.9 * 0.1 / 20_000))


def test_a_bearing_alone_is_gated_with_one_degree_of_freedom():
    limit = [gate_limit(1, 0.99), gate_limit(2, 0.99)]
    assert limit == pytest.approx([chi2.ppf(0.99, 1), chi2.ppf(0.99, 2)])


def test_the_odds_of_a_pair_are_those_of_the_textbook(person, pairs_of):
    pairs = pairs_of(person, ONE, CONFIG, chance=0.8, density=0.03)
    likelihood = multivariate_normal([1.0, 0.5], np.diag([0.15, 0.25])).pdf([1.2, 0.4])
    assert pairs.log_likelihood == pytest.approx(np.array([[np.log(likelihood)]]))
    assert pairs.log_newcomer == pytest.approx([np.log(0.03)])
    assert pairs.log_odds == pytest.approx([np.log(0.8 * likelihood / (0.2 * 0.03))])


def test_under_two_modes_a_measurement_is_as_likely_as_under_their_mixture(people_of, pairs_of):
    mean = np.array([[[1.0, 0.5, 0.0, 0.0]], [[1.3, 0.5, 0.0, 0.0]]])
    people = people_of(mean, np.diag([0.1, 0.2, 1.0, 1.0]), [[0.3], [0.7]])
    pairs = pairs_of(people, ONE, CONFIG, chance=0.5, density=1.0)
    each = [multivariate_normal(m[0, :2], np.diag([0.15, 0.25])).pdf([1.2, 0.4]) for m in mean]
    assert pairs.log_likelihood[0] == pytest.approx(np.log(each))
    assert pairs.log_odds == pytest.approx([np.log(0.3 * each[0] + 0.7 * each[1])])


def test_twice_the_density_of_strangers_is_half_the_odds(person, pairs_of):
    one, other = (pairs_of(person, ONE, CONFIG, density=density) for density in (0.1, 0.2))
    assert one.log_odds - other.log_odds == pytest.approx(np.log(2.0))


@pytest.mark.parametrize("dof", [0.0, 1.5, 4.0], ids=["Gaussian", "heavy", "less heavy"])
def test_the_pairs_are_those_that_a_dense_gate_lets_through(crowd, odds_of, dof):
    config = CONFIG.replace(outlier_dof=dof)
    measured, sensors = mixed_claims(np.random.default_rng(13))
    claims, expected = claims_of(measured), set()
    for track in range(30):
        for row, kind in enumerate(claims.kind):
            y, s = spread_of(crowd, claims, track, row)
            distance = y @ np.linalg.solve(s, y)
            if dof > 0.0 and kind in (SensorKind.BEARING_RANGE, SensorKind.RANGE):
                first = y[0] ** 2 / s[0, 0]
                distance = first + (dof + 1.0) * np.log1p((distance - first) / dof)
            numbers = 1 if kind in (SensorKind.BEARING, SensorKind.RANGE) else 2
            if distance <= chi2.ppf(0.99, numbers):
                expected.add((track, row))
    assert len(expected) > 20
    assert odds_of(crowd, measured, sensors, config).keys() == expected


def test_the_order_of_measurements_changes_their_rows_and_nothing_else(crowd, odds_of):
    rng = np.random.default_rng(14)
    measured, sensors = mixed_claims(rng)
    # Rows of one kind stay side by side: the camera's first one is of another kind.
    order = np.concatenate([[*rng.permutation(rows[1:]), rows[0]] for rows in sensors])
    one = odds_of(crowd, measured, sensors, CONFIG)
    other = odds_of(crowd, measured[order], sensors, CONFIG)
    assert {(track, order[row]): odds for (track, row), odds in other.items()} == one


def test_nobody_gets_a_measurement_outside_the_gate(people_of, pairs_of):
    person = people_of(np.zeros((1, 4)), 0.01 * np.eye(4))
    far = Measurements.cartesian([[5.0, 5.0]], 0.01 * np.eye(2))
    assert len(pairs_of(person, far, CONFIG).track) == 0


def test_the_floor_widens_the_gate_of_an_over_confident_track(people_of, pairs_of):
    person = people_of(np.zeros((1, 4)), 1e-8 * np.eye(4))
    beside = Measurements.cartesian([[0.1, 0.0]], 1e-8 * np.eye(2))
    assert len(pairs_of(person, beside, CONFIG).track) == 0
    assert len(pairs_of(person, beside, CONFIG.replace(innovation_floor_m=0.05)).track) == 1


def test_a_heavy_tail_widens_the_gate_in_range_alone(people_of, pairs_of):
    person = people_of([[3.0, 0.0, 0.0, 0.0]], 1e-4 * np.eye(4))
    tailed = CONFIG.replace(outlier_dof=4.0)
    behind = Measurements.polar(0.0, 3.4, 0.02, 0.1)
    beside = Measurements.polar(0.08, 3.0, 0.02, 0.1)
    near = [len(pairs_of(person, behind, config).track) for config in (CONFIG, tailed)]
    assert near == [0, 1]
    near = [len(pairs_of(person, beside, config).track) for config in (CONFIG, tailed)]
    assert near == [0, 0]


def test_doubt_about_the_sensor_s_pose_widens_the_gate(people_of, pairs_of):
    person = people_of([[3.0, 0.0, 0.0, 0.0]], 1e-4 * np.eye(4))
    sure = Measurements.polar(0.3, 3.0, 0.02, 0.1)
    unsure = replace(sure, sensor_pose_covariance=np.diag([0.0, 0.0, 0.2**2])[None])
    assert [len(pairs_of(person, each, CONFIG).track) for each in (sure, unsure)] == [0, 1]


def test_a_squared_distance_is_that_of_the_matrices():
    rng = np.random.default_rng(15)
    for _ in range(20):
        y, root = rng.normal(size=2), rng.normal(size=(2, 2))
        s = root @ root.T + 0.1 * np.eye(2)
        found = squared_distance(tuple(y), (s[0, 0], s[0, 1], s[1, 1]), 0.0)
        assert found == pytest.approx((y @ np.linalg.solve(s, y), np.linalg.det(s)))


def test_under_a_heavy_tail_distances_differ_as_the_student_t_s_log_densities():
    dof, s11 = 4.0, 0.04
    ranges = np.array([0.0, 0.1, 0.7, 3.0])
    distance, _ = squared_distance((0.0, ranges), (1.0, 0.0, s11), dof)
    density = student_t(dof, scale=np.sqrt(s11)).logpdf(ranges)
    assert -0.5 * distance == pytest.approx(density - density[0])


def test_a_hint_of_identity_speaks_for_the_one_it_names_and_against_others(people_of, pairs_of):
    people = people_of(np.repeat([[1.0, 0.5, 0.0, 0.0]], 3, 0), np.diag([0.1, 0.2, 1.0, 1.0]))
    people.counts[TAG] = [7, 8, -1]
    tagged = replace(ONE, identity=np.array([7]))
    told = pairs_of(people, tagged, CONFIG).log_odds - pairs_of(people, ONE, CONFIG).log_odds
    assert told == pytest.approx([LOG_IDENTITY, -LOG_IDENTITY, 0.0])


def test_the_caller_s_own_likeness_is_added_to_the_log_odds(people_of, pairs_of):
    people = people_of(np.repeat([[1.0, 0.5, 0.0, 0.0]], 2, 0), np.diag([0.1, 0.2, 1.0, 1.0]))
    two = Measurements.concatenate(ONE, ONE)
    likeness = np.array([[1.0, -2.0], [0.0, 0.5]])
    told = pairs_of(people, two, CONFIG, likeness=likeness).log_odds
    assert told - pairs_of(people, two, CONFIG).log_odds == pytest.approx(likeness.ravel())


@pytest.mark.parametrize("first", [-np.inf, -800.0, 0.0, 700.0])
@pytest.mark.parametrize("second", [-np.inf, -801.0, 1.0, 710.0])
def test_the_log_of_a_sum_neither_overflows_nor_vanishes(first, second):
    assert log_of_sum(first, second) == pytest.approx(np.logaddexp(first, second))
