"""The result of a frame, and the simulated truth."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Annotated

import numpy as np

from tracker.containers.arrays import BoolArray, FloatArray, IntArray, check_stamp, frozen
from tracker.containers.hands import Hands
from tracker.containers.located_scan import LocatedScan
from tracker.containers.measurements import Measurements
from tracker.containers.occupancy_grid import LocatedMap
from tracker.containers.rows import Column, Rows
from tracker.containers.tracks import Tracks
from tracker.containers.waiting_list import WaitingList
from tracker.errors import ShapeError
from tracker.notes import Note


@dataclass(frozen=True, slots=True, eq=False)
class Pose:
    """A place and a direction in a named frame.

    Attributes:
        stamp_ns: When it holds.
        frame_id: The frame of the numbers below.
        position_m: x, y, z.
        quaternion_xyzw: Rotation from the posed body to `frame_id`.
        covariance_m2: Shape (2, 2): of x and y, in square meters.
    """

    stamp_ns: int
    frame_id: str
    position_m: tuple[float, float, float]
    quaternion_xyzw: tuple[float, float, float, float]
    covariance_m2: FloatArray = field(default_factory=lambda: np.zeros((2, 2)))

    def __post_init__(self) -> None:
        check_stamp(self.stamp_ns)
        object.__setattr__(self, "covariance_m2", frozen(self.covariance_m2))
        if self.covariance_m2.shape != (2, 2):
            raise ShapeError(
                f"A pose's covariance has shape {self.covariance_m2.shape}; expected (2, 2)."
            )


@dataclass(frozen=True, eq=False)
class Truth(Rows):
    """Where simulated people really are; it never reaches the pipeline, only the evaluation.

    Attributes:
        stamp_ns: When it holds.
        id: Shape (P,), int64: the person's number in the scene.
        xy_m: Shape (P, 2): center of the body in the fixed frame.
        hand_up: Shape (P,), bool: a hand is up.
        in_view: Shape (P,), bool: that person's raised hand would fall into the camera's picture.
    """

    stamp_ns: int
    id: IntArray
    xy_m: Annotated[FloatArray, Column((2,))]
    hand_up: BoolArray
    in_view: BoolArray


@dataclass(frozen=True, slots=True)
class PerceptionWork:
    """What perception did for one image, and how long each stage took (wall-clock time).

    Attributes:
        places: Parts of the picture that were searched for palms.
        hands: Regions in which landmarks were read.
        search_s: Palm searches, and beside them the landmarks of followed hands.
        new_hands_s: Landmarks of what the search found.
        total_s: All of it.
        place_bar: How much more evidence the place asks for that shows the most false calls,
            log-odds; 0 where nothing was learned (`Config.place_prior`).
    """

    places: int = 0
    hands: int = 0
    search_s: float = 0.0
    new_hands_s: float = 0.0
    total_s: float = 0.0
    place_bar: float = 0.0


@dataclass(frozen=True, slots=True, eq=False)
class FrameResult:
    """The result of one processed image.

    Attributes:
        stamp_ns: The image's own stamp.
        hands: What perception found.
        measurements: What ranging made of it, in the fixed frame.
        tracks: The customers after this image.
        hand_raised: `/hand_raised`: some customer's hand is up.
        customer_pose: `/customer_pose`: the selected customer, facing the robot; None when nobody
            is selected or the estimate is not good enough to drive to.
        approach_pose: In front of that customer, facing the customer.
        sensor_pose: x_m, y_m, yaw_rad of the camera in the fixed frame; None without a transform.
        scan: The scan that was used, in the fixed frame, if any; without one, what a depth image
            shows at the height of bodies.
        notes: What was missing or odd about this image.
        frame_id: The frame that `tracks` are in: the fixed one; before the first transform the
            camera's. None where it is unknown, so that no place can be given: a transform is
            missing that was there before, or there was none and the camera's axes are optical.
        waiting_list: Who waits for service, after this image.
        room_map: The map that was used, in the fixed frame, if any.
        work: What perception did, where the detector tells; of all fields the only one that
            differs when the same recording is replayed.
    """

    stamp_ns: int
    hands: Hands
    measurements: Measurements
    tracks: Tracks
    hand_raised: bool
    customer_pose: Pose | None
    approach_pose: Pose | None
    sensor_pose: FloatArray | None
    scan: LocatedScan | None
    notes: tuple[Note, ...] = ()
    frame_id: str | None = None
    work: PerceptionWork | None = None
    waiting_list: WaitingList = field(default_factory=WaitingList)
    room_map: LocatedMap | None = None

    @property
    def is_on_floor(self) -> bool:
        """Whether z = 0 of `frame_id` is the floor: not in a frame that begins at the camera."""
        return self.sensor_pose is not None and bool(np.any(self.sensor_pose))
