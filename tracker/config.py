"""Which numbers decide? Every parameter once: name, type, default, unit, range, meaning.

The YAML file, the ROS parameters, the command line and the tables of the documentation all come
from this one model. The first group is the specification's table 1, by its own names and defaults.
"""

from __future__ import annotations

import warnings
from collections.abc import Callable
from dataclasses import asdict, dataclass
from functools import partial
from pathlib import Path
from typing import Any, Literal

from pydantic import BaseModel, ConfigDict, Field, ValidationError, model_validator

from tracker.errors import ConfigError
from tracker.gesture import Gesture, gestures_named
from tracker.parameters.retired import (
    LATELY_RETIRED,
    RETIRED,
    without_lately_retired,
    without_retired,
)
from tracker.parameters.ros_file import NODE_NAME as NODE_NAME  # where it is looked for
from tracker.parameters.ros_file import is_ours, read_parameters
from tracker.wording import shown

#: Python's own warning, at the line that called `Config.from_yaml`.
_WARN = partial(warnings.warn, stacklevel=3)


@dataclass(frozen=True, slots=True)
class Search:
    """Where `raised-hand tune` looks for a parameter; choices are tried one and all.

    Attributes:
        kind: What it is about: process or measurement noise, clutter, life (of tracks), method.
        low: From, of a number ...
        high: ... and to.
        log: Steps are factors.
    """

    kind: Literal["process", "measurement", "clutter", "life", "method"]
    low: float = 0.0
    high: float = 0.0
    log: bool = False


def _parameter(
    default: Any,
    description: str,
    *,
    unit: str = "",
    group: str,
    level: Literal["basic", "expert"] = "expert",
    live: bool = False,
    search: Search | None = None,
    **bounds: Any,
) -> Any:
    """A field with its unit, its group in the documentation, its level, and whether it is live.

    Basic are those that a new robot or another room may need; the defaults of the others mostly
    stay. Live ones may change while the node runs.
    """
    extra: dict[str, Any] = {"unit": unit, "group": group, "level": level, "live": live}
    extra["search"] = None if search is None else asdict(search)
    return Field(default, description=description, json_schema_extra=extra, **bounds)


class Config(BaseModel):
    """Every parameter of the tracker; see `Config.from_yaml` for files."""

    model_config = ConfigDict(
        extra="forbid",
        frozen=True,
        strict=True,
        allow_inf_nan=False,
        protected_namespaces=(),  # `model_complexity` is the specification's word
    )

    # The specification's table 1.
    processing_rate: float = _parameter(
        10.0, "Images processed per second, on average; the others are passed over.",
        level="basic",
        unit="Hz", group="specification", live=True, gt=0.0, le=240.0,
    )  # fmt: skip
    downscale_factor: int = _parameter(
        2, "The whole-frame search and the debug image work on the picture shrunk by this factor.",
        level="basic",
        group="specification", live=True, ge=1, le=16,
    )  # fmt: skip
    hand_raised_threshold: float = _parameter(
        0.25, "`raise_rule: image`: how far the middle finger's tip must be above the wrist.",
        level="basic",
        unit="image heights", group="specification", live=True, ge=0.0, le=1.0,
    )  # fmt: skip
    detection_confidence: float = _parameter(
        0.6, "Score from which the palm search believes in a hand.",
        level="basic",
        group="specification", live=True, gt=0.0, lt=1.0,
    )  # fmt: skip
    tracking_confidence: float = _parameter(
        0.5, "Landmark score from which a hand is followed into the next image.",
        level="basic",
        group="specification", live=True, gt=0.0, lt=1.0,
    )  # fmt: skip
    model_complexity: int = _parameter(
        0, "Hand models: 0 lite (faster), 1 full (more accurate).",
        level="basic",
        group="specification", ge=0, le=1,
    )  # fmt: skip
    camera_fx: float = _parameter(
        460.0, "Focal length along the columns of the full image, until a CameraInfo comes.",
        level="basic",
        unit="px", group="specification", live=True, gt=0.0, le=1e5,
    )  # fmt: skip
    camera_fy: float = _parameter(
        460.0, "Focal length along the rows of the full image, until a CameraInfo comes.",
        level="basic",
        unit="px", group="specification", live=True, gt=0.0, le=1e5,
    )  # fmt: skip
    camera_cx: float = _parameter(
        320.0, "Column of the principal point of the full image, until a CameraInfo comes.",
        level="basic",
        unit="px", group="specification", live=True, ge=-1e5, le=1e5,
    )  # fmt: skip
    camera_cy: float = _parameter(
        240.0, "Row of the principal point of the full image, until a CameraInfo comes.",
        level="basic",
        unit="px", group="specification", live=True, ge=-1e5, le=1e5,
    )  # fmt: skip

    # Frames and camera.
    camera_width: int = _parameter(
        0, "Columns of the pictures that `camera_fx` to `camera_cy` belong to. They are scaled to "
        "pictures of another size. 0: the specification's 640x480, or the picture's own size "
        "where the principal point lies nearer to its middle.",
        unit="px", group="frames", ge=0, le=100_000,
    )  # fmt: skip
    camera_height: int = _parameter(
        0, "Rows of the pictures that `camera_fx` to `camera_cy` belong to; as `camera_width`.",
        unit="px", group="frames", ge=0, le=100_000,
    )  # fmt: skip
    picture_max_pixels: int = _parameter(
        50_000_000, "A picture with more pixels is passed over before it is decoded, and counted: "
        "a small file can claim a size that fills the memory.",
        unit="px", group="frames", ge=1, le=1_000_000_000,
    )  # fmt: skip
    fixed_frame: str = _parameter(
        "map", "Frame in which customers are tracked and poses are given.",
        level="basic",
        group="frames",
    )  # fmt: skip
    camera_frame: str = _parameter(
        "camera_link", "The camera's frame; the image's own frame_id is used where this is empty.",
        level="basic",
        group="frames",
    )  # fmt: skip
    camera_axes: Literal["auto", "body", "optical"] = _parameter(
        "auto", "Axes of the camera's frame: body (x forward, z up), optical (z forward, y down), "
        "or auto (optical if its name holds `optical`).",
        level="basic",
        group="frames",
    )  # fmt: skip
    camera_roll_deg: float = _parameter(
        0.0, "How far the camera is rolled, clockwise as seen from behind it, beyond what its "
        "transform says; hands are searched in upright pictures. For cameras without a transform, "
        "or one that does not tell of their mounting.",
        level="basic",
        unit="deg", group="frames", live=True, ge=-180.0, le=180.0,
    )  # fmt: skip
    use_camera_info: bool = _parameter(
        True, "Take intrinsics and distortion from CameraInfo when it comes.",
        level="basic",
        group="frames",
    )  # fmt: skip
    image_form: Literal["auto", "raw", "rectified"] = _parameter(
        "auto", "Images as the lens shows them (raw: of a CameraInfo K holds, with the "
        "distortion), without its distortion (rectified: P holds), or auto (rectified if their "
        "topic is named so, as image_rect).",
        group="frames",
    )  # fmt: skip
    bearing_convention: Literal["rep103", "spec"] = _parameter(
        "rep103", "Sign of the bearing: rep103 (left is positive) or spec (the original's, right "
        "is positive, for robots whose frames were built around it).",
        group="frames",
    )  # fmt: skip
    transform_wait_s: float = _parameter(
        0.3, "How long an image may wait for the transform at its own stamp.",
        level="basic",
        unit="s", group="frames", live=True, ge=0.0, le=5.0,
    )  # fmt: skip

    camera_stamp_offset_s: float = _parameter(
        0.0, "How late the camera's stamps are: what a picture shows happened so long before its "
        "stamp. Negative where the stamps are early. The camera is looked up at the time that is "
        "shown; notebook 03 estimates it.",
        unit="s", group="frames", live=True, ge=-1.0, le=1.0,
    )  # fmt: skip
    scan_stamp_offset_s: float = _parameter(
        0.0, "How late the laser's stamps are, as `camera_stamp_offset_s`.",
        unit="s", group="frames", live=True, ge=-1.0, le=1.0,
    )  # fmt: skip
    stamp_std_s: float = _parameter(
        0.02, "How well both offsets of the stamps are known, as standard deviation (guess). "
        "While the robot turns or drives it is part of the sensors' pose and of the published "
        "covariance.",
        unit="s", group="frames", live=True, ge=0.0, le=1.0,
    )  # fmt: skip

    # Perception.
    raise_rule: Literal["evidence", "palm", "image"] = _parameter(
        "evidence", "When is a hand up? evidence: hand, arm, body and movement are weighed, at "
        "any distance; a palm, fist, finger or wave may call. palm: an open hand, in palm "
        "lengths; image: the specification's shares of the image, up to 0.7 m.",
        level="basic",
        group="perception", live=True,
    )  # fmt: skip
    palm_raised_threshold: float = _parameter(
        1.1, "`raise_rule: palm`: how far the middle finger's tip must be above the wrist.",
        unit="palm lengths", group="perception", live=True, ge=0.0, le=3.0,
    )  # fmt: skip
    small_hand_px: float = _parameter(
        32.0, "A hand shorter than this (at 2.6 m, with the default camera) is small: see "
        "`piece_confidence`.",
        unit="px", group="perception", live=True, ge=0.0, le=10000.0,
    )  # fmt: skip
    raised_lean_max_deg: float = _parameter(
        35.0, "`raise_rule: palm`: a hand that leans farther to a side is not up.",
        unit="deg", group="perception", live=True, gt=0.0, le=90.0,
    )  # fmt: skip
    hand_span_threshold: float = _parameter(
        0.15, "`raise_rule: image`: how far thumb and little finger must be apart.",
        unit="image widths", group="perception", live=True, ge=0.0, le=1.0,
    )  # fmt: skip
    search_regions_per_frame: int = _parameter(
        3, "Places of the picture (the whole, tiles, windows around people) that are searched for "
        "new hands in each image.",
        level="basic",
        group="perception", live=True, ge=1, le=64,
    )  # fmt: skip
    piece_confidence: float = _parameter(
        0.35, "Score from which the search of a piece of the picture believes in a hand shorter "
        "than `small_hand_px`: such palms score low, and the landmark model sorts them out.",
        level="basic",
        group="perception", live=True, gt=0.0, lt=1.0,
    )  # fmt: skip
    search_lean_max_deg: float = _parameter(
        75.0, "Hands that lean farther to a side are neither read nor followed; 180 follows "
        "lowered hands as well. `raise_rule: image` follows all, and so does a `gesture_release` "
        "by the thumb.",
        unit="deg", group="perception", live=True, gt=0.0, le=180.0,
    )  # fmt: skip
    place_prior: bool = _parameter(
        True, "`raise_rule: evidence`: learn where something calls that never moves, such as a "
        "poster of a raised hand; more evidence is asked for there.",
        group="perception", live=True,
    )  # fmt: skip
    max_hands: int = _parameter(
        8, "Hands followed at a time; the search rests while so many are followed.",
        level="basic",
        group="perception", live=True, ge=1, le=64,
    )  # fmt: skip
    inference_threads: int = _parameter(
        2, "Processor threads for the models.",
        level="basic",
        group="perception", ge=1, le=32,
    )  # fmt: skip
    execution_provider: Literal["cpu", "cuda", "tensorrt", "openvino", "coreml", "auto"] = (
        _parameter(
            "cpu", "Where ONNX Runtime runs the models; anything but cpu needs the build of "
            "onnxruntime that has it. auto: the first of cuda, coreml, openvino and cpu that is "
            "there.",
            level="basic",
            group="perception",
        )
    )  # fmt: skip

    # What finds hands, and the second opinion of body poses.
    detector: Literal["hands", "pose", "mediapipe"] = _parameter(
        "hands", "What finds raised hands: hands (MediaPipe's hand models on ONNX Runtime), pose "
        "(the arms of body poses) or mediapipe (an installed mediapipe 0.10, as it is).",
        level="basic",
        group="pose",
    )  # fmt: skip
    pose_model: str = _parameter(
        "", "ONNX file of a pose model of your own (RTMO, RTMPose, MoveNet MultiPose or "
        "YOLO-pose); empty takes MediaPipe's.",
        group="pose",
    )  # fmt: skip
    pose_opinion: Literal["evidence", "none"] = _parameter(
        "evidence", "`detector: hands`, `raise_rule: evidence`: what body poses say about the "
        "hands. evidence: the owners of hands are looked for, and arms that are up where no hand "
        "was found; none: hands are judged alone.",
        level="basic",
        group="pose",
    )  # fmt: skip
    pose_confidence: float = _parameter(
        0.5, "Score from which a pose model believes in a person.",
        group="pose", live=True, gt=0.0, lt=1.0,
    )  # fmt: skip
    pose_raised_threshold: float = _parameter(
        0.25, "`detector: pose`: how far a wrist must be above its shoulder.",
        unit="shoulder widths", group="pose", live=True, ge=0.0, le=3.0,
    )  # fmt: skip
    pose_head_clearance: float = _parameter(
        0.6, "`detector: pose`: a wrist nearer than this to nose, eyes or ears is not up, but at "
        "the head.",
        unit="shoulder widths", group="pose", live=True, ge=0.0, le=3.0,
    )  # fmt: skip

    # What hands say.
    gesture_call: str = _parameter(
        "all", "Which gestures call: all, or some of palm, fist, point, victory, thumb_up, "
        "thumb_down, wave, stop and come with commas between, such as palm, fist, point, wave. A "
        "raised hand that surely says something else is not raised then; one whose gesture is "
        "not sure may call.",
        level="basic",
        group="gestures", live=True,
    )  # fmt: skip
    gesture_release: Literal[
        "none", "palm", "fist", "point", "victory", "thumb_up", "thumb_down", "wave", "stop",
        "come",
    ] = _parameter(
        "none", "The customer who is served is let go who shows this gesture, as by "
        "~/release_customer. With thumb_up or thumb_down hands are read however far they lean "
        "(see `search_lean_max_deg`); `selection_hold_s` says how long a lowered hand may take "
        "to show it.",
        group="gestures", live=True,
    )  # fmt: skip

    # Ranging.
    ranging: Literal["person", "spec"] = _parameter(
        "person", "How far is the hand? person: as far as its owner, whom its ray and size tell "
        "among all people; spec: the median of the beams at the ray (algorithm 5).",
        group="ranging", live=True,
    )  # fmt: skip
    depth_source: Literal["both", "scan", "depth"] = _parameter(
        "both", "What tells how far people are: scan (the LiDAR), depth (a depth camera) or both, "
        "as far as they come. Without depth images both is the same as scan.",
        level="basic",
        group="ranging", live=True,
    )  # fmt: skip
    depth_std_m: float = _parameter(
        0.005, "Range noise of the depth camera at 1 m; it grows with the square of the range.",
        unit="m", group="ranging", live=True, ge=0.0, le=1.0,
    )  # fmt: skip
    depth_height_min_m: float = _parameter(
        0.85, "Bodies are looked for in the depth image above this height over the floor, which "
        "leaves out tables and chairs. A camera below it that does not look up wants less.",
        unit="m", group="ranging", live=True, ge=0.05, le=1.9,
    )  # fmt: skip
    scan_window_beams: int = _parameter(
        3, "Beams to each side of the ray whose median counts (algorithm 5).",
        unit="beams", group="ranging", live=True, ge=0, le=90,
    )  # fmt: skip
    scan_max_age_s: float = _parameter(
        0.25, "A scan farther than this from the image's stamp is too old for it.",
        level="basic",
        unit="s", group="ranging", live=True, gt=0.0, le=10.0,
    )  # fmt: skip
    leg_width_min_m: float = _parameter(
        0.02, "Person-sized: no segment of the scan thinner than this is a leg. Legs in trousers "
        "are .1 m wide and more; .075 leaves out most legs of chairs and tables, and bare ankles.",
        level="basic",
        unit="m", group="ranging", live=True, ge=0.0, le=0.3,
    )  # fmt: skip
    body_width_m: float = _parameter(
        0.8, "Person-sized: no segment of the scan wider than this is a person.",
        unit="m", group="ranging", live=True, gt=0.1, le=2.0,
    )  # fmt: skip
    arm_reach_m: float = _parameter(
        0.6, "The person whose hand is up stands no farther than this to a side of its ray.",
        unit="m", group="ranging", live=True, gt=0.0, le=2.0,
    )  # fmt: skip
    segment_jump_m: float = _parameter(
        0.15, "Neighboring beams whose points are farther apart belong to different segments.",
        unit="m", group="ranging", live=True, gt=0.0, le=2.0,
    )  # fmt: skip
    person_range_max_m: float = _parameter(
        8.0, "Nobody farther than this is ranged.",
        level="basic",
        unit="m", group="ranging", live=True, gt=0.5, le=100.0,
    )  # fmt: skip
    scan_sustains: bool = _parameter(
        True, "Person-sized segments keep customers alive and in place while their hand is down.",
        group="ranging", live=True,
    )  # fmt: skip
    background_after_s: float = _parameter(
        30.0, "What has stood exactly still in the scan for so long, and is no customer, is "
        "furniture and sustains nobody, until the place is seen free; 0 learns no furniture.",
        unit="s", group="ranging", live=True, ge=0.0, le=3600.0,
    )  # fmt: skip
    use_map: bool = _parameter(
        True, "Where a map (nav_msgs/OccupancyGrid) says that something stands, what is "
        "person-sized in the scan is taken for furniture.",
        level="basic",
        group="ranging", live=True,
    )  # fmt: skip
    range_std_m: float = _parameter(
        0.08, "Range noise of a person in the scan: the scanner's own, and legs are no point.",
        unit="m", group="ranging", live=True, ge=0.001, le=2.0,
        search=Search("measurement", 0.02, 0.6, log=True),
    )  # fmt: skip
    hand_offset_std_m: float = _parameter(
        0.2, "How far a raised hand stands beside the body, as standard deviation.",
        unit="m", group="ranging", live=True, ge=0.0, le=1.0,
        search=Search("measurement", 0.05, 0.5, log=True),
    )  # fmt: skip
    torso_offset_std_m: float = _parameter(
        0.08, "How far a person's legs stand from the middle of shoulders and hips, as standard "
        "deviation per axis. It lasts: it is part of the published covariance, and of the bearing "
        "of a hand whose owner's torso is seen.",
        unit="m", group="ranging", live=True, ge=0.0, le=1.0,
    )  # fmt: skip
    mounting_std_deg: float = _parameter(
        0.5, "How well the yaw of camera and laser on the robot is known, as standard deviation "
        "(guess). It is part of the published covariance.",
        unit="deg", group="ranging", live=True, ge=0.0, le=10.0,
    )  # fmt: skip
    wrist_std_px: float = _parameter(
        1.0, "Error of the wrist's column in the full image, for the smallest hand; it stays as "
        "long as the hand is followed, and some noise is added to it ...",
        unit="px", group="ranging", live=True, gt=0.0, le=100.0,
    )  # fmt: skip
    wrist_std_share: float = _parameter(
        0.02, "... and how it grows with the hand's length.",
        unit="hand lengths", group="ranging", live=True, ge=0.0, le=1.0,
    )  # fmt: skip
    unknown_range_m: float = _parameter(
        2.5, "Where the scan gives nothing, a new customer is supposed at this range ...",
        unit="m", group="ranging", live=True, gt=0.1, le=20.0,
    )  # fmt: skip
    unknown_range_std_m: float = _parameter(
        1.5, "... with this standard deviation.",
        unit="m", group="ranging", live=True, gt=0.1, le=20.0,
    )  # fmt: skip

    # Tracking.
    motion: Literal["imm", "cv"] = _parameter(
        "imm", "How people move: imm (they stand or walk, and change over) or cv (nearly constant "
        "velocity).",
        group="tracking", live=True,
        search=Search("method"),
    )  # fmt: skip
    association: Literal["pda", "hungarian", "jpda"] = _parameter(
        "pda", "Whose measurement is it? pda: the most likely one-to-one assignment decides, and "
        "the probability of the pair says how much it counts; hungarian: what is assigned counts "
        "in full; jpda: every measurement in the gate counts by its probability.",
        group="tracking", live=True,
        search=Search("method"),
    )  # fmt: skip
    acceleration_density: float = _parameter(
        0.6, "Process noise: power spectral density of the acceleration of people who walk.",
        unit="m^2/s^3", group="tracking", live=True, gt=0.0, le=100.0,
        search=Search("process", 0.05, 10.0, log=True),
    )  # fmt: skip
    stand_speed_std_mps: float = _parameter(
        0.1, "`motion: imm`: how fast people sway who stand, per axis.",
        unit="m/s", group="tracking", live=True, gt=0.0, le=2.0,
        search=Search("process", 0.02, 0.5, log=True),
    )  # fmt: skip
    stand_duration_s: float = _parameter(
        3.0, "`motion: imm`: how long people stand, on average ...",
        unit="s", group="tracking", live=True, gt=0.1, le=3600.0,
        search=Search("process", 0.5, 30.0, log=True),
    )  # fmt: skip
    walk_duration_s: float = _parameter(
        5.0, "... and how long they walk.",
        unit="s", group="tracking", live=True, gt=0.1, le=3600.0,
        search=Search("process", 0.5, 30.0, log=True),
    )  # fmt: skip
    initial_speed_std_mps: float = _parameter(
        0.5, "Spread of the speed of a new customer, per axis.",
        unit="m/s", group="tracking", live=True, gt=0.0, le=10.0,
        search=Search("process", 0.1, 2.0, log=True),
    )  # fmt: skip
    outlier_dof: float = _parameter(
        4.0, "Ranges are heavy-tailed: degrees of freedom of their Student-t noise; 0 takes them "
        "for Gaussian.",
        group="tracking", live=True, ge=0.0, le=1000.0,
        search=Search("measurement", 1.0, 30.0, log=True),
    )  # fmt: skip
    gate_probability: float = _parameter(
        0.9999, "Share of true measurements that the gate lets through; people start and turn at "
        "once, so that a narrow gate loses them.",
        group="tracking", live=True, gt=0.5, lt=1.0,
        search=Search("clutter", 0.9, 0.99999),
    )  # fmt: skip
    innovation_floor_m: float = _parameter(
        0.05, "No gate is narrower than that of this standard deviation, however sure the filter.",
        unit="m", group="tracking", live=True, ge=0.0, le=1.0,
        search=Search("measurement", 0.0, 0.3),
    )  # fmt: skip
    detection_probability: float = _parameter(
        0.9, "Chance that a raised hand, or a person in the scan, is detected in a frame.",
        group="tracking", live=True, ge=0.05, le=0.99,
        search=Search("clutter", 0.3, 0.98),
    )  # fmt: skip
    newcomer_density: float = _parameter(
        0.005, "Raised hands of nobody known, false ones and new customers', per frame and area.",
        unit="1/m^2", group="tracking", live=True, gt=0.0, le=10.0,
        search=Search("clutter", 0.0005, 0.2, log=True),
    )  # fmt: skip
    bystander_density: float = _parameter(
        0.05, "Other measurements of nobody known, per frame and area: of who steps out from "
        "behind others, and of what looks like a person in the scan.",
        unit="1/m^2", group="tracking", live=True, gt=0.0, le=10.0,
        search=Search("clutter", 0.0005, 1.0, log=True),
    )  # fmt: skip
    confirmation: Literal["m_of_n", "existence"] = _parameter(
        "m_of_n", "What makes a customer: m_of_n (raised-hand detections in a window of frames) "
        "or existence (its probability).",
        group="tracking", live=True,
    )  # fmt: skip
    confirm_existence: float = _parameter(
        0.9, "`confirmation: existence`: the probability that makes a customer.",
        group="tracking", live=True, ge=0.1, le=0.999,
    )  # fmt: skip
    confirm_detections: int = _parameter(
        2, "`confirmation: m_of_n`: raised-hand detections that make a customer ...",
        unit="frames", group="tracking", live=True, ge=1, le=100,
        search=Search("life", 1, 6),
    )  # fmt: skip
    confirm_window: int = _parameter(
        3, "... out of so many processed frames.",
        unit="frames", group="tracking", live=True, ge=1, le=100,
        search=Search("life", 2, 10),
    )  # fmt: skip
    delete_after_s: float = _parameter(
        2.0, "A customer whom neither hand nor scan has shown for so long, though in view, is "
        "gone.",
        level="basic",
        unit="s", group="tracking", live=True, gt=0.0, le=3600.0,
        search=Search("life", 0.3, 6.0, log=True),
    )  # fmt: skip
    mature_detections: int = _parameter(
        5, "Customers with fewer raised-hand detections are gone sooner, in proportion.",
        unit="frames", group="tracking", live=True, ge=1, le=1000,
        search=Search("life", 1, 20),
    )  # fmt: skip
    forget_after_s: float = _parameter(
        60.0, "A customer whose hand has not been up for so long is forgotten, seen or not.",
        level="basic",
        unit="s", group="tracking", live=True, gt=0.0, le=86400.0,
    )  # fmt: skip
    same_person_distance_m: float = _parameter(
        0.45, "Two raised hands closer together than this belong to one person, unless several "
        "customers call there.",
        unit="m", group="tracking", live=True, ge=0.0, le=2.0,
        search=Search("life", 0.2, 1.0),
    )  # fmt: skip
    raise_streak: int = _parameter(
        2, "Consecutive detections after which a hand counts as raised (algorithm 1).",
        level="basic",
        unit="frames", group="tracking", live=True, ge=1, le=1000,
    )  # fmt: skip
    lower_streak: int = _parameter(
        3, "Consecutive misses after which it counts as lowered (algorithm 1).",
        level="basic",
        unit="frames", group="tracking", live=True, ge=1, le=1000,
    )  # fmt: skip

    # Selection and poses.
    selection: Literal["first", "nearest", "newest"] = _parameter(
        "first", "Who of several is served: whose hand went up first, who is nearest to the "
        "robot, or whose hand went up last. Whoever is chosen stays chosen while the hand is up.",
        level="basic",
        group="selection", live=True,
    )  # fmt: skip
    selection_hold_s: float = _parameter(
        0.0, "How long the chosen customer stays chosen after the hand went down.",
        level="basic",
        unit="s", group="selection", live=True, ge=0.0, le=3600.0,
    )  # fmt: skip
    pose_max_std_m: float = _parameter(
        0.5, "A pose is given only while the standard deviation that is published with it, along "
        "its worst axis, is below.",
        level="basic",
        unit="m", group="selection", live=True, gt=0.0, le=10.0,
    )  # fmt: skip
    pose_max_age_s: float = _parameter(
        1.0, "A pose is given only while a measurement has touched the customer within this time.",
        unit="s", group="selection", live=True, gt=0.0, le=60.0,
    )  # fmt: skip
    approach_distance_m: float = _parameter(
        0.8, "How far in front of the customer the approach pose stands.",
        level="basic",
        unit="m", group="selection", live=True, gt=0.0, le=5.0,
    )  # fmt: skip

    # Who waits for service.
    calls_wait: bool = _parameter(
        False, "The selected customer may be one whose hand has fallen and who waits to be "
        "served. Off: only whose hand is up is selected, as in the original node, while the "
        "waiting list keeps calls all the same.",
        level="basic",
        group="service", live=True,
    )  # fmt: skip
    call_min_s: float = _parameter(
        0.5, "A call is kept after the hand falls only if the hand was up for so long (guess).",
        unit="s", group="service", live=True, ge=0.0, le=60.0,
    )  # fmt: skip
    call_again_after_s: float = _parameter(
        2.0, "Who has been served, or released, calls again once the hand was down for so long "
        "(guess).",
        unit="s", group="service", live=True, ge=0.0, le=3600.0,
    )  # fmt: skip
    call_left_s: float = _parameter(
        60.0, "Who waits is gone once the scan has seen nobody at their place for so long; time "
        "in which the place is out of the scan's view does not count (guess).",
        unit="s", group="service", live=True, gt=0.0, le=86400.0,
    )  # fmt: skip
    call_expiry_s: float = _parameter(
        1800.0, "A call that was neither renewed nor answered by a command for so long is gone "
        "(guess).",
        unit="s", group="service", live=True, gt=0.0, le=86400.0,
    )  # fmt: skip
    place_std_m: float = _parameter(
        0.25, "How far customers move in their places while out of sight, as standard deviation "
        "per axis: who appears near such a place is taken for the one who was lost there (guess).",
        unit="m", group="service", live=True, gt=0.0, le=5.0,
    )  # fmt: skip

    # The nodes' own; recordings are read as they are.
    image_transport: Literal["raw", "compressed"] = _parameter(
        "raw", "How a node gets its images: raw (`image_raw`) or compressed "
        "(`image_raw/compressed`).",
        level="basic",
        group="node",
    )  # fmt: skip
    dashboard_port: int = _parameter(
        0, "Port of the node's page for a browser (extra `live`); 0 serves none.",
        level="basic",
        group="node", ge=0, le=65535,
    )  # fmt: skip
    dashboard_host: str = _parameter(
        "127.0.0.1", "Where the page listens: 0.0.0.0 for other computers, which then need the "
        "token that the log names.",
        group="node",
    )  # fmt: skip
    waiting_list_file: str = _parameter(
        "", "File in which a node keeps the waiting list, so that it goes on with it when it is "
        "started again; empty keeps none.",
        group="node",
    )  # fmt: skip
    depth_transport: Literal["raw", "compressed"] = _parameter(
        "raw", "How a node gets its depth images: raw (`depth`) or compressed "
        "(`depth/compressedDepth`).",
        group="node",
    )  # fmt: skip
    image_silence_s: float = _parameter(
        1.2, "After so long without a processed image a node reports nobody: no hand is up, no "
        "tracks. A camera slower than one image a second needs more.",
        unit="s", group="node", live=True, ge=0.1, le=3600.0,
    )  # fmt: skip

    @property
    def calling_gestures(self) -> tuple[Gesture, ...]:
        """Those of `gesture_call`."""
        return gestures_named(self.gesture_call)

    @property
    def read_lean_max_deg(self) -> float:
        """How far hands may lean that are read: a hand whose thumb is up lies on its side."""
        reads_all = self.raise_rule == "image" or self.gesture_release.startswith("thumb")
        return 180.0 if reads_all else self.search_lean_max_deg

    @model_validator(mode="before")
    @classmethod
    def _none_is_retired(cls, values: dict[str, Any]) -> dict[str, Any]:
        for name, why in RETIRED.items():
            if name in values and name not in LATELY_RETIRED:
                raise ValueError(f"parameter `{name}` is no longer there: {why}. Delete it")
        return without_lately_retired(values)

    @model_validator(mode="after")
    def _bounds_agree(self) -> Config:
        if (self.camera_width == 0) != (self.camera_height == 0):
            raise ValueError(
                f"camera_width is {self.camera_width} and camera_height is {self.camera_height}; "
                "set both, or neither"
            )
        try:
            gestures_named(self.gesture_call)
        except ValueError as error:
            raise ValueError(f"gesture_call is {shown(self.gesture_call)}: {error}") from error
        if self.confirm_detections > self.confirm_window:
            raise ValueError(
                f"confirm_detections is {self.confirm_detections}; it must not exceed "
                f"confirm_window, which is {self.confirm_window}"
            )
        return self

    @classmethod
    def from_mapping(cls, values: dict[str, Any], origin: str = "configuration") -> Config:
        """Check parameters that came from somewhere.

        Args:
            values: Parameter names and values; what is not named keeps its default.
            origin: Where they came from, for the message.

        Raises:
            ConfigError: A name is unknown, a type wrong, a value out of range; the message names
                each such key, its value and what is allowed.
        """
        for key, value in values.items():  # ROS tools write 8 for 8.0; the other way is a mistake
            if type(value) is int and key in cls.model_fields:
                if cls.model_fields[key].annotation is float:
                    values = {**values, key: float(value)}
        try:
            return cls.model_validate(values)
        except ValidationError as error:
            reasons = "; ".join(_reason(item) for item in error.errors())
            raise ConfigError(f"{origin}: {reasons}") from error

    @classmethod
    def from_yaml(
        cls,
        path: str | Path,
        node: str | None = None,
        *,
        remark: Callable[[str], object] = _WARN,
    ) -> Config:
        """Read a ROS parameter file: `hand_detector: ros__parameters: ...`.

        Names with namespaces and wildcards (`/robot1/hand_detector`, `/**`) are understood as rcl
        does; other nodes' parameters in the same file are left alone, and so are ROS's own, such
        as `use_sim_time`. Parameters of earlier versions are left out, with a remark.

        Args:
            path: The file.
            node: Full name of the node; by default the one `hand_detector` that the file has.
            remark: Takes that remark, one line; by default a warning (`warnings.warn`).

        Raises:
            ConfigError: The file cannot be read, is no such file, or a parameter is off.
        """
        found = read_parameters(Path(path), node)
        ours = {name: value for name, value in found.items() if is_ours(name)}
        return cls.from_mapping(without_retired(ours, str(path), remark), origin=str(path))

    def replace(self, **changes: Any) -> Config:
        """The same configuration with some parameters changed, checked again.

        Raises:
            ConfigError: As `from_mapping`.
        """
        return Config.from_mapping({**self.model_dump(), **changes})


def allowed_values(name: str) -> str:
    """What a parameter may be, in words: its type, its range or choices, its unit."""
    info = Config.model_fields[name]
    choices = getattr(info.annotation, "__args__", ())
    if choices:
        return "one of " + ", ".join(str(choice) for choice in choices)
    words = {float: "a number", int: "a whole number", bool: "true or false", str: "a text"}
    text = words[info.annotation]  # type: ignore[index]
    symbols = {"gt": "above", "ge": "at least", "lt": "below", "le": "at most"}
    bounds = [
        f"{word} {getattr(item, attribute):g}"
        for item in info.metadata
        for attribute, word in symbols.items()
        if getattr(item, attribute, None) is not None
    ]
    unit = parameter_extra(name)["unit"]
    return " ".join(filter(None, [text, " and ".join(bounds), f"({unit})" if unit else ""]))


def parameter_extra(name: str) -> dict[str, Any]:
    """Unit, group, `level`, `live` (may it change while running) and `search` of a parameter."""
    extra = Config.model_fields[name].json_schema_extra
    assert isinstance(extra, dict)
    return extra


def parameter_search(name: str) -> Search | None:
    """Where tuning looks for a parameter; None where it leaves it alone."""
    search = parameter_extra(name)["search"]
    return None if search is None else Search(**search)


def _reason(item: Any) -> str:
    name = ".".join(map(str, item["loc"]))
    if name and name not in Config.model_fields:
        return f"unknown parameter `{name}`{_suggestion(name)}"
    if not name:
        return str(item["msg"]).removeprefix("Value error, ")
    return f"`{name}` is {shown(item['input'])}; allowed is {allowed_values(name)}"


def _suggestion(name: str) -> str:
    from difflib import get_close_matches

    close = get_close_matches(name, Config.model_fields, n=1)
    return f"; did you mean `{close[0]}`?" if close else ""
