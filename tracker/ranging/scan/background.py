"""What has stood still so long that it must be furniture? Learned, and forgotten when it moves.

A chair or a pillar is as wide as a leg. What has stood exactly still for long, and is no customer,
sustains nobody. The place is free again once a beam has passed through it.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Annotated

import numpy as np

from tracker.containers import BoolArray, FloatArray, IntArray, LocatedScan
from tracker.containers.rows import Column, Rows
from tracker.ranging.scan.beams import beam_index
from tracker.ranging.scan.people import PersonClusters

#: What moves less than this stands still: noise of a cluster's middle and of the robot's pose.
STILL_M = 0.12
#: People who stand, and those who sit, stay exactly where they are for so long (guesses).
_STANDS_S, _SITS_S = 10.0, 300.0
#: A beam that ends this far behind a place has passed through it ...
_THROUGH_M = 0.3
#: ... and so many scans in a row are no drop-outs.
_THROUGH_SCANS = 5
#: Weight of the newest sighting in a place's mean, at least.
_GAIN_MIN = 0.02
#: Memory: the places seen last are kept.
_PLACES_MAX = 512
#: Between two scans farther apart than this nobody knows who stood still.
_GAP_MAX_S = 1.0


class Background:
    """Places of the fixed frame where something person-sized stands still."""

    def __init__(self) -> None:
        self._places = _Places.none()
        self._stamp_ns: int | None = None

    def reset(self) -> None:
        """Forget everything."""
        self._places, self._stamp_ns = _Places.none(), None

    def observe(self, scan: LocatedScan, clusters: PersonClusters, after_s: float) -> None:
        """Learn from one scan, and forget what it has looked through.

        Args:
            scan: The scan, in the fixed frame.
            clusters: The person-sized things found in it.
            after_s: What has stood still for so long is background; what looks e times less like a
                person than like anything else is so e times sooner.
        """
        lapse_s = 0.0
        if self._stamp_ns is not None:
            lapse_s = float(np.clip((scan.stamp_ns - self._stamp_ns) / 1e9, 0.0, _GAP_MAX_S))
        self._stamp_ns = scan.stamp_ns
        places = self._places
        distance = _distances(places.xy_m, clusters.xy_m)
        is_there = distance.min(axis=1, initial=np.inf) < STILL_M
        rows = np.flatnonzero(is_there)
        seen = places.sightings + is_there
        gain = np.maximum(1.0 / np.maximum(seen[rows], 1), _GAIN_MIN)[:, None]
        xy, kind = places.xy_m.copy(), places.log_odds.copy()
        if len(rows):
            cluster = distance[rows].argmin(axis=1)
            xy[rows] += gain * (clusters.xy_m[cluster] - xy[rows])
            kind[rows] += gain[:, 0] * (clusters.log_odds[cluster] - kind[rows])
        stood_s = places.stood_s + lapse_s * is_there
        is_through = ~is_there & _is_looked_through(places.xy_m, scan)
        through = np.where(is_through, places.through + 1, places.through * ~is_there)
        seen_ns = np.where(is_there, scan.stamp_ns, places.seen_ns)
        needs_s = after_s * np.exp(np.minimum(kind, 0.0))
        is_background = places.is_background | (stood_s >= needs_s)
        places = _Places(xy, kind, stood_s, seen, seen_ns, through, is_background)
        forgotten_ns = scan.stamp_ns - round(after_s * 1e9)
        places = places[
            (through < _THROUGH_SCANS) & (places.is_background | (seen_ns >= forgotten_ns))
        ]
        is_new = distance.min(axis=0, initial=np.inf) >= STILL_M
        new = _Places.begin(clusters.xy_m[is_new], clusters.log_odds[is_new], scan.stamp_ns)
        places = _Places.concatenate(places, new)
        if len(places) > _PLACES_MAX:
            order = np.argsort(places.seen_ns, kind="stable")
            places = places[order[-_PLACES_MAX:]]
        self._places = places

    def holds(self, xy_m: FloatArray) -> BoolArray:
        """Which points, shape (C, 2), are background; shape (C,)."""
        known = self._places.xy_m[self._places.is_background]
        return np.asarray((_distances(known, xy_m) < STILL_M).any(axis=0))

    def log_person(self, xy_m: FloatArray, log_odds: FloatArray) -> FloatArray:
        """Log-probability that a person stands at each point, shape (C,).

        By what it looks like, in all scans of its place, and by how long it has not
        moved, which lasts for minutes where somebody sits.

        Args:
            xy_m: Shape (C, 2).
            log_odds: Shape (C,): `PersonClusters.log_odds`; counts where the place is new.
        """
        distance, stood_s = _distances(xy_m, self._places.xy_m), np.zeros(len(xy_m))
        if distance.size:
            place = distance.argmin(axis=1)
            is_known = distance.min(axis=1) < STILL_M
            log_odds = np.where(is_known, self._places.log_odds[place], log_odds)
            stood_s = np.where(is_known, self._places.stood_s[place], stood_s)
        sits = np.exp(-stood_s / _SITS_S)
        log_odds = log_odds + np.log(0.5 * np.exp(-stood_s / _STANDS_S) + 0.5 * sits)
        return np.asarray(-np.logaddexp(0.0, -log_odds))

    def spare(self, customers_xy_m: FloatArray, distance_m: float) -> None:
        """A customer who stands still does not become background; old background stays."""
        places = self._places
        near = (_distances(places.xy_m, customers_xy_m) < distance_m).any(axis=1)
        stood_s = np.where(near & ~places.is_background, 0.0, places.stood_s)
        self._places = replace(places, stood_s=stood_s)

    def free(self, xy_m: FloatArray) -> None:
        """A hand was raised there: these points are people, not background."""
        places = self._places
        is_near = (_distances(places.xy_m, xy_m) < STILL_M).any(axis=1)
        stood_s = np.where(is_near, 0.0, places.stood_s)
        is_background = places.is_background & ~is_near
        self._places = replace(places, stood_s=stood_s, is_background=is_background)


@dataclass(frozen=True, eq=False)
class _Places(Rows):
    """Row i of each array is one place."""

    xy_m: Annotated[FloatArray, Column((2,))]  # (K, 2), in the fixed frame
    log_odds: FloatArray  # (K,): `PersonClusters.log_odds`, mean over the sightings
    stood_s: FloatArray  # (K,): how long something has been seen there
    sightings: IntArray  # (K,)
    seen_ns: IntArray  # (K,)
    through: IntArray  # (K,): scans in a row that looked through it
    is_background: BoolArray  # (K,)

    @staticmethod
    def begin(xy_m: FloatArray, log_odds: FloatArray, stamp_ns: int) -> _Places:
        count = len(xy_m)
        one, none = np.ones(count, dtype=np.int64), np.zeros(count, dtype=np.int64)
        return _Places(
            xy_m, log_odds, np.zeros(count), one, one * stamp_ns, none, none.astype(bool)
        )


def _distances(a_m: FloatArray, b_m: FloatArray) -> FloatArray:
    apart = a_m[:, None] - b_m
    return np.asarray(np.hypot(apart[..., 0], apart[..., 1]))


def _is_looked_through(xy_m: FloatArray, scan: LocatedScan) -> BoolArray:
    """Shape (K,): the beam toward a place ends well behind it, or nowhere."""
    offset = xy_m - scan.laser_xy_m
    beam = beam_index(scan, np.arctan2(offset[:, 1], offset[:, 0]))
    inside = (beam >= 0) & (beam < len(scan))
    ends_m = scan.range_m[np.where(inside, beam, 0)]
    # NaN says nothing; infinity says that nothing was there.
    return np.asarray(inside & (ends_m > np.hypot(offset[:, 0], offset[:, 1]) + _THROUGH_M))
