"""Who stands in the scan? Person-sized segments, legs paired, as positions in the fixed frame.

Segmentation by jump distance, a filter on width and shape, and pairing of legs. What is wider than
a body is background, and so is what is flat, unless it stands free: a board, a piece of a wall
between two chairs.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

import numpy as np

from tracker.containers import BoolArray, FloatArray, IntArray, LocatedScan
from tracker.containers.rows import Column, Rows
from tracker.ranging.scan.room_map import RoomMap
from tracker.ranging.scan.segments import Segments, find_segments

#: A trouser leg is about 0.12 to 0.2 m across, and seldom less or more than this.
TROUSERS_WIDTH_MIN_M, TROUSERS_WIDTH_MAX_M = 0.075, 0.2
#: What is wider and flatter than this is a board; of 100 legs and bodies marked in scans 3 are.
FLATNESS_MIN = 0.1
#: Wider than this is a body, a skirt or both legs in one, and needs no second leg.
LEG_WIDTH_MAX_M = 0.26
#: Centers of the two legs of one person who walks are no farther apart than this.
LEG_PAIR_DISTANCE_M = 0.45
#: From these log-odds on something is a post when legs are paired: posts and legs are not (guess).
_FURNITURE_LOG_ODDS = 1.0
#: What the laser sees is the near skin; the middle of a leg lies about this far behind it.
LEG_RADIUS_M = 0.06
#: How much oftener than anything else people look like two legs, one thing as broad as a body, one
#: leg, or something slimmer: logarithms of ratios, counted in three scans in which people are
#: marked (leg_tracker's positive_1, 2 and 6: 481 pieces of people, 6 881 others).
_LOG_ODDS_LEGS, _LOG_ODDS_BODY, _LOG_ODDS_LEG, _LOG_ODDS_SLIM = 1.14, -0.73, -0.76, -2.4
#: More person-sized things than this are noise; the nearest are kept.
_SEGMENTS_MAX = 500


@dataclass(frozen=True, eq=False)
class PersonClusters(Rows):
    """Person-sized things of one scan; row i of each array is the same one.

    Attributes:
        xy_m: Shape (C, 2): supposed middle of the body, in the fixed frame.
        width_m: Shape (C,): from the first to the last point.
        legs: Shape (C,), int64: segments it was put together from.
        furniture_log_odds: Shape (C,): natural logarithm of how much likelier furniture is than a
            person, by what is known of the place; 0 where nothing is.
    """

    xy_m: Annotated[FloatArray, Column((2,))]
    width_m: FloatArray
    legs: IntArray
    furniture_log_odds: FloatArray

    @property
    def is_slim(self) -> BoolArray:
        """Shape (C,): one thing alone, thinner than a trouser leg, as of chairs and tables."""
        return np.asarray((self.legs == 1) & (self.width_m < TROUSERS_WIDTH_MIN_M))

    @property
    def log_odds(self) -> FloatArray:
        """Shape (C,): of a person against anything else, by shape and by what is known there."""
        by_shape = np.select(
            [self.legs > 1, self.width_m > LEG_WIDTH_MAX_M, self.is_slim],
            [_LOG_ODDS_LEGS, _LOG_ODDS_BODY, _LOG_ODDS_SLIM],
            _LOG_ODDS_LEG,
        )
        return np.asarray(by_shape - self.furniture_log_odds)


def find_people(
    scan: LocatedScan,
    *,
    segment_jump_m: float,
    leg_width_min_m: float,
    body_width_m: float,
    range_max_m: float,
    room: RoomMap | None = None,
) -> PersonClusters:
    """Find what could be a person at the height of the laser.

    Args:
        scan: The scan, in the fixed frame.
        segment_jump_m: Neighboring points farther apart than this part segments.
        leg_width_min_m: Thinner segments are no legs.
        body_width_m: Wider segments are background.
        range_max_m: Segments all of which is farther are left alone.
        room: The map, for points of the fixed frame; None where there is none.

    Returns:
        The clusters, by angle around the laser.
    """
    if not scan.valid.any():
        return PersonClusters.none()
    found = find_segments(scan, segment_jump_m)
    is_body = _is_person_sized(found, leg_width_min_m, body_width_m)
    # Judged as a whole: a wall that runs out of range is not cut down to a person.
    is_body &= (found.range_m <= range_max_m) & ~found.is_in_gap
    is_body &= found.range_m <= _farthest_m(found.range_m[is_body])
    heading = scan.heading_rad[found.rows]
    inward = LEG_RADIUS_M * np.stack([np.cos(heading), np.sin(heading)], axis=-1)
    total = np.add.reduceat(scan.xy_m[found.rows] + inward, found.begins)
    middle = total[is_body] / found.beams[is_body, None]
    log_odds = np.zeros(len(middle))
    if room is not None:
        log_odds = room.furniture_log_odds(_distance_m(scan, found, inward, room)[is_body])
    return _pair_legs(middle, found.width_m[is_body], log_odds)


def _distance_m(
    scan: LocatedScan, found: Segments, inward: FloatArray, room: RoomMap
) -> FloatArray:
    """Shape (S,): how far from occupied cells each segment has a point; NaN where nobody knows.

    The farthest point counts: a shin that touches a table's post is one segment with it, and no
    furniture. Of a slim post the map shows the surface or the middle: the nearer one counts.
    """
    points = scan.xy_m[found.rows]
    distance_m = np.fmin(room.distance_m(points), room.distance_m(points + inward))
    return np.asarray(np.fmax.reduceat(distance_m, found.begins))


def _is_person_sized(found: Segments, leg_width_min_m: float, body_width_m: float) -> BoolArray:
    """Whether a segment is as wide as a leg or a body, and not flat like a board.

    Two beams show a leg only where they lie as far apart as a trouser leg is wide.
    """
    # The outermost beams miss the edges by up to one spacing in all.
    width = found.width_m + found.spacing_m
    is_leg = (found.beams >= 3) | ((found.beams == 2) & (width >= TROUSERS_WIDTH_MIN_M))
    is_board = (found.flatness < FLATNESS_MIN) & (found.width_m > TROUSERS_WIDTH_MAX_M)
    is_sized = (width >= leg_width_min_m) & (found.width_m <= body_width_m)
    return np.asarray(is_leg & is_sized & ~(is_board & ~found.stands_free))


def _farthest_m(range_m: FloatArray) -> float:
    """Largest range that is searched, so that the number of people stays limited."""
    return float(np.sort(range_m)[_SEGMENTS_MAX - 1]) if len(range_m) > _SEGMENTS_MAX else np.inf


def _pair_legs(centers: FloatArray, width: FloatArray, log_odds: FloatArray) -> PersonClusters:
    """Join leg-sized segments two by two, the closest pairs first; posts with posts alone."""
    count = len(centers)
    legs, posts = width <= LEG_WIDTH_MAX_M, log_odds > _FURNITURE_LOG_ODDS
    distance = np.linalg.norm(centers[:, None] - centers[None], axis=-1)
    pairs = legs[:, None] & legs[None] & (distance <= LEG_PAIR_DISTANCE_M)
    pairs &= posts[:, None] == posts[None]
    candidates = np.argwhere(np.triu(pairs, k=1))
    candidates = candidates[np.argsort(distance[tuple(candidates.T)], kind="stable")]
    partner = np.full(count, -1)
    for a, b in candidates:
        if partner[a] < 0 and partner[b] < 0:
            partner[a], partner[b] = b, a
    keep = (partner < 0) | (partner > np.arange(count))
    xy = np.where((partner >= 0)[:, None], (centers + centers[partner]) / 2, centers)
    total = np.where(partner >= 0, width + distance[np.arange(count), partner], width)
    log_odds = np.where(partner >= 0, (log_odds + log_odds[partner]) / 2, log_odds)
    return PersonClusters(
        xy[keep], total[keep], np.where(partner >= 0, 2, 1)[keep], log_odds[keep]
    )
