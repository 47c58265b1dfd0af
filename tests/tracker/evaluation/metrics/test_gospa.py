import itertools

import numpy as np
import pytest

from tracker.evaluation.metrics.gospa import gospa


def brute_force(tracks, people, cutoff, order):
    """GOSPA by trying every assignment, straight from the definition with alpha = 2."""
    if len(tracks) > len(people):
        tracks, people = people, tracks
    best = np.inf
    for chosen in itertools.permutations(range(len(people)), len(tracks)):
        distances = np.linalg.norm(tracks - people[list(chosen)], axis=-1)
        best = min(best, (np.minimum(distances, cutoff) ** order).sum())
    return (best + cutoff**order / 2 * (len(people) - len(tracks))) ** (1 / order)


@pytest.mark.parametrize("order", [1.0, 2.0])
def test_gospa_and_its_parts_equal_stone_soup_s(stonesoup, at, random_sets, order):
    from stonesoup.metricgenerator.ospametric import GOSPAMetric
    from stonesoup.types.state import State

    oracle = GOSPAMetric(p=order, c=1.0)
    for tracks, people in random_sets:
        if len(tracks) + len(people) == 0:
            continue
        sets = [[State(xy, at(0)) for xy in points] for points in (tracks, people)]
        expected = oracle.compute_gospa_metric(*sets)[0].value
        found = gospa(tracks, people, cutoff_m=1.0, order=order)
        assert found.distance_m == pytest.approx(expected["distance"])
        assert found.localisation == pytest.approx(expected["localisation"])
        assert found.missed == pytest.approx(expected["missed"])
        assert found.false == pytest.approx(expected["false"])


@pytest.mark.parametrize("order", [1.0, 2.0])
def test_no_assignment_is_better(random_sets, order):
    for tracks, people in random_sets:
        found = gospa(tracks, people, cutoff_m=0.8, order=order)
        assert found.distance_m == pytest.approx(brute_force(tracks, people, 0.8, order))


def test_nobody_and_nothing_are_no_distance_apart():
    nobody = np.zeros((0, 2))
    assert gospa(nobody, nobody).distance_m == 0.0


def test_the_parts_add_up_to_the_metric(random_sets):
    for tracks, people in random_sets:
        found = gospa(tracks, people)
        parts = found.localisation + found.missed + found.false
        assert found.distance_m**2 == pytest.approx(parts)
        assert len(found.pairs) == len(people) - 2 * found.missed
