"""What travels through the rooms: one typed, frozen container per concept.

Row i of every array of a batch is the same thing (the same hand, measurement, person). Arrays are
made read-only, stamps are integer nanoseconds, frames and units stand in the names.
"""

from __future__ import annotations

from dataclasses import dataclass, field, fields, replace
from enum import IntEnum
from typing import Any, TypeAlias, TypeVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from tracker.errors import ClockError, ShapeError

FloatArray: TypeAlias = NDArray[np.float64]
IntArray: TypeAlias = NDArray[np.int64]
BoolArray: TypeAlias = NDArray[np.bool_]
ImageArray: TypeAlias = NDArray[np.uint8]
_Batch = TypeVar("_Batch", "Hands", "Measurements", "Tracks")


@dataclass(frozen=True, slots=True, eq=False)
class CameraImage:
    """One picture of the camera.

    Attributes:
        stamp_ns: When it was taken.
        frame_id: The camera's frame; empty means the configured one.
        bgr: Shape (height, width, 3), uint8, blue-green-red.

    Raises:
        ShapeError: The array is no BGR picture, or has no pixels.
        ClockError: The stamp is negative.
    """

    stamp_ns: int
    frame_id: str
    bgr: ImageArray

    def __post_init__(self) -> None:
        check_stamp(self.stamp_ns)
        shape = self.bgr.shape
        if len(shape) != 3 or shape[2] != 3 or 0 in shape or self.bgr.dtype != np.uint8:
            raise ShapeError(
                f"An image has shape {shape} and type {self.bgr.dtype}; "
                "needed are (height, width, 3) with pixels in it and uint8."
            )

    @property
    def height(self) -> int:
        """Rows of pixels."""
        return int(self.bgr.shape[0])

    @property
    def width(self) -> int:
        """Columns of pixels."""
        return int(self.bgr.shape[1])


@dataclass(frozen=True, slots=True, eq=False)
class Scan:
    """One turn of a planar LiDAR.

    Attributes:
        stamp_ns: When the first beam was measured.
        frame_id: The laser's frame; empty means it coincides with the camera's body frame.
        angle_min_rad: Direction of beam 0, counter-clockwise from the frame's x axis.
        angle_increment_rad: From one beam to the next; negative for scanners that turn clockwise.
        range_min_m: Nearest range that counts.
        range_max_m: Farthest range that counts.
        ranges_m: Shape (B,); NaN, infinite and out-of-range values mean "no return".

    Raises:
        ShapeError: `ranges_m` is not one-dimensional, or the increment is zero or not finite.
        ClockError: The stamp is negative.
    """

    stamp_ns: int
    frame_id: str
    angle_min_rad: float
    angle_increment_rad: float
    range_min_m: float
    range_max_m: float
    ranges_m: FloatArray

    def __post_init__(self) -> None:
        check_stamp(self.stamp_ns)
        _freeze(self, "ranges_m", self.ranges_m, np.float64)
        if self.ranges_m.ndim != 1:
            raise ShapeError(f"Scan ranges have shape {self.ranges_m.shape}; needed is (B,).")
        if not np.isfinite(self.angle_min_rad):
            raise ShapeError(
                f"A scan starts at {self.angle_min_rad} rad; a finite angle is needed."
            )
        if len(self.ranges_m) and (
            self.angle_increment_rad == 0.0 or not np.isfinite(self.angle_increment_rad)
        ):
            raise ShapeError(
                f"A scan of {len(self.ranges_m)} beams has an angle increment of "
                f"{self.angle_increment_rad} rad; it must be finite and not zero."
            )

    @property
    def valid(self) -> BoolArray:
        """Shape (B,): beams with a return inside the scanner's limits."""
        ranges = self.ranges_m
        return np.isfinite(ranges) & (ranges >= self.range_min_m) & (ranges <= self.range_max_m)

    @property
    def angles_rad(self) -> FloatArray:
        """Shape (B,): direction of each beam in the laser's frame, not normalized."""
        beams = np.arange(len(self.ranges_m), dtype=np.float64)
        return self.angle_min_rad + self.angle_increment_rad * beams


@dataclass(frozen=True, slots=True, eq=False)
class Hands:
    """Every hand found in one image; row i of each array is the same hand.

    Attributes:
        landmarks_px: Shape (H, 21, 2): x to the right, y down, in pixels of the full image, in
            MediaPipe's order (0 wrist, 4 thumb tip, 9 middle finger's root, 12 its tip, 20 pinky
            tip).
        score: Shape (H,): the landmark model's word that this is a hand, in [0, 1].
        right: Shape (H,): probability of a right hand, in [0, 1].
        raised: Shape (H,), bool: the raise rule's verdict on this one image.
        raise_measure: Shape (H,): what the rule compared with its threshold (image heights for the
            `image` rule, palm lengths for the `palm` rule).
        torso_px: Shape (H, 2): the middle of shoulders and hips of whose hand it is; NaN where
            that is not known. None means that of no hand.
    """

    landmarks_px: FloatArray
    score: FloatArray
    right: FloatArray
    raised: BoolArray
    raise_measure: FloatArray
    torso_px: FloatArray = None  # type: ignore[assignment]  # NaN takes its place

    def __post_init__(self) -> None:
        if self.torso_px is None:
            object.__setattr__(self, "torso_px", np.full((len(self.landmarks_px), 2), np.nan))
        _freeze(self, "torso_px", self.torso_px, np.float64)
        _freeze(self, "landmarks_px", self.landmarks_px, np.float64)
        for name in ("score", "right", "raise_measure"):
            _freeze(self, name, getattr(self, name), np.float64)
        _freeze(self, "raised", self.raised, np.bool_)
        _check_rows(self, len(self.landmarks_px), landmarks_px=(21, 2), torso_px=(2,))

    def __len__(self) -> int:
        return len(self.score)

    def __getitem__(self, rows: Any) -> Hands:
        return _select(self, rows)

    @staticmethod
    def none() -> Hands:
        """No hand at all."""
        nothing = np.zeros(0)
        return Hands(np.zeros((0, 21, 2)), nothing, nothing, nothing.astype(bool), nothing)

    @staticmethod
    def concatenate(*parts: Hands) -> Hands:
        """Join batches of one image, rows in the order given."""
        return Hands(
            **{
                item.name: np.concatenate([getattr(part, item.name) for part in parts])
                for item in fields(Hands)
            }
        )

    @property
    def wrist_px(self) -> FloatArray:
        """Shape (H, 2)."""
        return self.landmarks_px[:, 0]

    @property
    def is_owned(self) -> BoolArray:
        """Shape (H,): the torso of whose hand it is is known."""
        return np.asarray(np.isfinite(self.torso_px).all(axis=-1))

    @property
    def length_px(self) -> FloatArray:
        """Shape (H,): from the wrist to the middle finger's tip."""
        along = self.landmarks_px[:, 12] - self.landmarks_px[:, 0]
        return np.hypot(along[:, 0], along[:, 1])


class MeasurementModel(IntEnum):
    """How a measurement's two numbers are read."""

    POLAR = 0
    CARTESIAN = 1


@dataclass(frozen=True, slots=True, eq=False)
class Measurements:
    """What the sensors claim about people at one instant; row i of each array is one claim.

    Attributes:
        values: Shape (M, 2). Polar: bearing_rad (counter-clockwise in the sensor's frame) and
            range_m, where a NaN range means "bearing only". Cartesian: x_m, y_m in the fixed
            frame.
        covariance: Shape (M, 2, 2), in the units of `values`.
        model: Shape (M,), `MeasurementModel`.
        sensor_pose: Shape (M, 3): x_m, y_m, yaw_rad of the sensor in the fixed frame.
        raised: Shape (M,), bool: a raised hand is behind it. Only such measurements create
            customers and feed the streaks; others (lowered hands, person clusters of the scan)
            sustain and refine customers that exist.
        person: Shape (M,), int64: claims that share a non-negative number come from the same body
            (the same scan segment); -1 where nobody knows.
        hand: Shape (M,), int64: row of the image's `Hands`, or -1.
        sensor_pose_covariance: Shape (M, 3, 3), of `sensor_pose`; None means zeros (well known).
        appearance: Shape (M, D): histograms of what the person looks like (the clothes), each
            adding up to 1; rows of NaN or zeros are unknown. None where nobody looked.
    """

    values: FloatArray
    covariance: FloatArray
    model: IntArray
    sensor_pose: FloatArray
    raised: BoolArray
    person: IntArray
    hand: IntArray
    sensor_pose_covariance: FloatArray = None  # type: ignore[assignment]  # zeros take its place
    appearance: FloatArray | None = None

    def __post_init__(self) -> None:
        if self.sensor_pose_covariance is None:
            zeros = np.zeros((len(self.values), 3, 3))
            object.__setattr__(self, "sensor_pose_covariance", zeros)
        for name in ("values", "covariance", "sensor_pose", "sensor_pose_covariance"):
            _freeze(self, name, getattr(self, name), np.float64)
        for name in ("model", "person", "hand"):
            _freeze(self, name, getattr(self, name), np.int64)
        _freeze(self, "raised", self.raised, np.bool_)
        tails = {"values": (2,), "covariance": (2, 2), "sensor_pose": (3,)}
        if self.appearance is not None:
            _freeze(self, "appearance", self.appearance, np.float64)
            tails["appearance"] = self.appearance.shape[1:2] or (0,)  # of any length
        _check_rows(self, len(self.values), **tails, sensor_pose_covariance=(3, 3))

    def __len__(self) -> int:
        return len(self.values)

    def __getitem__(self, rows: Any) -> Measurements:
        return _select(self, rows)

    @staticmethod
    def none() -> Measurements:
        """No measurement at all."""
        return Measurements.cartesian(np.zeros((0, 2)), np.zeros((0, 2, 2)))

    @staticmethod
    def polar(
        bearing_rad: ArrayLike,
        range_m: ArrayLike,
        bearing_std_rad: ArrayLike,
        range_std_m: ArrayLike,
        sensor_pose: ArrayLike = (0.0, 0.0, 0.0),
        *,
        raised: ArrayLike = True,
        person: ArrayLike = -1,
        hand: ArrayLike = -1,
        appearance: ArrayLike | None = None,
    ) -> Measurements:
        """Bearings and ranges seen from a sensor.

        Args:
            bearing_rad: Shape (M,), counter-clockwise from the sensor's x axis.
            range_m: Shape (M,) or one number; NaN where only the bearing is known.
            bearing_std_rad: Shape (M,) or one number.
            range_std_m: Shape (M,) or one number; ignored where the range is NaN.
            sensor_pose: x_m, y_m, yaw_rad of the sensor in the fixed frame, shape (3,) or (M, 3).
            raised: Shape (M,) or one truth value.
            person: Shape (M,) or one number; see the class.
            hand: Shape (M,) or one number; see the class.
            appearance: Shape (M, D), or None; see the class.

        Raises:
            ShapeError: The arrays disagree in length.
        """
        bearing = np.atleast_1d(np.asarray(bearing_rad, dtype=np.float64))
        count = len(bearing)
        range_ = _column("range_m", range_m, count)
        covariance = np.zeros((count, 2, 2))
        covariance[:, 0, 0] = _column("bearing_std_rad", bearing_std_rad, count) ** 2
        range_variance = _column("range_std_m", range_std_m, count) ** 2
        covariance[:, 1, 1] = np.where(np.isnan(range_), 1.0, range_variance)
        values = np.empty((count, 2))
        values[:, 0], values[:, 1] = bearing, range_
        return Measurements(
            values=values,
            covariance=covariance,
            model=_column("model", int(MeasurementModel.POLAR), count, np.int64),
            sensor_pose=_rows("sensor_pose", sensor_pose, (count, 3)),
            raised=_column("raised", raised, count, np.bool_),
            person=_column("person", person, count, np.int64),
            hand=_column("hand", hand, count, np.int64),
            appearance=None if appearance is None else np.asarray(appearance, np.float64),
        )

    @staticmethod
    def cartesian(
        xy_m: ArrayLike,
        covariance: ArrayLike,
        *,
        raised: ArrayLike = True,
        person: ArrayLike = -1,
        hand: ArrayLike = -1,
        appearance: ArrayLike | None = None,
    ) -> Measurements:
        """Positions in the fixed frame.

        Args:
            xy_m: Shape (M, 2).
            covariance: Shape (2, 2) or (M, 2, 2), in square meters.
            raised: Shape (M,) or one truth value.
            person: Shape (M,) or one number; see the class.
            hand: Shape (M,) or one number; see the class.
            appearance: Shape (M, D), or None; see the class.

        Raises:
            ShapeError: The arrays disagree in length.
        """
        xy = np.asarray(xy_m, dtype=np.float64)
        xy = xy[None, :] if xy.ndim == 1 else xy
        count = len(xy)
        return Measurements(
            values=xy,
            covariance=_rows("covariance", covariance, (count, 2, 2)),
            model=_column("model", int(MeasurementModel.CARTESIAN), count, np.int64),
            sensor_pose=np.zeros((count, 3)),
            raised=_column("raised", raised, count, np.bool_),
            person=_column("person", person, count, np.int64),
            hand=_column("hand", hand, count, np.int64),
            appearance=None if appearance is None else np.asarray(appearance, np.float64),
        )

    @staticmethod
    def concatenate(*parts: Measurements) -> Measurements:
        """Join batches of one instant, rows in the order given.

        Raises:
            ShapeError: Their histograms of appearance differ in length.
        """
        joined = {
            item.name: np.concatenate([getattr(part, item.name) for part in parts])
            for item in fields(Measurements)
            if item.name != "appearance"
        }
        return Measurements(**joined, appearance=_joined_appearance(parts))


@dataclass(frozen=True, slots=True, eq=False)
class Tracks:
    """Every customer at one instant; row i of each array is the same person.

    Attributes:
        stamp_ns: Sensor time the estimate is valid for.
        id: Shape (N,), int64, from 1; never reused by one tracker.
        mean: Shape (N, 4): x_m, y_m, vx_mps, vy_mps in the fixed frame.
        covariance: Shape (N, 4, 4), in the order and units of `mean`.
        existence: Shape (N,), probability that this person is really there.
        confirmed: Shape (N,), bool: seen often enough to be believed.
        raised: Shape (N,), bool: the streak says that this person's hand is up.
        raised_since_ns: Shape (N,): stamp at which `raised` last became true; -1 if it never did.
        age_s: Shape (N,): since the track began.
        unseen_s: Shape (N,): since a measurement last touched the position (freshness).
        hand: Shape (N,), int64: row of this image's `Hands` that belongs to the person, or -1.
        selected_id: The customer who is served, or None.
    """

    stamp_ns: int
    id: IntArray
    mean: FloatArray
    covariance: FloatArray
    existence: FloatArray
    confirmed: BoolArray
    raised: BoolArray
    raised_since_ns: IntArray
    age_s: FloatArray
    unseen_s: FloatArray
    hand: IntArray
    selected_id: int | None = None

    def __post_init__(self) -> None:
        for name in ("mean", "covariance", "existence", "age_s", "unseen_s"):
            _freeze(self, name, getattr(self, name), np.float64)
        for name in ("id", "raised_since_ns", "hand"):
            _freeze(self, name, getattr(self, name), np.int64)
        for name in ("confirmed", "raised"):
            _freeze(self, name, getattr(self, name), np.bool_)
        _check_rows(self, len(self.id), mean=(4,), covariance=(4, 4))

    def __len__(self) -> int:
        return len(self.id)

    def __getitem__(self, rows: Any) -> Tracks:
        return _select(self, rows)

    @staticmethod
    def none(stamp_ns: int) -> Tracks:
        """Nobody at all."""
        numbers, flags, counts = np.zeros(0), np.zeros(0, np.bool_), np.zeros(0, np.int64)
        return Tracks(
            stamp_ns=stamp_ns,
            id=counts,
            mean=np.zeros((0, 4)),
            covariance=np.zeros((0, 4, 4)),
            existence=numbers,
            confirmed=flags,
            raised=flags,
            raised_since_ns=counts,
            age_s=numbers,
            unseen_s=numbers,
            hand=counts,
        )

    def row_of(self, track_id: int | None) -> int | None:
        """Row of a person, or None where the tracker does not know them (any more)."""
        if track_id is None:
            return None
        found = np.flatnonzero(self.id == track_id)
        return int(found[0]) if len(found) else None


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
        _freeze(self, "covariance_m2", self.covariance_m2, np.float64)
        if self.covariance_m2.shape != (2, 2):
            raise ShapeError(
                f"A pose's covariance has shape {self.covariance_m2.shape}; needed is (2, 2)."
            )


@dataclass(frozen=True, slots=True, eq=False)
class Truth:
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
    xy_m: FloatArray
    hand_up: BoolArray
    in_view: BoolArray

    def __post_init__(self) -> None:
        _freeze(self, "id", self.id, np.int64)
        _freeze(self, "xy_m", self.xy_m, np.float64)
        for name in ("hand_up", "in_view"):
            _freeze(self, name, getattr(self, name), np.bool_)
        _check_rows(self, len(self.id), xy_m=(2,))

    def __len__(self) -> int:
        return len(self.id)


@dataclass(frozen=True, slots=True)
class PerceptionWork:
    """What perception did for one image, and how long each stage took on the wall.

    Attributes:
        places: Parts of the picture that were searched for palms.
        hands: Regions in which landmarks were read.
        search_s: Palm searches, and beside them the landmarks of followed hands.
        new_hands_s: Landmarks of what the search found.
        total_s: All of it.
    """

    places: int = 0
    hands: int = 0
    search_s: float = 0.0
    new_hands_s: float = 0.0
    total_s: float = 0.0


@dataclass(frozen=True, slots=True, eq=False)
class FrameResult:
    """Everything one processed image led to.

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
        scan: The scan that was used, if any.
        scan_pose: x_m, y_m, yaw_rad of that scan's laser in the fixed frame, if known.
        notes: What was missing or odd about this image, as short sentences ("no scan within
            0.2 s").
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
    scan: Scan | None
    scan_pose: FloatArray | None
    notes: tuple[str, ...] = ()
    work: PerceptionWork | None = None


def check_stamp(stamp_ns: int) -> None:
    """Refuse what is no stamp.

    Raises:
        ClockError: Negative, or not an integer.
    """
    if not isinstance(stamp_ns, (int, np.integer)) or stamp_ns < 0:
        raise ClockError(
            f"A stamp of {stamp_ns!r} ns came; stamps are integer nanoseconds from 0 on."
        )


def _freeze(batch: object, name: str, value: ArrayLike, dtype: type) -> None:
    view: NDArray[Any] = np.asarray(value, dtype=dtype).view()
    view.setflags(write=False)
    object.__setattr__(batch, name, view)


def _check_rows(batch: Any, count: int, **tails: tuple[int, ...]) -> None:
    for name in batch.__dataclass_fields__:
        array = getattr(batch, name)
        if isinstance(array, np.ndarray) and array.shape != (count, *tails.get(name, ())):
            shapes = ", ".join(f"{name} {array.shape}" for name, array in _arrays(batch).items())
            raise ShapeError(f"{type(batch).__name__} disagree in shape: {shapes}.")


def _joined_appearance(parts: tuple[Measurements, ...]) -> FloatArray | None:
    """Rows of NaN for parts without appearance."""
    lengths = {part.appearance.shape[1] for part in parts if part.appearance is not None}
    if not lengths:
        return None
    if len(lengths) > 1:
        raise ShapeError(
            f"Histograms of appearance have {sorted(lengths)} numbers; joined, all need as many."
        )
    unknown = np.full((1, *lengths), np.nan)
    return np.concatenate(
        [
            unknown.repeat(len(part), axis=0) if part.appearance is None else part.appearance
            for part in parts
        ]
    )


def _select(batch: _Batch, rows: Any) -> _Batch:
    if isinstance(rows, (int, np.integer)):
        rows = [rows]  # one row is a batch of one
    chosen = {name: array[rows] for name, array in _arrays(batch).items()}
    return replace(batch, **chosen)


def _arrays(batch: Any) -> dict[str, NDArray[Any]]:
    values = {name: getattr(batch, name) for name in batch.__dataclass_fields__}
    return {name: value for name, value in values.items() if isinstance(value, np.ndarray)}


def _column(name: str, value: ArrayLike, count: int, dtype: type = np.float64) -> NDArray[Any]:
    if isinstance(value, (bool, int, float)):
        column = np.empty(count, dtype)
        column.fill(value)
        return column
    return _rows(name, value, (count,)).astype(dtype, copy=False)


def _rows(name: str, value: ArrayLike, shape: tuple[int, ...]) -> FloatArray:
    array = np.asarray(value, dtype=np.float64)
    if array.shape == shape:
        return array
    rows = np.empty(shape)
    try:
        rows[:] = array
    except ValueError as error:
        raise ShapeError(f"`{name}` has shape {array.shape}; needed is {shape}.") from error
    return rows
