"""Whose hand is it? Probabilities of everybody who could be the owner, and of somebody unseen.

The owner of a hand stands beside its ray, at the distance that its size tells. For somebody who
stands a to the left of the ray and r along it, the hand that raised says

    p = N(a; b s, A) N(log r; log r_hand, B) P(person)

where s tells on which side the owner is (b: how far a hand is beside the body), r_hand is the
range told by the palm, and A and B hold the spread among people, the noise, and how unsure the
place is. Somebody whom nothing shows may be anywhere: p = rho r_hand, with the `newcomer_density`
rho.
What a hand says is a mean over all images in which it was followed, and P(person) gathers over all
scans of a place; so a distribution sharpens with time.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tracker.camera import CameraModel
from tracker.config import Config
from tracker.containers import BoolArray, FloatArray, Hands, IntArray, Measurements, Tracks
from tracker.ranging.followed_hands import FollowedHands, HandMeans
from tracker.ranging.person_range import (
    BESIDE_M,
    LANDMARK_STD_PX,
    PALM_BREADTH,
    PALM_MIN_PX,
    RANGE_SPREAD,
    owner_side,
    palms_px,
    range_of_palm_m,
    ray_coordinates,
)
from tracker.ranging.rays import HandRays
from tracker.ranging.scan.background import Background
from tracker.ranging.scan.people import PersonClusters

#: A cluster this close to where somebody tracked is expected shows them.
SHOWN_M = 0.4
#: The tracker is told so in log-odds: it would ask one image what all have answered.
SURE = 20.0
#: Where a body is may be off by so many standard deviations.
_NOISE_STDS = 3.0
#: A track this young may be anything; only its cluster speaks for it (guess).
_TRACKED_AFTER_S = 1.0


@dataclass(frozen=True, slots=True, eq=False)
class Owners:
    """Of H hands.

    Attributes:
        cluster: Shape (H,): row of the owner's cluster; -1 where no cluster shows the owner.
        person: Shape (H,): row of the owner among the people tracked; -1 where nobody known is.
        is_guess: Shape (N,): of the people tracked, those whom hands alone have shown so far.
        side: Shape (H,): `owner_side`, over all images.
        range_m: Shape (H,): told by the palm, over all images; NaN where it is too short to tell.
        range_std_m: Shape (H,).
    """

    cluster: IntArray
    person: IntArray
    is_guess: BoolArray
    side: FloatArray
    range_m: FloatArray
    range_std_m: FloatArray


class Ownership:
    """Follows hands, and weighs who owns them."""

    def __init__(self) -> None:
        self._hands = FollowedHands()
        self._owners: Owners | None = None
        self._shown_ids = np.zeros(0, dtype=np.int64)

    def reset(self) -> None:
        """Forget all hands."""
        self._hands.reset()
        self._owners, self._shown_ids = None, np.zeros(0, dtype=np.int64)

    def judge(
        self,
        hands: Hands,
        rays: HandRays,
        camera: CameraModel,
        people: PersonClusters,
        background: Background,
        tracked: Tracks,
        stamp_ns: int,
        config: Config,
    ) -> Owners:
        """Who owns each hand of an image?

        Args:
            hands: H in the picture.
            rays: Their directions.
            camera: Intrinsics of the full image.
            people: C clusters, in the fixed frame of the rays.
            background: Tells how likely each place is a person's.
            tracked: Everybody at the last image; velocities carry them on.
            stamp_ns: The image's.
            config: `arm_reach_m`, the spreads of where hands stand, and `newcomer_density`.
        """
        length_px, breadth_px = palms_px(hands, camera)
        heading = rays.bearing_rad + rays.origin[2]
        means = self._hands.follow(
            HandMeans(
                heading_rad=heading,
                seen_ns=np.full(len(hands), stamp_ns),
                palm_px2=length_px**2,
                breadth_px2=breadth_px**2,
                side=owner_side(hands, rays.roll_rad),
                images=np.ones(len(hands)),
            ),
            stamp_ns,
        )
        range_m, spread = _ranges(means, camera)
        hidden, is_guess = self._hidden(tracked, people, stamp_ns)
        xy_m = np.concatenate([people.xy_m, hidden.xy_m])
        of_cluster_m2 = np.tile(config.range_std_m**2 * np.eye(2), (len(people), 1, 1))
        unsure_m2 = np.concatenate([of_cluster_m2, hidden.covariance_m2])
        by_shape = np.concatenate([people.log_odds, np.zeros(len(hidden.row))])
        log_there = background.log_person(xy_m, by_shape)
        log_there[len(people) :] += hidden.log_existence

        along, across = ray_coordinates(xy_m, rays.origin[:2], heading)
        ahead = np.stack([np.cos(heading), np.sin(heading)], axis=-1)
        left = np.stack([-ahead[:, 1], ahead[:, 0]], axis=-1)
        along_m2, left_m2 = (np.einsum("hi,kij,hj->hk", to, unsure_m2, to) for to in (ahead, left))
        reach_m = config.arm_reach_m + _NOISE_STDS * np.sqrt(left_m2)
        is_beside = (along > 0.0) & (np.abs(across) <= reach_m)
        along = np.maximum(along, 0.05)
        beside_m = np.where(hands.is_owned, config.torso_offset_std_m, config.hand_offset_std_m)
        across_m2 = beside_m[:, None] ** 2 + left_m2
        size = np.isfinite(range_m)[:, None]
        log_ratio = np.where(size, np.log(along / range_m[:, None]), 0.0)
        log2 = np.where(size, spread[:, None] ** 2, 1.0) + along_m2 / along**2
        log_odds = log_there - (across - BESIDE_M * means.side[:, None]) ** 2 / (2.0 * across_m2)
        log_odds -= (
            log_ratio**2 / (2.0 * log2) + 0.5 * np.log(across_m2 * log2) + np.log(2 * np.pi)
        )
        log_odds -= np.log(config.newcomer_density * np.where(size, range_m[:, None], along))
        log_odds = np.where(is_beside, log_odds, -np.inf)
        best = np.full(len(hands), -1)
        if len(xy_m):
            best = np.argmax(log_odds, axis=1)
            best[log_odds[np.arange(len(hands)), best] <= 0.0] = -1
        is_cluster = (best >= 0) & (best < len(people))
        person = np.full(len(hands), -1)
        is_hidden = best >= len(people)
        person[is_hidden] = hidden.row[best[is_hidden] - len(people)]
        self._owners = Owners(
            cluster=np.where(is_cluster, best, -1),
            person=person,
            is_guess=is_guess,
            side=means.side,
            range_m=range_m,
            range_std_m=range_m * spread,
        )
        return self._owners

    def _hidden(
        self, tracked: Tracks, people: PersonClusters, stamp_ns: int
    ) -> tuple[_Hidden, BoolArray]:
        """People the scan showed earlier but not now, and people known only by their hands.

        A guess is the very person not seen, and no rival to whom the scan shows.
        """
        xy_m = tracked.mean[:, :2] + tracked.mean[:, 2:] * (stamp_ns - tracked.stamp_ns) / 1e9
        apart_m = np.linalg.norm(xy_m[:, None] - people.xy_m, axis=-1)
        is_shown = apart_m.min(axis=1, initial=np.inf) <= SHOWN_M
        has_been = is_shown | np.isin(tracked.id, self._shown_ids)
        self._shown_ids = tracked.id[has_been]
        row = np.flatnonzero(has_been & ~is_shown & (tracked.age_s > _TRACKED_AFTER_S))
        covariance_m2, existence = tracked.covariance[row, :2, :2], tracked.existence[row]
        return _Hidden(row, xy_m[row], covariance_m2, np.log(existence)), ~has_been

    def likeness(
        self, measurements: Measurements, people: int, is_seen: BoolArray | None = None
    ) -> FloatArray:
        """What was judged, for the tracker's log-odds.

        Where a cluster is the owner's it is measured, and speaks for itself.

        Args:
            measurements: M, of the hands judged last among others.
            people: N, the people tracked at the last image.
            is_seen: Shape (H,): hands whose owner another sensor has measured; None means no hand.

        Returns:
            Shape (N, M).
        """
        likeness = np.zeros((people, len(measurements)))
        if self._owners is None:
            return likeness
        column = np.flatnonzero(measurements.hand >= 0)
        hand = measurements.hand[column]
        is_open = self._owners.cluster[hand] < 0
        if is_seen is not None:
            is_open &= ~is_seen[hand]
        column, hand = column[is_open], hand[is_open]
        likeness[np.ix_(~self._owners.is_guess, column)] = -SURE
        is_known = self._owners.person[hand] >= 0
        likeness[self._owners.person[hand[is_known]], column[is_known]] = SURE
        return likeness


@dataclass(frozen=True, slots=True, eq=False)
class _Hidden:
    """People whom the scan does not show; row i of each array is the same one."""

    row: IntArray  # (K,), of the people tracked
    xy_m: FloatArray  # (K, 2): where they are expected now
    covariance_m2: FloatArray  # (K, 2, 2), of that
    log_existence: FloatArray  # (K,)


def _ranges(means: HandMeans, camera: CameraModel) -> tuple[FloatArray, FloatArray]:
    """Range told by the palm, and its relative spread, each of shape (H,).

    Noise makes short lengths look longer: |p|^2 is on average L^2 + 4 s^2 for two landmarks with
    the standard deviation s per axis, which is taken off. A palm that tilts away looks short but
    not slim: its breadth tells where that is more than the breadth's own noise.
    """
    noise_px = np.sqrt(2.0 / means.images) * LANDMARK_STD_PX
    excess_px2 = 4.0 * LANDMARK_STD_PX**2
    length_px = np.sqrt(np.maximum(means.palm_px2 - excess_px2, means.palm_px2 / 4.0))
    breadth_px2 = means.breadth_px2 - excess_px2 / PALM_BREADTH**2
    breadth_px = np.sqrt(np.maximum(breadth_px2, means.breadth_px2 / 4.0))
    palm_px = np.maximum(length_px, breadth_px - noise_px / PALM_BREADTH)
    range_m = np.where(palm_px >= PALM_MIN_PX, range_of_palm_m(palm_px, camera), np.nan)
    return range_m, np.hypot(RANGE_SPREAD, noise_px / palm_px)
