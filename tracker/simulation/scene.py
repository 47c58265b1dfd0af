"""What happens in a simulated room? The scene file: walls, tables, people, the robot, its sensors.

Lengths are meters, angles degrees, times seconds from the start, places in the map frame (x and y
on the floor). Where a thing stands still, one way-point is enough.
"""

from __future__ import annotations

from difflib import get_close_matches
from importlib import resources
from itertools import pairwise
from pathlib import Path
from typing import Annotated, Any, Literal, TypeAlias

from pydantic import Field, ValidationError, model_validator

from tracker.errors import ConfigError, SceneError
from tracker.parameters.yaml_reading import read_yaml
from tracker.simulation.interior import Chair, Color, Part, Pose2, Poster, Table, Wall
from tracker.wording import shown

#: How long an arm takes from the lap to beside the head; a guess from how people wave to a waiter.
ARM_MOTION_S = 0.4

Stature: TypeAlias = Annotated[float, Field(ge=1.0, le=2.2)]


class WayPoint(Part):
    """Where somebody is at a time."""

    at_s: float = Field(0.0, ge=0.0)
    x_m: float
    y_m: float
    facing_deg: float | None = Field(
        None, description="Where the body looks; None: along the way, or at the robot."
    )


class DrivePoint(Pose2):
    """Where the robot is at a time; it starts and stops smoothly at each such point."""

    at_s: float = Field(0.0, ge=0.0)


class Raise(Part):
    """One raise: the hand is fully up from one time until another, the arm moves around that."""

    from_s: float = Field(ge=0.0)
    until_s: float = Field(gt=0.0)


class Activity(Part):
    """Something that hands do besides calling; a raise interrupts it."""

    what: Literal[
        "talk", "drink", "phone", "scratch", "rest", "wave_low", "chin", "mouth", "hair",
        "on_head", "together", "clap", "cross", "thumb", "aside", "sign",
    ]  # fmt: skip
    from_s: float = Field(0.0, ge=0.0)
    until_s: float = Field(3600.0, gt=0.0)
    tempo: float = Field(1.0, ge=0.2, le=5.0, description="Times as fast.")


class PersonLook(Part):
    """Colors, clothes and build."""

    stature_m: Stature = 1.72
    skin: Color = "#d6a078"
    hair: Color = "#4a3428"
    hair_style: Literal["short", "long", "bun", "bald"] = "short"
    shirt: Color = "#3c6e96"
    trousers: Color = "#384050"
    sleeve: Literal["short", "long", "bare"] = "short"
    build: float = Field(1.0, ge=0.7, le=1.6, description="How wide trunk and limbs are.")
    hand_m: float = Field(0.18, ge=0.1, le=0.25, description="Length of the hand.")
    spread: float = Field(1.0, ge=0.0, le=1.0, description="Of the fingers; 0 is closed.")


class Person(Part):
    """Somebody who walks, stops, sits, raises a hand."""

    id: int = Field(ge=1, lt=2**31)
    name: str = ""
    path: Annotated[tuple[WayPoint, ...], Field(strict=False, min_length=1)]
    raises: Annotated[tuple[Raise, ...], Field(strict=False)] = ()
    seat_m: float | None = Field(None, ge=0.3, le=0.9, description="Height of the seat.")
    shins_m: float = Field(
        0.1, ge=0.0, le=0.6, description="Who sits has the shins so far in front of the body."
    )
    stool: bool = Field(
        True, description="Who sits is drawn on a stool; false where a chair stands there."
    )
    activities: Annotated[tuple[Activity, ...], Field(strict=False)] = ()
    hand: Literal["left", "right"] = "right"
    raise_style: Literal["beside", "straight", "low"] = Field(
        "beside", description="The raised hand is beside the head, straight up, or low (the "
        "elbow at the side)."
    )  # fmt: skip
    lean_deg: float = Field(0.0, ge=-40.0, le=40.0, description="Of the raised hand, outward.")
    sign: Literal["palm", "fist", "finger"] = Field("palm", description="Shown by that hand.")
    wave_hz: float = Field(0.0, ge=0.0, le=5.0, description="The raised hand waves so often.")
    look: PersonLook = Field(default_factory=PersonLook)

    @model_validator(mode="after")
    def _possible(self) -> Person:
        _check_times([point.at_s for point in self.path], "path", "at_s")
        places = {(point.x_m, point.y_m) for point in self.path}
        if self.seat_m is not None and len(places) > 1:
            raise ValueError(
                f"path has {len(places)} places, but seat_m is {self.seat_m}; "
                "who sits stays: give one place or leave seat_m out"
            )
        edges = [edge for each in self.raises for edge in (each.from_s, each.until_s)]
        _check_times(edges, "raises", "from_s, until_s")
        edges = [edge for each in self.activities for edge in (each.from_s, each.until_s)]
        _check_times(edges, "activities", "from_s, until_s")
        for before, after in pairwise(self.raises):
            if after.from_s - before.until_s < 2 * ARM_MOTION_S:
                raise ValueError(
                    f"raises: the hand is up until {before.until_s} and again from "
                    f"{after.from_s}; at least {2 * ARM_MOTION_S} s must lie between"
                )
        return self


class Robot(Part):
    """The drive of base_link."""

    path: Annotated[tuple[DrivePoint, ...], Field(strict=False)] = Field(
        default=(DrivePoint(),), min_length=1
    )

    @model_validator(mode="after")
    def _possible(self) -> Robot:
        _check_times([point.at_s for point in self.path], "path", "at_s")
        return self


class Camera(Part):
    """A level pinhole camera, fixed to base_link."""

    x_m: float = 0.1
    y_m: float = 0.0
    z_m: float = Field(1.2, gt=0.0, le=3.0)
    yaw_deg: float = 0.0
    frame: Literal["camera_link", "camera_optical_frame"] = "camera_link"
    rate_hz: float = Field(30.0, gt=0.0, le=240.0)
    width: int = Field(640, ge=16, le=4096)
    height: int = Field(480, ge=16, le=4096)
    fx: float = Field(460.0, gt=0.0)
    fy: float = Field(460.0, gt=0.0)
    cx: float = 320.0
    cy: float = 240.0
    noise_std: float = Field(1.5, ge=0.0, le=60.0, description="Of each pixel, in gray levels.")
    blur_px: float = Field(0.5, ge=0.0, le=10.0, description="Standard deviation of the focus.")
    motion_px: int = Field(1, ge=1, le=64, description="Length of a sideways smear.")
    exposure: float = Field(1.0, gt=0.0, le=4.0, description="Brightness of everything.")


class Laser(Part):
    """A planar scanner, fixed to base_link."""

    x_m: float = 0.15
    y_m: float = 0.0
    z_m: float = Field(0.25, gt=0.0, le=3.0)
    yaw_deg: float = 0.0
    frame: str = Field("laser", min_length=1)
    rate_hz: float = Field(10.0, gt=0.0, le=100.0)
    first_beam_deg: float = Field(-180.0, ge=-360.0, le=360.0)
    step_deg: float = Field(0.5, ge=0.05, le=10.0)
    range_min_m: float = Field(0.12, ge=0.0)
    range_max_m: float = Field(12.0, gt=0.0)
    noise_m: float = Field(0.01, ge=0.0, le=1.0)
    dropout: float = Field(0.01, ge=0.0, lt=1.0, description="Share of beams without a return.")


class Depth(Part):
    """A depth camera, of stereo kind, beside the color camera.

    Registered pictures show what the color camera shows, pixel by pixel, in its frame. Others have
    intrinsics, a place and a frame (`camera_depth_optical_frame`) of their own.
    """

    registered: bool = True
    unit: Literal["mm", "m"] = Field("mm", description="16UC1 in mm, or 32FC1 in m.")
    y_m: float = Field(0.059, description="To the left of the color camera, if not registered.")
    width: int = Field(848, ge=16, le=4096)
    height: int = Field(480, ge=16, le=4096)
    f_px: float = Field(424.0, gt=0.0, description="Focal length; registered: the color camera's.")
    rate_hz: float = Field(15.0, gt=0.0, le=240.0)
    range_min_m: float = Field(0.3, ge=0.0)
    range_max_m: float = Field(10.0, gt=0.0)
    baseline_m: float = Field(0.05, gt=0.0)
    disparity_std_px: float = Field(0.08, ge=0.0, description="Its noise.")
    disparity_step_px: float = Field(0.0625, gt=0.0, description="No finer is it told.")
    holes: float = Field(0.03, ge=0.0, lt=1.0, description="Share without a reading.")


class Scene(Part):
    """One simulated recording."""

    title: str = ""
    duration_s: float = Field(gt=0.0, le=3600.0)
    start_s: int = Field(1_700_000_000, ge=0, description="Stamp of the first image, Unix time.")
    map_from_odom: Pose2 = Field(default_factory=Pose2)
    robot: Robot = Field(default_factory=Robot)
    camera: Camera = Field(default_factory=Camera)
    laser: Laser = Field(default_factory=Laser)
    depth: Depth | None = None
    floor: Color = "#9c8b78"
    backlight: float = Field(1.0, gt=0.0, le=16.0, description="Brightness of what is behind.")
    walls: Annotated[tuple[Wall, ...], Field(strict=False)] = ()
    tables: Annotated[tuple[Table, ...], Field(strict=False)] = ()
    chairs: Annotated[tuple[Chair, ...], Field(strict=False)] = ()
    people: Annotated[tuple[Person, ...], Field(strict=False)] = ()

    @model_validator(mode="after")
    def _possible(self) -> Scene:
        ids = [person.id for person in self.people]
        twice = {number for number in ids if ids.count(number) > 1}
        if twice:
            raise ValueError(
                f"people: the id {min(twice)} occurs twice; each person needs a different one"
            )
        if self.laser.range_max_m <= self.laser.range_min_m:
            raise ValueError(
                f"laser.range_max_m is {self.laser.range_max_m}; allowed is "
                f"above range_min_m, which is {self.laser.range_min_m}"
            )
        return self


def load_scene(name_or_path: str | Path) -> Scene:
    """Read a scene.

    Args:
        name_or_path: The name of a scene that comes with the project (`scene_names`), or a file.

    Raises:
        SceneError: There is no such scene or file, it is no YAML, or something in it is off; the
            message names each such key, its value and what is allowed.
    """
    path = _find(name_or_path)
    try:
        document = read_yaml(path)
    except ConfigError as error:
        raise SceneError(str(error)) from error
    return scene_from_mapping(document, origin=str(path))


def scene_from_mapping(document: Any, origin: str = "scene") -> Scene:
    """Check a scene that was written down as nested lists and dictionaries.

    Raises:
        SceneError: As `load_scene`.
    """
    if not isinstance(document, dict):
        raise SceneError(f"{origin}: contains no scene; expected keys such as `duration_s:`.")
    try:
        return Scene.model_validate(document)
    except ValidationError as error:
        reasons = "; ".join(_reason(item) for item in error.errors())
        raise SceneError(f"{origin}: {reasons}.") from error


def with_depth_camera(scene: Scene) -> Scene:
    """The same scene with a depth camera, registered to the color camera unless it has its own."""
    return scene if scene.depth is not None else scene.model_copy(update={"depth": Depth()})


def scene_names() -> list[str]:
    """The scenes that come with the project."""
    return sorted({path.stem for folder in _folders() for path in folder.glob("*.yaml")})


def _find(name_or_path: str | Path) -> Path:
    path = Path(name_or_path)
    if isinstance(name_or_path, Path) or path.suffix in (".yaml", ".yml") or len(path.parts) > 1:
        return path
    for folder in _folders():
        packaged = folder / f"{path}.yaml"
        if packaged.is_file():
            return packaged
    raise SceneError(
        f"There is no scene {str(name_or_path)!r}; there are "
        f"{', '.join(scene_names()) or 'none'}. A file of your own needs its ending, .yaml."
    )


def _folders() -> list[Path]:
    package = Path(str(resources.files("tracker")))
    # A wheel carries the scenes inside the package; a checkout keeps them under config/.
    candidates = [package / "scenes", package.parent / "config" / "scenes"]
    return [folder for folder in candidates if folder.is_dir()]


def _check_times(times: list[float], where: str, key: str) -> None:
    for before, after in pairwise(times):
        if after <= before:
            raise ValueError(f"{where}: {key} is {after} after {before}; times must grow")


def _reason(item: Any) -> str:
    key = ".".join(map(str, item["loc"]))
    message = str(item["msg"])
    if item["type"] == "extra_forbidden":
        return f"unknown key `{key}`{_suggestion(str(item['loc'][-1]))}"
    if item["type"] == "missing":
        return f"`{key}` is missing"
    if item["type"] == "value_error":
        return f"{key}: {message.removeprefix('Value error, ')}".removeprefix(": ")
    if item["type"] == "string_pattern_mismatch":
        message = "a color like '#d6a078'"
    allowed = message.removeprefix("Input should be ")
    return f"`{key}` is {shown(item['input'])}; allowed is {allowed}"


def _suggestion(name: str) -> str:
    things = (Scene, Robot, Camera, Laser, Depth, Wall, Poster, Table, Chair)
    people = (Person, PersonLook, DrivePoint, WayPoint, Raise, Activity)
    known = {key for part in (*things, *people) for key in part.model_fields}
    close = get_close_matches(name, known, n=1)
    return f"; did you mean `{close[0]}`?" if close else ""
