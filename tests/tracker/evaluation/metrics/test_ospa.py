import itertools

import numpy as np
import pytest

from tracker.evaluation.metrics.ospa import ospa


def test_ospa_equals_stone_soup_s(stonesoup, at, random_sets):
    # Of order 1 only: for others Stone Soup assigns by plain distances, which is not optimal.
    from stonesoup.metricgenerator.ospametric import OSPAMetric
    from stonesoup.types.state import State

    oracle = OSPAMetric(p=1, c=1.0)
    for tracks, people in random_sets:
        sets = [[State(xy, at(0)) for xy in points] for points in (tracks, people)]
        if len(tracks) + len(people) == 0:
            continue
        expected = oracle.compute_OSPA_distance(*sets).value
        assert ospa(tracks, people, cutoff_m=1.0, order=1.0) == pytest.approx(expected)


def test_no_assignment_is_better(random_sets):
    for tracks, people in random_sets:
        fewer, more = sorted((tracks, people), key=len)
        if len(more) == 0:
            assert ospa(tracks, people) == 0.0
            continue
        best = min(
            (np.minimum(np.linalg.norm(fewer - more[list(order)], axis=-1), 1.0) ** 2).sum()
            for order in itertools.permutations(range(len(more)), len(fewer))
        )
        expected = np.sqrt((best + len(more) - len(fewer)) / len(more))
        assert ospa(tracks, people, cutoff_m=1.0, order=2.0) == pytest.approx(expected)
