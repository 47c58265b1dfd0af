"""The whole way of one frame, used alike by replay, the nodes and the evaluation.

    image -> perception -> Hands -> ranging (+ scan, depth, transforms) -> Measurements -> tracking

Sensor data are pushed in as they come; images wait for the transform of their own stamp. Time is
the data's own: nothing here reads a clock.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from tracker.camera import CameraModel, DepthCamera
from tracker.config import Config
from tracker.containers import (
    CameraImage,
    DepthImage,
    FrameResult,
    LocatedScan,
    OccupancyGrid,
    Scan,
    Tracks,
    WaitingList,
)
from tracker.depth_sense import DepthSense, DepthSight
from tracker.geometry import RigidTransform
from tracker.gesture import Gesture
from tracker.locating import CameraLocator, CameraPlace, MapLocator, choose_scan, shown_ns
from tracker.locating.picture_camera import PictureCameras, configured_camera
from tracker.notes import Note, NoteKind
from tracker.perception.detector import HandDetector, Hints
from tracker.perception.gestures.customers import CustomerGestures
from tracker.perception.gestures.reading import GestureReader
from tracker.perception.upright import Turn, upright_turn
from tracker.ranging import (
    Memory,
    bearing_span_rad,
    expected_hands,
    measure_people,
    mend_scan,
    scan_people,
)
from tracker.service import Command, Verb, approach_pose, customer_pose
from tracker.tracking import PersonTracker, View
from tracker.tracking.trace import Watch
from tracker.transforms import StampedTransform, Transforms
from tracker.waiting import Verdict, WaitingImage, WaitingRoom

if TYPE_CHECKING:
    from tracker.messages import Event

#: A step of the stamps beyond this is another time; nobody is remembered for so long.
_FORGOTTEN_NS = 60_000_000_000


class Pipeline:
    """From sensor data to customers.

    Push data with `add_transform`, `add_scan`, `set_camera`, `set_map` and `add_image`, then take
    finished frames from `advance`. Or call `process` for one image at once.

    Args:
        config: Every parameter.
        detector: Finds hands; by default what `config.detector` names.
        transforms: Knows where frames were; by default a buffer of the project's own. A node may
            pass one around tf2's.
        watch: Passed on to the tracker.
        image_topic: Where images come from; tells whether they are rectified (`image_form`).

    Attributes:
        model_runs: How many model runs an image may take in perception; None is as configured.
    """

    def __init__(
        self,
        config: Config | None = None,
        detector: HandDetector | None = None,
        transforms: Transforms | None = None,
        *,
        watch: Watch | None = None,
        image_topic: str = "",
    ) -> None:
        self.config = config or Config()
        if detector is None:
            from tracker.perception import open_detector

            detector = open_detector(self.config)
        self.detector = detector
        self.model_runs: int | None = None
        self.tracker = PersonTracker(self.config, watch=watch)
        self.room = WaitingRoom(self.config.processing_rate, transforms)
        self.camera = configured_camera(self.config)
        self._cameras = PictureCameras(self.config, image_topic)
        self._sustained_ns = -1
        self._memory = Memory()
        self._depth = DepthSense()
        self._last_stamp_ns: int | None = None
        self._camera_locator = CameraLocator()
        self._map_locator = MapLocator()
        self._turn = Turn()
        self._gestures, self._customer_gestures = GestureReader(), CustomerGestures()
        self._size: tuple[int, int] | None = None
        self._notes: list[Note] = []
        self._scan_notes: tuple[Note, ...] = ()
        self._restored: WaitingList | None = None

    @property
    def transforms(self) -> Transforms:
        """Where frames were."""
        return self.room.transforms

    def add(self, event: Event, now_ns: int | None = None) -> Verdict | None:
        """Take in whatever comes: an image, a scan, a transform, intrinsics or a map.

        Args:
            event: What came; the truth of a simulation is left alone.
            now_ns: When it came, on the clock that `advance` is told.

        Returns:
            What becomes of it where it is an image.

        Raises:
            TransformError: As `add_transform`.
            ClockError: As `add_transform`.
        """
        if isinstance(event, CameraImage):
            return self.add_image(event, now_ns)
        if isinstance(event, Scan):
            self.add_scan(event)
        elif isinstance(event, DepthImage):
            self.room.add_depth(event)
        elif isinstance(event, DepthCamera):
            self._depth.calibrate(event.camera)
        elif isinstance(event, StampedTransform):
            self.add_transform(event)
        elif isinstance(event, CameraModel):
            self.set_camera(event)
        elif isinstance(event, OccupancyGrid):
            self.set_map(event)
        return None

    def add_transform(self, sample: StampedTransform) -> None:
        """Take in one transform.

        Raises:
            TransformError: It is unusable; see `TransformBuffer.add`.
            ClockError: Its stamp is negative, or far from the one before.
        """
        self.room.add_transform(sample)

    def add_scan(self, scan: Scan) -> None:
        """Take in one scan."""
        scan, self._scan_notes = mend_scan(scan)
        stamp_ns = shown_ns(scan.stamp_ns, self.config.scan_stamp_offset_s)
        self.room.add_scan(replace(scan, stamp_ns=stamp_ns))

    def set_camera(self, camera: CameraModel) -> None:
        """Take in calibrated intrinsics, unless `use_camera_info` is off."""
        if self.config.use_camera_info:
            self._cameras.calibrate(camera)

    def set_map(self, grid: OccupancyGrid) -> None:
        """Take in a map of the room, in place of the one before."""
        self._map_locator.set_map(grid)

    def add_image(self, image: CameraImage, now_ns: int | None = None) -> Verdict:
        """Queue an image, if its stamp makes sense and it is its turn at `processing_rate`.

        Args:
            image: The image.
            now_ns: When it came, on the clock that `advance` is told; by default its stamp.

        Returns:
            Whether it will be processed, and if not, why.
        """
        since_ns = image.stamp_ns if now_ns is None else now_ns
        return self.room.images.offer(
            WaitingImage(image.stamp_ns, image.frame_id, since_ns, lambda: image)
        )

    def advance(self, now_ns: int | None = None) -> Iterator[tuple[CameraImage, FrameResult]]:
        """Process the images whose turn has come, in order.

        Args:
            now_ns: Data time; None means that nothing more will come, so nobody waits any longer.
        """
        while waiting := self.room.images.next(lambda image: self.is_ready(image, now_ns)):
            image = waiting.open()
            yield image, self.process(image)

    def is_ready(self, image: WaitingImage, now_ns: int | None) -> bool:
        """Whether the transform of an image's stamp is there, or it has waited long enough.

        Args:
            image: The image.
            now_ns: On the clock of `image.since_ns`; None means that nothing more will come.
        """
        if now_ns is None or abs(now_ns - image.since_ns) >= _ns(self.config.transform_wait_s):
            return True
        frame = self.config.camera_frame or image.frame_id
        stamp_ns = shown_ns(image.stamp_ns, self.config.camera_stamp_offset_s)
        return self.transforms.can_lookup(self.config.fixed_frame, frame, stamp_ns)

    def process(self, image: CameraImage) -> FrameResult:
        """Process one frame.

        Returns:
            What came of it. Missing transforms and scans are no errors: they are noted, hands are
            still reported, and no pose is given that is not known.
        """
        self._notes = list(self._scan_notes)
        self._follow_clock(image.stamp_ns)

        self.camera, camera_notes = self._cameras.of(image.width, image.height)
        self._notes += camera_notes
        size = (image.width, image.height)
        if self._size not in (None, size):
            self._note(
                NoteKind.PICTURE_SIZE_CHANGED,
                f"pictures of {image.width}x{image.height} follow pictures of another size: "
                "hands cannot be followed from one size to another",
            )
        self._size = size
        if image.remark:
            self._note(NoteKind.BIT_DEPTH_GUESSED, image.remark)
        stamp_ns = shown_ns(image.stamp_ns, self.config.camera_stamp_offset_s)
        place = self._locate_camera(image, stamp_ns)
        if self._restored is not None and place.is_located:
            self._restore_calls(image.stamp_ns)
        fixed_from_camera = place.fixed_from_camera
        sight, depth_notes = self._depth.look(
            self.room, stamp_ns, image.frame_id, place, self.camera, self.config
        )
        self._notes += depth_notes
        scan = self._choose_scan(stamp_ns, place, has_depth=sight is not None)
        room, map_notes = self._map_locator.locate(
            self.transforms, image.stamp_ns, place, self.config
        )
        self._notes += map_notes
        people = scan_people(scan, self.config, room)
        self._turn_upright(fixed_from_camera)
        hints = Hints(model_runs=self.model_runs)
        if place.is_located:
            seen = [people.xy_m] if sight is None else [people.xy_m, sight.bodies.people.xy_m]
            known_xy_m = np.concatenate([self.tracker.positions_m, *seen])
            expected_px = expected_hands(known_xy_m, self.camera, fixed_from_camera)
            hints = replace(hints, expected_px=self._turn.boxes(expected_px, size))
        upright_hands = self.detector.find(self._turn.picture(image), hints)
        upright_hands = self._gestures.read(image.stamp_ns, upright_hands, self.config)
        hands = self._turn.hands_back(upright_hands, size)
        tracked = self.tracker.people
        owned, depths = self._depth.ask(sight, hands, self.camera, fixed_from_camera, self.config)
        measurements = measure_people(
            owned,
            self.camera,
            fixed_from_camera,
            scan,
            self.config,
            sustain=scan is not None and scan.stamp_ns > self._sustained_ns,
            people=people,
            motion=place.motion,
            memory=self._memory,
            tracked=tracked,
            stamp_ns=image.stamp_ns,
            depths=depths,
        )
        beyond = len(hands) - np.count_nonzero(measurements.hand >= 0)
        if beyond:
            end_deg = np.rad2deg(self.camera.lens.max_off_axis_rad)
            text = f"{beyond} hands outside the lens's {end_deg:.0f} degrees: no bearing"
            self._note(NoteKind.HAND_BEYOND_LENS, text)
        if scan is not None:
            self._sustained_ns = max(self._sustained_ns, scan.stamp_ns)
        if sight is not None and depths is not None:
            measurements = self._depth.complete(
                measurements, sight, hands, depths, image.stamp_ns, self.config
            )
            self._memory.background.free(people.xy_m[depths.claims(people.xy_m, hands.raised)])
        robot_xy_m = fixed_from_camera.planar[:2]
        tracks = self.tracker.step(
            image.stamp_ns,
            measurements,
            robot_xy_m,
            view=self._camera_view(image, fixed_from_camera),
            scan_view=self._scan_view(scan, sight),
            likeness=self._memory.ownership.likeness(
                measurements, len(tracked), None if depths is None else depths.is_known
            ),
        )
        tracks = self._let_go(self._customer_gestures.add_to(tracks, hands))
        self._memory.postures.learn(tracks, hands)
        customers_xy_m = tracks.mean[tracks.confirmed, :2]
        self._memory.background.spare(customers_xy_m, self.config.same_person_distance_m)
        self._depth.spare(customers_xy_m, self.config.same_person_distance_m)
        pose = approach = None
        if place.is_located:
            pose = customer_pose(tracks, robot_xy_m, self.config.fixed_frame, self.config)
        if pose is not None:
            approach = approach_pose(pose, robot_xy_m, self.config.approach_distance_m)
        return FrameResult(
            stamp_ns=image.stamp_ns,
            hands=hands,
            measurements=measurements,
            tracks=tracks,
            hand_raised=bool(tracks.raised.any()),
            customer_pose=pose,
            approach_pose=approach,
            sensor_pose=fixed_from_camera.planar if place.is_located else None,
            scan=scan if scan is not None or sight is None else sight.bodies.slice,
            notes=tuple(self._notes),
            frame_id=place.frame_id,
            work=self.detector.work,
            waiting_list=self.tracker.calls.now,
            room_map=None if room is None else room.located,
        )

    def configure(self, config: Config) -> None:
        """Change parameters while running; tracks stay.

        Only parameters that are `live` take effect (`tracker.config.parameter_extra`).

        Raises:
            ModelFileError: Other models are needed and cannot be opened; nothing has changed then.
        """
        self.detector.configure(config)
        self.room.images.set_rate(config.processing_rate)
        self._cameras.configure(config)
        self.config = self.tracker.config = config

    def restore(self, kept: WaitingList) -> None:
        """Go on with a waiting list of another run, as soon as the camera is located.

        Args:
            kept: With places in `fixed_frame`.
        """
        self._restored = kept

    def reset(self) -> None:
        """Forget people, furniture that was learnt, scans, moving transforms, waiting images."""
        self._forget()
        self.room.reset()
        self._last_stamp_ns = None

    def _forget(self) -> None:
        self.tracker.reset()
        self._memory.reset()
        self._depth.reset()
        self.detector.reset()
        self._gestures.reset()
        self._customer_gestures.reset()
        self._camera_locator.reset()
        self._sustained_ns = -1
        self._scan_notes = ()

    def _note(self, kind: NoteKind, text: str) -> None:
        self._notes.append(Note(kind, text))

    def _follow_clock(self, stamp_ns: int) -> None:
        """Forget everybody where the stamps step back, or so far ahead that nobody stays known.

        The gate lets no single odd stamp through: a step that gets here lasts.
        """
        last_ns, self._last_stamp_ns = self._last_stamp_ns, stamp_ns
        if last_ns is None or 0 <= stamp_ns - last_ns <= _FORGOTTEN_NS:
            return
        step_s, way = abs(stamp_ns - last_ns) / 1e9, "back" if stamp_ns < last_ns else "ahead"
        self._note(
            NoteKind.CLOCK_JUMPED, f"stamps jumped {way} by {step_s:.3f} s: tracks were reset"
        )
        calls = self.tracker.calls.now
        self._forget()
        if stamp_ns > last_ns:
            self.tracker.restore(calls)
        self.room.forget_scans_after(stamp_ns)

    def _locate_camera(self, image: CameraImage, stamp_ns: int) -> CameraPlace:
        """Where the camera is; tracks follow when the fixed frame is another, or was lost."""
        place = self._camera_locator.locate(self.transforms, stamp_ns, image.frame_id, self.config)
        if place.missing:
            self._note(NoteKind.NO_POSE, f"no pose: {place.missing}")
        if place.is_first and self.tracker.has_tracks:
            self._note(
                NoteKind.NEW_FIXED_FRAME,
                "the first transform was received: tracking starts again in the fixed frame",
            )
            self.tracker.reset()
            self._memory.background.reset()
            self._depth.reset()
        if place.moved is not None:
            self.tracker.doubt(place.moved, place.unseen_s)
        return place

    def _restore_calls(self, stamp_ns: int) -> None:
        kept, self._restored = self._restored, None
        if kept is not None and kept.stamp_ns <= stamp_ns:
            self.tracker.restore(kept)
        elif kept is not None:
            ahead_s = (kept.stamp_ns - stamp_ns) / 1e9
            self._note(
                NoteKind.CALLS_OF_LATER,
                f"the stored waiting list is {ahead_s:.1f} s later than the images: it starts "
                "empty",
            )

    def _choose_scan(
        self, stamp_ns: int, place: CameraPlace, *, has_depth: bool
    ) -> LocatedScan | None:
        """The scan for an instant, where scans are wanted."""
        if self.config.depth_source == "depth":
            return None
        waiting = self.room.scans_by_age(stamp_ns)
        if has_depth and not waiting:
            return None
        scan, notes = choose_scan(waiting, self.transforms, stamp_ns, place, self.config)
        self._notes += notes
        return scan

    def _turn_upright(self, fixed_from_camera: RigidTransform) -> None:
        """The detector sees pictures in which up is up; it begins again where the turn changes."""
        turn = upright_turn(fixed_from_camera, self._turn)
        if turn != self._turn:
            self.detector.reset()
            self._gestures.reset()
        self._turn = turn

    def _let_go(self, tracks: Tracks) -> Tracks:
        """End the service of a customer who shows `gesture_release`."""
        row = tracks.row_of(tracks.selected_id)
        gesture = Gesture.NONE if row is None else Gesture(int(tracks.gesture[row]))
        if gesture is Gesture.NONE or gesture.word != self.config.gesture_release:
            return tracks
        self.tracker.calls.obey(Command(Verb.RELEASE))
        return replace(tracks, selected_id=None)

    def _camera_view(self, image: CameraImage, fixed_from_camera: RigidTransform) -> View:
        """Where hands could be seen."""
        size = (image.width, image.height)
        right_rad, left_rad = bearing_span_rad(self.camera, size, fixed_from_camera)
        if self.config.bearing_convention == "spec":
            right_rad, left_rad = -left_rad, -right_rad
        return View.between(
            fixed_from_camera.planar, right_rad, left_rad, self.config.person_range_max_m
        )

    def _scan_view(self, scan: LocatedScan | None, sight: DepthSight | None) -> View | None:
        """Where the scan could show people, or else the depth image; None where none is asked.

        Where there are both, what the depth image shows the camera sees as well.
        """
        if not self.config.scan_sustains:
            return None
        if scan is None:
            return None if sight is None else sight.view(self.config.person_range_max_m)
        range_max_m = min(scan.range_max_m, self.config.person_range_max_m)
        return View.between(np.append(scan.laser_xy_m, 0.0), *scan.span_rad, range_max_m)


def _ns(value_s: float) -> int:
    return round(value_s * 1e9)
