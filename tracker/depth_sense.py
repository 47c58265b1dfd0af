"""Which people does the depth camera show? From depth images to measurements."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from tracker.camera import CameraModel
from tracker.config import Config
from tracker.containers import FloatArray, Hands, Measurements, View
from tracker.geometry import RigidTransform
from tracker.locating import CameraPlace, DepthLocator
from tracker.notes import Note
from tracker.ranging import Background, hand_rays
from tracker.ranging.depth import (
    DepthBodies,
    DepthPoints,
    HandDepths,
    body_measurements,
    find_bodies,
    hand_depths,
    without_seen,
)
from tracker.waiting import WaitingRoom


@dataclass(frozen=True, slots=True, eq=False)
class DepthSight:
    """What one depth image shows.

    Attributes:
        points: In the fixed frame.
        bodies: Who may stand there.
    """

    points: DepthPoints
    bodies: DepthBodies

    def view(self, range_max_m: float) -> View:
        """Where it could show people."""
        pose = np.append(self.points.pose[:2], 0.0)
        return View.between(pose, *self.bodies.slice.span_rad, range_max_m)


class DepthSense:
    """Finds the depth image for each image; remembers the room's furniture as depth shows it."""

    def __init__(self) -> None:
        self._locator = DepthLocator()
        self.reset()

    def reset(self) -> None:
        """Forget everything but the depth camera's intrinsics."""
        self._background = Background()
        self._sustained_ns = -1
        self._has_come = False

    def calibrate(self, camera: CameraModel) -> None:
        """Take in the depth camera's intrinsics."""
        self._locator.calibrate(camera)

    def look(
        self,
        room: WaitingRoom,
        stamp_ns: int,
        frame_id: str,
        place: CameraPlace,
        color: CameraModel,
        config: Config,
    ) -> tuple[DepthSight | None, list[Note]]:
        """What the depth image nearest to an image shows.

        Args:
            room: Where depth images and transforms are.
            stamp_ns: Of what the image shows.
            frame_id: The image's own frame.
            place: Where it was taken.
            color: Its intrinsics.
            config: The ranging and the frames group.

        Returns:
            None, with the reason, where there is none of use. Without a reason where none is
            wanted, or where none has ever come and none has to.
        """
        if config.depth_source == "scan":
            return None, []
        waiting = room.depths_by_age(stamp_ns)
        self._has_come |= bool(waiting)
        if not self._has_come and config.depth_source == "both":
            return None, []
        points, notes = self._locator.choose(
            waiting, room.transforms, stamp_ns, place, color, frame_id, config
        )
        return (None if points is None else DepthSight(points, find_bodies(points, config))), notes

    def ask(
        self,
        sight: DepthSight | None,
        hands: Hands,
        camera: CameraModel,
        fixed_from_camera: RigidTransform,
        config: Config,
    ) -> tuple[Hands, HandDepths | None]:
        """How far hands' owners are; None where no depth image tells.

        Returns:
            The hands too: without the torsos that are somebody else's, as depth shows.
        """
        if sight is None:
            return hands, None
        for _ in range(2):
            rays = hand_rays(hands, camera, fixed_from_camera, config)
            depths = hand_depths(hands, rays, sight.points, camera, fixed_from_camera, config)
            if not depths.is_strange.any():
                break
            torso_px = np.where(depths.is_strange[:, None], np.nan, hands.torso_px)
            hands = replace(hands, torso_px=torso_px)
        return hands, depths

    def complete(
        self,
        claims: Measurements,
        sight: DepthSight,
        hands: Hands,
        depths: HandDepths,
        stamp_ns: int,
        config: Config,
    ) -> Measurements:
        """The claims of hands and scan, and those of the bodies for which no hand speaks.

        Several images may use one depth image; its bodies speak only once.

        Args:
            claims: Of hands and of the scan.
            sight: What the depth image shows.
            hands: Of the image it is used for.
            depths: From `ask`, of these hands.
            stamp_ns: Of the image.
            config: The ranging group.
        """
        people, seen_ns = sight.bodies.people, sight.points.stamp_ns
        claims = without_seen(
            claims, np.concatenate([people.xy_m, depths.xy_m[depths.is_known]]), config
        )
        if seen_ns <= self._sustained_ns or not config.scan_sustains:
            return claims
        self._sustained_ns = seen_ns
        is_free = ~depths.claims(people.xy_m)
        if config.background_after_s > 0.0:
            self._background.observe(sight.bodies.slice, people, config.background_after_s)
            is_free &= ~self._background.holds(people.xy_m)
            self._background.free(people.xy_m[depths.claims(people.xy_m, hands.raised)])
        off_s = (stamp_ns - seen_ns) / 1e9
        of_bodies = body_measurements(sight.bodies, is_free, off_s, config)
        return Measurements.concatenate(claims, of_bodies)

    def spare(self, customers_xy_m: FloatArray, distance_m: float) -> None:
        """A customer who stands still does not become background."""
        self._background.spare(customers_xy_m, distance_m)
