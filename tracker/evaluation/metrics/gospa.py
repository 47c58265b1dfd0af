"""How far are tracks and people apart as sets? GOSPA, with its three parts."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.optimize import linear_sum_assignment

from tracker.containers import FloatArray, IntArray


@dataclass(frozen=True, slots=True)
class Gospa:
    """One instant's distance; distance^p = localisation + missed + false.

    Attributes:
        distance_m: The metric itself.
        localisation: Sum of d^p over the pairs.
        missed: c^p / 2 for each person without a track.
        false: c^p / 2 for each track without a person.
        pairs: Shape (K, 2): row of the track, row of the person.
    """

    distance_m: float
    localisation: float
    missed: float
    false: float
    pairs: IntArray


def gospa(
    tracks_xy_m: FloatArray, people_xy_m: FloatArray, cutoff_m: float = 1.0, order: float = 2.0
) -> Gospa:
    """Generalized optimal sub-pattern assignment of two sets of points, with alpha = 2.

    A pair at the cutoff or beyond counts as one missed person and one false track.

    Args:
        tracks_xy_m: Shape (N, 2).
        people_xy_m: Shape (P, 2), in the same frame.
        cutoff_m: c: no error costs more.
        order: p: above 1, far pairs weigh more.

    Source: Rahmathullah, Garcia-Fernandez, Svensson, "Generalized optimal sub-pattern assignment
        metric", FUSION 2017.
    """
    distance = np.linalg.norm(tracks_xy_m[:, None] - people_xy_m[None], axis=-1)
    cost = np.minimum(distance, cutoff_m) ** order
    rows, columns = linear_sum_assignment(cost)
    near = distance[rows, columns] < cutoff_m
    pairs = np.stack([rows[near], columns[near]], axis=-1)
    alone = cutoff_m**order / 2.0
    localisation = float(cost[pairs[:, 0], pairs[:, 1]].sum())
    missed = alone * (len(people_xy_m) - len(pairs))
    false = alone * (len(tracks_xy_m) - len(pairs))
    return Gospa(
        (localisation + missed + false) ** (1.0 / order), localisation, missed, false, pairs
    )
