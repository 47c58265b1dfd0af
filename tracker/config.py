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
    """The range in which `raised-hand tune` searches; of choices, all are tried.

    Attributes:
        kind: Process or measurement noise, clutter, life (of tracks), or method.
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
        10.0, "The node processes this many images per second on average and skips the others.",
        level="basic",
        unit="Hz", group="specification", live=True, gt=0.0, le=240.0,
    )  # fmt: skip
    downscale_factor: int = _parameter(
        2, "The picture is shrunk by this factor for the search in the whole picture and for the "
        "debug image.",
        level="basic",
        group="specification", live=True, ge=1, le=16,
    )  # fmt: skip
    hand_raised_threshold: float = _parameter(
        0.25, "With `raise_rule: image`, a hand is raised if the tip of the middle finger is at "
        "least this far above the wrist, in image heights.",
        level="basic",
        unit="image heights", group="specification", live=True, ge=0.0, le=1.0,
    )  # fmt: skip
    detection_confidence: float = _parameter(
        0.6, "The palm search accepts a hand from this score on. A lower value finds more hands "
        "and more false ones.",
        level="basic",
        group="specification", live=True, gt=0.0, lt=1.0,
    )  # fmt: skip
    tracking_confidence: float = _parameter(
        0.5, "A hand is followed into the next image if its landmark score is at least this.",
        level="basic",
        group="specification", live=True, gt=0.0, lt=1.0,
    )  # fmt: skip
    model_complexity: int = _parameter(
        0, "This selects the hand models: 0 is lite (faster), 1 is full (more accurate).",
        level="basic",
        group="specification", ge=0, le=1,
    )  # fmt: skip
    camera_fx: float = _parameter(
        460.0, "This is the focal length along the columns of the full image; it is used until a "
        "CameraInfo arrives.",
        level="basic",
        unit="px", group="specification", live=True, gt=0.0, le=1e5,
    )  # fmt: skip
    camera_fy: float = _parameter(
        460.0, "This is the focal length along the rows of the full image; it is used until a "
        "CameraInfo arrives.",
        level="basic",
        unit="px", group="specification", live=True, gt=0.0, le=1e5,
    )  # fmt: skip
    camera_cx: float = _parameter(
        320.0, "This is the column of the principal point in the full image; it is used until a "
        "CameraInfo arrives.",
        level="basic",
        unit="px", group="specification", live=True, ge=-1e5, le=1e5,
    )  # fmt: skip
    camera_cy: float = _parameter(
        240.0, "This is the row of the principal point in the full image; it is used until a "
        "CameraInfo arrives.",
        level="basic",
        unit="px", group="specification", live=True, ge=-1e5, le=1e5,
    )  # fmt: skip

    # Frames and camera.
    camera_width: int = _parameter(
        0, "This is the width of the pictures for which `camera_fx` to `camera_cy` were "
        "measured; they are scaled to pictures of another size. 0 means the specification's "
        "640x480, or the picture's own size if the principal point is nearer to its center.",
        unit="px", group="frames", ge=0, le=100_000,
    )  # fmt: skip
    camera_height: int = _parameter(
        0, "This is the height of the pictures for which `camera_fx` to `camera_cy` were "
        "measured; set it together with `camera_width`.",
        unit="px", group="frames", ge=0, le=100_000,
    )  # fmt: skip
    picture_max_pixels: int = _parameter(
        50_000_000, "A picture with more pixels is skipped before it is decoded, and counted, "
        "because a small file can claim a size that fills the memory.",
        unit="px", group="frames", ge=1, le=1_000_000_000,
    )  # fmt: skip
    fixed_frame: str = _parameter(
        "map", "Customers are tracked and poses are published in this frame.",
        level="basic",
        group="frames",
    )  # fmt: skip
    camera_frame: str = _parameter(
        "camera_link", "This is the camera's frame. If it is empty, the image's own frame_id is "
        "used.",
        level="basic",
        group="frames",
    )  # fmt: skip
    camera_axes: Literal["auto", "body", "optical"] = _parameter(
        "auto", "This says which axes the camera's frame has: body (x forward, z up), optical (z "
        "forward, y down), or auto (optical if the frame's name contains `optical`, otherwise "
        "body).",
        level="basic",
        group="frames",
    )  # fmt: skip
    camera_roll_deg: float = _parameter(
        0.0, "This is the roll of the camera that its transform does not include, clockwise as "
        "seen from behind the camera. Hands are searched in a picture that is turned upright. "
        "Set it for cameras without a transform, or with one that omits the roll.",
        level="basic",
        unit="deg", group="frames", live=True, ge=-180.0, le=180.0,
    )  # fmt: skip
    use_camera_info: bool = _parameter(
        True, "If true, intrinsics and distortion are taken from CameraInfo as soon as it "
        "arrives.",
        level="basic",
        group="frames",
    )  # fmt: skip
    image_form: Literal["auto", "raw", "rectified"] = _parameter(
        "auto", "This says whether the images are distorted: raw (as the lens shows them; K and "
        "the distortion of CameraInfo are used), rectified (P is used), or auto (rectified if "
        "the topic's name says so, as in image_rect).",
        group="frames",
    )  # fmt: skip
    bearing_convention: Literal["rep103", "spec"] = _parameter(
        "rep103", "This is the sign of the bearing: rep103 (left is positive), or spec (right is "
        "positive as in the original node, for robots whose frames were built for that).",
        group="frames",
    )  # fmt: skip
    transform_wait_s: float = _parameter(
        0.3, "An image waits this long for the transform at its own stamp.",
        level="basic",
        unit="s", group="frames", live=True, ge=0.0, le=5.0,
    )  # fmt: skip

    camera_stamp_offset_s: float = _parameter(
        0.0, "The camera's stamps are this much too late; a negative value means too early. The "
        "camera's pose is taken at the corrected time. Notebook 03 estimates the offset.",
        unit="s", group="frames", live=True, ge=-1.0, le=1.0,
    )  # fmt: skip
    scan_stamp_offset_s: float = _parameter(
        0.0, "The laser's stamps are this much too late; a negative value means too early.",
        unit="s", group="frames", live=True, ge=-1.0, le=1.0,
    )  # fmt: skip
    stamp_std_s: float = _parameter(
        0.02, "This is the standard deviation of both stamp offsets (guess). While the robot "
        "turns or drives, it widens the published covariance.",
        unit="s", group="frames", live=True, ge=0.0, le=1.0,
    )  # fmt: skip

    # Perception.
    raise_rule: Literal["evidence", "palm", "image"] = _parameter(
        "evidence", "This rule decides whether a hand is raised. evidence: hand, arm, body and "
        "movement are weighed, at any distance, and a palm, fist, finger or wave may call. palm: "
        "an open hand, measured in palm lengths. image: the specification's rule in shares of "
        "the image, up to 0.7 m.",
        level="basic",
        group="perception", live=True,
    )  # fmt: skip
    palm_raised_threshold: float = _parameter(
        1.1, "With `raise_rule: palm`, a hand is raised if the tip of the middle finger is at "
        "least this far above the wrist, in palm lengths.",
        unit="palm lengths", group="perception", live=True, ge=0.0, le=3.0,
    )  # fmt: skip
    small_hand_px: float = _parameter(
        32.0, "A hand shorter than this is small, and `piece_confidence` applies to it. With the "
        "default camera, 32 px is a hand at 2.6 m.",
        unit="px", group="perception", live=True, ge=0.0, le=10000.0,
    )  # fmt: skip
    raised_lean_max_deg: float = _parameter(
        35.0, "With `raise_rule: palm`, a hand that leans more than this to a side is not "
        "raised.",
        unit="deg", group="perception", live=True, gt=0.0, le=90.0,
    )  # fmt: skip
    hand_span_threshold: float = _parameter(
        0.15, "With `raise_rule: image`, thumb and little finger must be at least this far "
        "apart, in image widths.",
        unit="image widths", group="perception", live=True, ge=0.0, le=1.0,
    )  # fmt: skip
    search_regions_per_frame: int = _parameter(
        3, "In each image, this many regions are searched for new hands: the whole picture, "
        "tiles of it, or windows around people. A higher value finds hands sooner and needs more "
        "processor time.",
        level="basic",
        group="perception", live=True, ge=1, le=64,
    )  # fmt: skip
    piece_confidence: float = _parameter(
        0.35, "For small hands (see `small_hand_px`), the palm search accepts a hand from this "
        "score on. Lower it if hands at far tables are missed. The landmark model rejects most "
        "of the false ones.",
        level="basic",
        group="perception", live=True, gt=0.0, lt=1.0,
    )  # fmt: skip
    search_lean_max_deg: float = _parameter(
        75.0, "Hands that lean more than this to a side are not processed. With 180, lowered "
        "hands are processed as well, as always with `raise_rule: image` or a `gesture_release` "
        "by the thumb.",
        unit="deg", group="perception", live=True, gt=0.0, le=180.0,
    )  # fmt: skip
    place_prior: bool = _parameter(
        True, "If true, `raise_rule: evidence` needs more evidence at a place where something "
        "calls that never moves, such as a poster of a raised hand.",
        group="perception", live=True,
    )  # fmt: skip
    max_hands: int = _parameter(
        8, "At most this many hands are followed at a time. While so many are followed, no new "
        "ones are searched.",
        group="perception", live=True, ge=1, le=64,
    )  # fmt: skip
    inference_threads: int = _parameter(
        2, "The models run on this many processor threads.",
        level="basic",
        group="perception", ge=1, le=32,
    )  # fmt: skip
    execution_provider: Literal["cpu", "cuda", "tensorrt", "openvino", "coreml", "auto"] = (
        _parameter(
            "cpu", "ONNX Runtime runs the models on this provider. All except cpu need a build "
            "of onnxruntime that includes it. auto takes the first available of cuda, coreml, "
            "openvino and cpu.",
            level="basic",
            group="perception",
        )
    )  # fmt: skip

    model_numbers: Literal["auto", "fp32", "int8"] = _parameter(
        "auto", "This is the number format of the models on the processor: fp32 (single "
        "precision), int8 (landmarks and the search for people partly in 8 bits, which moves "
        "landmarks by about 0.3 % of the hand's length), or auto (int8 if the processor has "
        "AVX-512 VNNI, which makes it faster, else fp32).",
        group="perception",
    )  # fmt: skip

    # What finds hands, and the second opinion of body poses.
    detector: Literal["hands", "pose", "mediapipe"] = _parameter(
        "hands", "This finds raised hands: hands (MediaPipe's hand models on ONNX Runtime), pose "
        "(only the arms of body poses), or mediapipe (an installed mediapipe 0.10).",
        group="pose",
    )  # fmt: skip
    pose_model: str = _parameter(
        "", "This is the ONNX file of your own pose model (RTMO, RTMPose, MoveNet MultiPose or "
        "YOLO-pose). If it is empty, MediaPipe's is used.",
        group="pose",
    )  # fmt: skip
    pose_opinion: Literal["evidence", "none"] = _parameter(
        "evidence", "This says how body poses are used, with `detector: hands` and `raise_rule: "
        "evidence`. evidence: they find the owners of hands, and raised arms whose hand was not "
        "found. none: hands are judged alone, which saves processor time.",
        level="basic",
        group="pose",
    )  # fmt: skip
    pose_confidence: float = _parameter(
        0.5, "A pose model's person is accepted from this score on.",
        group="pose", live=True, gt=0.0, lt=1.0,
    )  # fmt: skip
    pose_raised_threshold: float = _parameter(
        0.25, "With `detector: pose`, a hand is raised if the wrist is at least this far above "
        "its shoulder, in shoulder widths.",
        unit="shoulder widths", group="pose", live=True, ge=0.0, le=3.0,
    )  # fmt: skip
    pose_head_clearance: float = _parameter(
        0.6, "With `detector: pose`, a wrist nearer than this to nose, eyes or ears is at the "
        "head and not raised, in shoulder widths.",
        unit="shoulder widths", group="pose", live=True, ge=0.0, le=3.0,
    )  # fmt: skip

    # What hands say.
    gesture_call: str = _parameter(
        "all", "These gestures call: all, or some of palm, fist, point, victory, thumb_up, "
        "thumb_down, wave, stop and come, separated by commas. A raised hand that surely shows "
        "another gesture does not call. If the gesture is not sure, the hand may call.",
        level="basic",
        group="gestures", live=True,
    )  # fmt: skip
    gesture_release: Literal[
        "none", "palm", "fist", "point", "victory", "thumb_up", "thumb_down", "wave", "stop",
        "come",
    ] = _parameter(
        "none", "If the served customer shows this gesture, the service ends, as with "
        "~/release_customer. With thumb_up or thumb_down, hands are processed at any lean (see "
        "`search_lean_max_deg`). `selection_hold_s` leaves time to show the gesture after the "
        "hand went down.",
        level="basic",
        group="gestures", live=True,
    )  # fmt: skip

    # Ranging.
    ranging: Literal["person", "spec"] = _parameter(
        "person", "This measures the distance of a raised hand. person: it is the distance of "
        "the hand's owner, who is found among all people by the hand's direction and size. spec: "
        "it is the median of the beams in the hand's direction (algorithm 5).",
        group="ranging", live=True,
    )  # fmt: skip
    depth_source: Literal["both", "scan", "depth"] = _parameter(
        "both", "These sensors measure the distance of people: scan (the LiDAR), depth (a depth "
        "camera), or both. Without depth images, both is the same as scan.",
        level="basic",
        group="ranging", live=True,
    )  # fmt: skip
    depth_std_m: float = _parameter(
        0.005, "This is the range noise of the depth camera at 1 m, as standard deviation. It "
        "grows with the square of the range.",
        unit="m", group="ranging", live=True, ge=0.0, le=1.0,
    )  # fmt: skip
    depth_height_min_m: float = _parameter(
        0.85, "In the depth image, bodies are searched above this height over the floor, to "
        "leave out tables and chairs. Use a lower value for a low camera that does not look up.",
        unit="m", group="ranging", live=True, ge=0.05, le=1.9,
    )  # fmt: skip
    scan_window_beams: int = _parameter(
        3, "With `ranging: spec`, the median is taken over this many beams on each side of the "
        "hand's direction (algorithm 5).",
        unit="beams", group="ranging", live=True, ge=0, le=90,
    )  # fmt: skip
    scan_max_age_s: float = _parameter(
        0.25, "A scan or depth image is used only if its stamp differs from the image's stamp by "
        "at most this.",
        level="basic",
        unit="s", group="ranging", live=True, gt=0.0, le=10.0,
    )  # fmt: skip
    leg_width_min_m: float = _parameter(
        0.02, "A piece of the scan narrower than this is not a leg. Legs in trousers are 0.1 m "
        "wide and more. A value of 0.075 leaves out most legs of chairs and tables, and also "
        "bare ankles.",
        level="basic",
        unit="m", group="ranging", live=True, ge=0.0, le=0.3,
    )  # fmt: skip
    body_width_m: float = _parameter(
        0.8, "A piece of the scan wider than this is not a person.",
        unit="m", group="ranging", live=True, gt=0.1, le=2.0,
    )  # fmt: skip
    arm_reach_m: float = _parameter(
        0.6, "The owner of a raised hand stands at most this far to the side of the hand's "
        "direction.",
        unit="m", group="ranging", live=True, gt=0.0, le=2.0,
    )  # fmt: skip
    segment_jump_m: float = _parameter(
        0.15, "Neighboring beams belong to different pieces of the scan if their points are "
        "farther apart than this.",
        unit="m", group="ranging", live=True, gt=0.0, le=2.0,
    )  # fmt: skip
    person_range_max_m: float = _parameter(
        8.0, "People farther away than this are not measured by scan or depth.",
        level="basic",
        unit="m", group="ranging", live=True, gt=0.5, le=100.0,
    )  # fmt: skip
    scan_sustains: bool = _parameter(
        True, "If true, pieces of the scan that look like people keep customers alive and in "
        "place while their hands are down.",
        group="ranging", live=True,
    )  # fmt: skip
    background_after_s: float = _parameter(
        30.0, "A thing that has stood exactly still in the scan for this long, and is no "
        "customer, is taken for furniture until its place is seen empty. 0 turns this off.",
        unit="s", group="ranging", live=True, ge=0.0, le=3600.0,
    )  # fmt: skip
    use_map: bool = _parameter(
        True, "If true, things in the scan that stand on occupied cells of the map "
        "(nav_msgs/OccupancyGrid) are taken for furniture, even if they look like people.",
        group="ranging", live=True,
    )  # fmt: skip
    range_std_m: float = _parameter(
        0.08, "This is the range noise of a person in the scan, as standard deviation. It "
        "includes the scanner's noise and the thickness of the legs.",
        unit="m", group="ranging", live=True, ge=0.001, le=2.0,
        search=Search("measurement", 0.02, 0.6, log=True),
    )  # fmt: skip
    hand_offset_std_m: float = _parameter(
        0.2, "This is how far a raised hand is to the side of its body, as standard deviation.",
        unit="m", group="ranging", live=True, ge=0.0, le=1.0,
        search=Search("measurement", 0.05, 0.5, log=True),
    )  # fmt: skip
    torso_offset_std_m: float = _parameter(
        0.08, "This is how far a person's legs are from the center of shoulders and hips, as "
        "standard deviation per axis. The offset does not average out over time, so it widens "
        "the published covariance, and the bearing of a hand whose owner's torso is seen.",
        unit="m", group="ranging", live=True, ge=0.0, le=1.0,
    )  # fmt: skip
    mounting_std_deg: float = _parameter(
        0.5, "This is the uncertainty of the yaw of camera and laser on the robot, as standard "
        "deviation (guess). It widens the published covariance.",
        unit="deg", group="ranging", live=True, ge=0.0, le=10.0,
    )  # fmt: skip
    wrist_std_px: float = _parameter(
        1.0, "This is the error of the wrist's column in the full image for the smallest hand, "
        "as standard deviation. Most of it stays the same while the hand is followed.",
        unit="px", group="ranging", live=True, gt=0.0, le=100.0,
    )  # fmt: skip
    wrist_std_share: float = _parameter(
        0.02, "The error of the wrist's column grows with the length of the hand by this share.",
        unit="hand lengths", group="ranging", live=True, ge=0.0, le=1.0,
    )  # fmt: skip
    unknown_range_m: float = _parameter(
        2.5, "If no sensor measures the range of a new customer, this range is assumed.",
        unit="m", group="ranging", live=True, gt=0.1, le=20.0,
    )  # fmt: skip
    unknown_range_std_m: float = _parameter(
        1.5, "If the range of a new customer is assumed (see `unknown_range_m`), this is its "
        "standard deviation.",
        unit="m", group="ranging", live=True, gt=0.1, le=20.0,
    )  # fmt: skip

    # Tracking.
    motion: Literal["imm", "cv"] = _parameter(
        "imm", "This is the motion model of people: imm (they stand or walk, and change between "
        "the two) or cv (nearly constant velocity).",
        group="tracking", live=True,
        search=Search("method"),
    )  # fmt: skip
    association: Literal["pda", "hungarian", "jpda"] = _parameter(
        "pda", "This decides which measurement belongs to whom. pda: the most likely one-to-one "
        "assignment, where each pair counts by its probability. hungarian: the same assignment, "
        "where each pair counts in full. jpda: every pair inside the gate counts by its "
        "probability.",
        group="tracking", live=True,
        search=Search("method"),
    )  # fmt: skip
    acceleration_density: float = _parameter(
        0.6, "This is the process noise of people who walk: the power spectral density of their "
        "acceleration.",
        unit="m^2/s^3", group="tracking", live=True, gt=0.0, le=100.0,
        search=Search("process", 0.05, 10.0, log=True),
    )  # fmt: skip
    stand_speed_std_mps: float = _parameter(
        0.1, "With `motion: imm`, this is the speed at which standing people sway, as standard "
        "deviation per axis.",
        unit="m/s", group="tracking", live=True, gt=0.0, le=2.0,
        search=Search("process", 0.02, 0.5, log=True),
    )  # fmt: skip
    stand_duration_s: float = _parameter(
        3.0, "With `motion: imm`, people stand for this long on average.",
        unit="s", group="tracking", live=True, gt=0.1, le=3600.0,
        search=Search("process", 0.5, 30.0, log=True),
    )  # fmt: skip
    walk_duration_s: float = _parameter(
        5.0, "With `motion: imm`, people walk for this long on average.",
        unit="s", group="tracking", live=True, gt=0.1, le=3600.0,
        search=Search("process", 0.5, 30.0, log=True),
    )  # fmt: skip
    initial_speed_std_mps: float = _parameter(
        0.5, "This is the speed of a new customer, as standard deviation per axis.",
        unit="m/s", group="tracking", live=True, gt=0.0, le=10.0,
        search=Search("process", 0.1, 2.0, log=True),
    )  # fmt: skip
    outlier_dof: float = _parameter(
        4.0, "Range noise has heavy tails: it is a Student-t distribution with this many degrees "
        "of freedom. 0 means Gaussian noise.",
        group="tracking", live=True, ge=0.0, le=1000.0,
        search=Search("measurement", 1.0, 30.0, log=True),
    )  # fmt: skip
    gate_probability: float = _parameter(
        0.9999, "The gate accepts this share of a person's own measurements. People start and "
        "turn suddenly, and a narrow gate loses them.",
        group="tracking", live=True, gt=0.5, lt=1.0,
        search=Search("clutter", 0.9, 0.99999),
    )  # fmt: skip
    innovation_floor_m: float = _parameter(
        0.05, "The gate is never narrower than the gate of this standard deviation, even if the "
        "filter is very sure.",
        unit="m", group="tracking", live=True, ge=0.0, le=1.0,
        search=Search("measurement", 0.0, 0.3),
    )  # fmt: skip
    detection_probability: float = _parameter(
        0.9, "A raised hand, or a person in the scan, is detected in a frame with this "
        "probability.",
        group="tracking", live=True, ge=0.05, le=0.99,
        search=Search("clutter", 0.3, 0.98),
    )  # fmt: skip
    newcomer_density: float = _parameter(
        0.005, "This many raised hands per frame and square meter belong to no known person: new "
        "customers and false detections.",
        unit="1/m^2", group="tracking", live=True, gt=0.0, le=10.0,
        search=Search("clutter", 0.0005, 0.2, log=True),
    )  # fmt: skip
    bystander_density: float = _parameter(
        0.05, "This many other measurements per frame and square meter belong to no known "
        "person: people who appear from behind others, and things that look like people in the "
        "scan.",
        unit="1/m^2", group="tracking", live=True, gt=0.0, le=10.0,
        search=Search("clutter", 0.0005, 1.0, log=True),
    )  # fmt: skip
    confirmation: Literal["m_of_n", "existence"] = _parameter(
        "m_of_n", "This rule confirms a new customer: m_of_n (enough detections of the raised "
        "hand in a window of frames) or existence (a high enough probability of existence).",
        group="tracking", live=True,
    )  # fmt: skip
    confirm_existence: float = _parameter(
        0.9, "With `confirmation: existence`, a customer is confirmed from this probability on.",
        group="tracking", live=True, ge=0.1, le=0.999,
    )  # fmt: skip
    confirm_detections: int = _parameter(
        2, "With `confirmation: m_of_n`, a customer is confirmed after this many detections of "
        "the raised hand within `confirm_window` frames.",
        unit="frames", group="tracking", live=True, ge=1, le=100,
        search=Search("life", 1, 6),
    )  # fmt: skip
    confirm_window: int = _parameter(
        3, "With `confirmation: m_of_n`, the detections of the raised hand are counted over this "
        "many processed frames.",
        unit="frames", group="tracking", live=True, ge=1, le=100,
        search=Search("life", 2, 10),
    )  # fmt: skip
    delete_after_s: float = _parameter(
        2.0, "A customer who is in view, but whom neither hand nor scan has shown for this long, "
        "is deleted.",
        level="basic",
        unit="s", group="tracking", live=True, gt=0.0, le=3600.0,
        search=Search("life", 0.3, 6.0, log=True),
    )  # fmt: skip
    mature_detections: int = _parameter(
        5, "A customer with fewer detections of the raised hand than this is deleted sooner than "
        "after `delete_after_s`, in proportion.",
        unit="frames", group="tracking", live=True, ge=1, le=1000,
        search=Search("life", 1, 20),
    )  # fmt: skip
    forget_after_s: float = _parameter(
        60.0, "A customer whose hand has not been up for this long is forgotten, even if the "
        "person is still seen.",
        level="basic",
        unit="s", group="tracking", live=True, gt=0.0, le=86400.0,
    )  # fmt: skip
    same_person_distance_m: float = _parameter(
        0.45, "Two raised hands closer together than this belong to one person, unless several "
        "customers are known there.",
        unit="m", group="tracking", live=True, ge=0.0, le=2.0,
        search=Search("life", 0.2, 1.0),
    )  # fmt: skip
    raise_streak: int = _parameter(
        2, "A hand counts as raised after this many detections in a row (algorithm 1).",
        level="basic",
        unit="frames", group="tracking", live=True, ge=1, le=1000,
    )  # fmt: skip
    lower_streak: int = _parameter(
        3, "A hand counts as lowered after this many misses in a row (algorithm 1).",
        level="basic",
        unit="frames", group="tracking", live=True, ge=1, le=1000,
    )  # fmt: skip

    # Selection and poses.
    selection: Literal["first", "nearest", "newest"] = _parameter(
        "first", "If several customers call, this one is served: first (whose hand went up "
        "first), nearest (to the robot), or newest (whose hand went up last). The selected "
        "customer stays selected while the hand is up.",
        level="basic",
        group="selection", live=True,
    )  # fmt: skip
    selection_hold_s: float = _parameter(
        0.0, "The selected customer stays selected for this long after the hand went down.",
        level="basic",
        unit="s", group="selection", live=True, ge=0.0, le=3600.0,
    )  # fmt: skip
    pose_max_std_m: float = _parameter(
        0.5, "A pose is published only if its standard deviation, along the worst axis, is below "
        "this.",
        level="basic",
        unit="m", group="selection", live=True, gt=0.0, le=10.0,
    )  # fmt: skip
    pose_max_age_s: float = _parameter(
        1.0, "A pose is published only if the customer was last measured within this time.",
        unit="s", group="selection", live=True, gt=0.0, le=60.0,
    )  # fmt: skip
    approach_distance_m: float = _parameter(
        0.8, "The approach pose is this far in front of the customer.",
        level="basic",
        unit="m", group="selection", live=True, gt=0.0, le=5.0,
    )  # fmt: skip

    # Who waits for service.
    calls_wait: bool = _parameter(
        False, "If true, the selected customer may be somebody whose hand is down and who waits "
        "to be served. If false, only people whose hand is up are selected, as in the original "
        "node. The waiting list keeps calls in both cases.",
        level="basic",
        group="service", live=True,
    )  # fmt: skip
    call_min_s: float = _parameter(
        0.5, "A call stays on the waiting list after the hand goes down only if the hand was up "
        "for this long (guess).",
        unit="s", group="service", live=True, ge=0.0, le=60.0,
    )  # fmt: skip
    call_again_after_s: float = _parameter(
        2.0, "A customer who was served or released can call again after the hand was down for "
        "this long (guess).",
        unit="s", group="service", live=True, ge=0.0, le=3600.0,
    )  # fmt: skip
    call_left_s: float = _parameter(
        60.0, "A waiting customer is gone if the scan has seen nobody at that place for this "
        "long (guess). Time in which the place is out of view does not count.",
        unit="s", group="service", live=True, gt=0.0, le=86400.0,
    )  # fmt: skip
    call_expiry_s: float = _parameter(
        1800.0, "A call ends if it was neither renewed nor answered by a command for this long "
        "(guess).",
        unit="s", group="service", live=True, gt=0.0, le=86400.0,
    )  # fmt: skip
    place_std_m: float = _parameter(
        0.25, "This is how far customers move around their place while out of sight, as standard "
        "deviation per axis (guess). A person who appears near such a place is taken for the one "
        "who was lost there.",
        unit="m", group="service", live=True, gt=0.0, le=5.0,
    )  # fmt: skip

    # The nodes' own; recordings are read as they are.
    image_transport: Literal["raw", "compressed"] = _parameter(
        "raw", "The node subscribes to raw images (`image_raw`) or compressed ones "
        "(`image_raw/compressed`).",
        level="basic",
        group="node",
    )  # fmt: skip
    dashboard_port: int = _parameter(
        0, "The node's page for a browser is served on this port (extra `live`). 0 turns the "
        "page off.",
        level="basic",
        group="node", ge=0, le=65535,
    )  # fmt: skip
    dashboard_host: str = _parameter(
        "127.0.0.1", "The page is served on this address. With 0.0.0.0, other computers can open "
        "it with the token that the log shows.",
        level="basic",
        group="node",
    )  # fmt: skip
    waiting_list_file: str = _parameter(
        "", "The node stores the waiting list in this file and continues with it after a "
        "restart. If it is empty, nothing is stored.",
        group="node",
    )  # fmt: skip
    depth_transport: Literal["raw", "compressed"] = _parameter(
        "raw", "The node subscribes to raw depth images (`depth`) or compressed ones "
        "(`depth/compressedDepth`).",
        level="basic",
        group="node",
    )  # fmt: skip
    image_silence_s: float = _parameter(
        1.2, "If no image was processed for this long, the node reports nobody: no raised hand "
        "and no tracks. A camera slower than one image per second needs a higher value.",
        unit="s", group="node", live=True, ge=0.1, le=3600.0,
    )  # fmt: skip

    @property
    def calling_gestures(self) -> tuple[Gesture, ...]:
        """Those of `gesture_call`."""
        return gestures_named(self.gesture_call)

    @property
    def read_lean_max_deg(self) -> float:
        """Largest lean of a processed hand; a hand with its thumb up lies on its side."""
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
