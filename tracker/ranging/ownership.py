"""Whose hand is it? Probabilities of everybody who could be the owner, and of somebody unseen.

The owner of a hand stands beside its ray, at the distance that its size tells. For somebody who
stands a to the left of the ray and r along it, the hand that raised says

    p = N(a; b s, A) N(log r; log r_hand, B) P(person)

where s tells on which side the owner is (b: how far a hand is beside the body), r_hand is the
range told by the palm, and A and B hold the spread among people, the noise, and how unsure the
place is. Somebody whom nothing shows may be anywhere: p = rho r_hand, with the `newcomer_density`
rho.
What a hand says is a mean over all images in which it was followed, P(person) gathers over all
scans of a place, and the owner of the last image stays more likely than others; so a distribution
sharpens with time, and nobody who walks past takes a call along.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tracker.camera import CameraModel
from tracker.config import Config
from tracker.containers import BoolArray, FloatArray, Hands, IntArray, Measurements, Tracks
from tracker.ranging.followed_hands import NOBODY, FollowedHands, HandMeans
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
#: A hand has the owner of the last image: in log-odds, once so many images have shown it (guess:
#: one image in fifty gives it to another).
_KEEPS_OWNER, _SETTLED_IMAGES = 4.0, 8.0


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
        means = self._hands.follow(
            HandMeans(
                heading_rad=rays.wrist_bearing_rad + rays.origin[2],
                seen_ns=np.full(len(hands), stamp_ns),
                palm_px2=length_px**2,
                breadth_px2=breadth_px**2,
                side=owner_side(hands, rays.roll_rad),
                torso_rad=np.where(hands.is_owned, rays.torso_rad, np.nan),
                images=np.ones(len(hands)),
                owner_id=np.full(len(hands), NOBODY),
            ),
            stamp_ns,
        )
        range_m, spread = _ranges(means, camera)
        everybody, is_guess = self._candidates(people, background, tracked, stamp_ns, config)
        log_odds = everybody.log_person + _log_fit(
            everybody, rays.origin[:2], means, range_m, spread, config
        )
        tracked_id = np.append(tracked.id, NOBODY)
        is_customer = means.owner_id[:, None] > NOBODY  # bystanders have negative ids
        is_last = is_customer & (means.owner_id[:, None] == tracked_id[everybody.person])
        settled = np.minimum(1.0, means.images / _SETTLED_IMAGES)[:, None]
        log_odds += np.where(is_last, _KEEPS_OWNER * settled, 0.0)
        best = np.full(len(hands), -1)
        if log_odds.size:
            best = np.argmax(log_odds, axis=1)
            best[log_odds[np.arange(len(hands)), best] <= 0.0] = -1
        person = np.append(everybody.person, -1)[best]
        self._hands.owned_by(tracked_id[person])
        self._owners = Owners(
            cluster=np.where(best < len(people), best, -1),
            person=person,
            is_guess=is_guess,
            side=means.side,
            range_m=range_m,
            range_std_m=range_m * spread,
        )
        return self._owners

    def _candidates(
        self,
        people: PersonClusters,
        background: Background,
        tracked: Tracks,
        stamp_ns: int,
        config: Config,
    ) -> tuple[_Candidates, BoolArray]:
        """The clusters, and people whom the scan showed earlier but not now; and `is_guess`.

        Who is known by hands alone is the very person not seen, and no rival to whom the scan
        shows.
        """
        xy_m = tracked.mean[:, :2] + tracked.mean[:, 2:] * (stamp_ns - tracked.stamp_ns) / 1e9
        apart_m = np.linalg.norm(xy_m[:, None] - people.xy_m, axis=-1)
        is_shown = apart_m.min(axis=1, initial=np.inf) <= SHOWN_M
        has_been = is_shown | np.isin(tracked.id, self._shown_ids)
        self._shown_ids = tracked.id[has_been]
        hidden = np.flatnonzero(has_been & ~is_shown & (tracked.age_s > _TRACKED_AFTER_S))
        person = np.full(len(people), -1)
        if is_shown.any():
            is_near = apart_m.min(axis=0) <= SHOWN_M
            person = np.where(is_near, apart_m.argmin(axis=0), -1)
        of_cluster_m2 = np.tile(config.range_std_m**2 * np.eye(2), (len(people), 1, 1))
        places_m = np.concatenate([people.xy_m, xy_m[hidden]])
        by_shape = np.concatenate([people.log_odds, np.zeros(len(hidden))])
        log_person = background.log_person(places_m, by_shape)
        log_person[len(people) :] += np.log(tracked.existence[hidden])
        candidates = _Candidates(
            xy_m=places_m,
            covariance_m2=np.concatenate([of_cluster_m2, tracked.covariance[hidden, :2, :2]]),
            log_person=log_person,
            person=np.concatenate([person, hidden]),
        )
        return candidates, ~has_been

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
class _Candidates:
    """Who could be the owner: C clusters, then people whom the scan does not show."""

    xy_m: FloatArray  # (K, 2): where they are now
    covariance_m2: FloatArray  # (K, 2, 2), of that
    log_person: FloatArray  # (K,): log-odds that it is a person at all
    person: IntArray  # (K,): row among the people tracked; -1: none of them


def _log_fit(
    candidates: _Candidates,
    origin_m: FloatArray,
    means: HandMeans,
    range_m: FloatArray,
    spread: FloatArray,
    config: Config,
) -> FloatArray:
    """How much better each candidate fits each hand than somebody unseen, log, shape (H, K)."""
    is_owned = np.isfinite(means.torso_rad)
    heading = means.heading_rad + np.where(is_owned, means.torso_rad, 0.0)
    beside_m = np.where(is_owned, 0.0, BESIDE_M * means.side)[:, None]
    beside_std_m = np.where(is_owned, config.torso_offset_std_m, config.hand_offset_std_m)
    along, across = ray_coordinates(candidates.xy_m, origin_m, heading)
    ahead = np.stack([np.cos(heading), np.sin(heading)], axis=-1)
    left = np.stack([-ahead[:, 1], ahead[:, 0]], axis=-1)
    along_m2, left_m2 = (
        np.einsum("hi,kij,hj->hk", to, candidates.covariance_m2, to) for to in (ahead, left)
    )
    reach_m = config.arm_reach_m + _NOISE_STDS * np.sqrt(left_m2)
    is_beside = (along > 0.0) & (np.abs(across) <= reach_m)
    along = np.maximum(along, 0.05)
    across_m2 = beside_std_m[:, None] ** 2 + left_m2
    size = np.isfinite(range_m)[:, None]
    log_ratio = np.where(size, np.log(along / range_m[:, None]), 0.0)
    log2 = np.where(size, spread[:, None] ** 2, 1.0) + along_m2 / along**2
    log_fit = -((across - beside_m) ** 2) / (2.0 * across_m2) - log_ratio**2 / (2.0 * log2)
    log_fit -= 0.5 * np.log(across_m2 * log2) + np.log(2 * np.pi)
    log_fit -= np.log(config.newcomer_density * np.where(size, range_m[:, None], along))
    return np.asarray(np.where(is_beside, log_fit, -np.inf))


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
