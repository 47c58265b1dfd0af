"""Which hands did the camera see, and which bodies of the scan could be theirs?"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Annotated

import numpy as np

from tracker.camera import CameraModel
from tracker.config import Config
from tracker.containers import FloatArray, FrameResult, IntArray
from tracker.containers.rows import Column, Rows
from tracker.geometry import RigidTransform
from tracker.ranging.measuring import scan_people
from tracker.ranging.person_range import owner_side, ray_coordinates, size_misfit
from tracker.ranging.rays import hand_rays

#: Bodies farther to a side of a hand's ray are nobody's, however wrong the mounting is.
_BESIDE_MAX_M = 1.5
_AHEAD_MIN_M = 0.3


@dataclass(frozen=True, eq=False)
class Sightings(Rows):
    """Raised hands and bodies; row i is one hand with one body that could be its owner's.

    The frame is the camera's body frame (x forward, y left), where the transforms believe it.

    Attributes:
        stamp_ns: Shape (K,), of the image.
        hand: Shape (K,): rows of one hand share a number.
        bearing_rad: Shape (K,), of the hand, counter-clockwise.
        std_rad: Shape (K,): noise of that, and of where hands are beside bodies.
        side: Shape (K,): where the owner stands, from 1 (left of the hand) to -1; 0 on its ray.
        body_xy_m: Shape (K, 2): the body, from the scan.
        size_misfit: Shape (K,): how badly the hand's size fits the body's distance, in squared
            standard deviations.
    """

    stamp_ns: IntArray
    hand: IntArray
    bearing_rad: FloatArray
    std_rad: FloatArray
    side: FloatArray
    body_xy_m: Annotated[FloatArray, Column((2,))]
    size_misfit: FloatArray

    @classmethod
    def concatenate(cls, *parts: Sightings) -> Sightings:
        """Frames one after the other; hands are numbered anew."""
        counts = [int(part.hand.max(initial=-1)) + 1 for part in parts]
        before = np.cumsum([0, *counts[:-1]])
        renumbered = [
            replace(part, hand=part.hand + number)
            for part, number in zip(parts, before, strict=False)
        ]
        return super().concatenate(*renumbered)


def sightings_of(
    result: FrameResult, camera: CameraModel, fixed_from_camera: RigidTransform, config: Config
) -> Sightings:
    """Raised hands of one image with every body of its scan that is near their rays.

    Args:
        result: Of the pipeline.
        camera: Intrinsics of the full image.
        fixed_from_camera: The camera with body axes, where it is believed to be.
        config: Person-sized lengths, and the noise of hands.
    """
    hands = result.hands[result.hands.raised]
    people = scan_people(result.scan, config)
    if len(hands) == 0 or len(people) == 0:
        return Sightings.none()
    rays = hand_rays(hands, camera, fixed_from_camera, config)
    heading = rays.bearing_rad + rays.origin[2]
    along, across = ray_coordinates(people.xy_m, rays.origin[:2], heading)
    near = (along > _AHEAD_MIN_M) & (np.abs(across) < _BESIDE_MAX_M)
    hand, body = np.nonzero(near)
    ahead, left = ray_coordinates(people.xy_m, rays.origin[:2], rays.origin[2:])
    xy_m = np.stack([ahead[0], left[0]], axis=-1)[body]
    offset_std_m = np.where(hands.is_owned, config.torso_offset_std_m, config.hand_offset_std_m)
    beside_std = np.arctan2(offset_std_m[hand], np.hypot(xy_m[:, 0], xy_m[:, 1]))
    return Sightings(
        stamp_ns=np.full(len(hand), result.stamp_ns, dtype=np.int64),
        hand=hand,
        bearing_rad=rays.bearing_rad[hand],
        std_rad=np.hypot(rays.bearing_std_rad[hand], beside_std),
        side=owner_side(hands, rays.roll_rad)[hand],
        body_xy_m=xy_m,
        size_misfit=size_misfit(hands, camera, along)[near],
    )
