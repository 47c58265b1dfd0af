"""How far are tracks and people apart as sets? GOSPA, with its three parts."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tracker.containers import BoolArray, FloatArray, IntArray
from tracker.evaluation.metrics.matching import distances, match_best


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


@dataclass(frozen=True, slots=True, eq=False)
class GospaFrames:
    """The same of T instants.

    Attributes:
        distance_m: Shape (T,).
        localisation: Shape (T,).
        missed: Shape (T,).
        false: Shape (T,).
        pairs: Shape (T, N, P): which track is paired with which person.
    """

    distance_m: FloatArray
    localisation: FloatArray
    missed: FloatArray
    false: FloatArray
    pairs: BoolArray


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
    apart_m = distances(tracks_xy_m[None], people_xy_m[None])
    counts = np.array([len(tracks_xy_m)]), np.array([len(people_xy_m)])
    one = gospa_frames(apart_m, *counts, cutoff_m, order)
    return Gospa(
        float(one.distance_m[0]),
        float(one.localisation[0]),
        float(one.missed[0]),
        float(one.false[0]),
        np.argwhere(one.pairs[0]),
    )


def gospa_frames(
    apart_m: FloatArray,
    tracks: IntArray,
    people: IntArray,
    cutoff_m: float = 1.0,
    order: float = 2.0,
) -> GospaFrames:
    """`gospa` of many instants at once.

    Args:
        apart_m: Shape (T, N, P), from `matching.distances`.
        tracks: Shape (T,): how many tracks there are.
        people: Shape (T,): how many people there are.
        cutoff_m: c.
        order: p.
    """
    alone = cutoff_m**order / 2.0
    cost = np.minimum(apart_m, cutoff_m) ** order
    pairs = match_best(2.0 * alone - cost)
    paired = np.count_nonzero(pairs, axis=(1, 2))
    localisation = np.where(pairs, cost, 0.0).sum(axis=(1, 2))
    missed, false = alone * (people - paired), alone * (tracks - paired)
    distance = (localisation + missed + false) ** (1.0 / order)
    return GospaFrames(distance, localisation, missed, false, pairs)
