"""The scenes of a detection study: drawn at random, balanced over everything that may matter.

Callers raise a hand at a known time; idlers talk, drink, phone, scratch their heads, rest their
hands or wave them low, and never call.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from tracker.errors import SceneError
from tracker.simulation import Scene
from tracker.simulation.interior import Wall
from tracker.simulation.motion import people_at
from tracker.simulation.projection import Viewpoint
from tracker.simulation.rendering.camera_view import hands_in_view
from tracker.simulation.scene import Activity, Camera, Person, PersonLook, Raise, WayPoint
from tracker.simulation.stream import map_from_camera

#: The hand is up from this time of a caller's scene on; a detector has the time before to look
#: around.
HAND_UP_S = 1.5
#: How many people an idlers' scene has.
IDLERS = 3

#: From light to dark; drawn by eye after photos.
_SKIN = {
    "light": "#f3d3bd",
    "fair": "#dfae8a",
    "tan": "#bf8a5f",
    "brown": "#8a5a3b",
    "dark": "#4f3124",
}
_LIGHT: dict[str, dict[str, float]] = {
    "normal": {},
    "dark": {"exposure": 0.35, "noise_std": 4.0},
    "bright": {"exposure": 1.3},
    "noisy": {"noise_std": 10.0},
    "backlit": {"exposure": 0.45, "backlight": 3.0},
}
_BLUR: dict[str, dict[str, Any]] = {
    "sharp": {},
    "soft": {"blur_px": 1.0},
    "moving": {"motion_px": 3},
}
_HAIR = ("#1d1814", "#4a3428", "#8a6a3c", "#c9b48a", "#8d8d8d")
_BUSY = ("talk", "drink", "phone", "scratch", "rest", "wave_low")

#: What is balanced: at each distance each level comes equally often, give or take one.
FACTORS: dict[str, tuple[str, ...]] = {
    "light": tuple(_LIGHT),
    "blur": tuple(_BLUR),
    "skin": tuple(_SKIN),
    "sleeve": ("long", "short", "bare"),
    "hand": ("left", "right"),
    "company": ("alone", "together"),
    "sign": ("palm", "fist", "finger", "wave"),
}
_ATTEMPTS = 1000
_ROOM_TINT = 35


@dataclass(frozen=True, slots=True)
class Conditions:
    """What is balanced over the episodes.

    Attributes:
        distance_m: Of the caller, ahead of the camera.
        light: One of `FACTORS`, as all that follow.
        blur: Of the picture.
        skin: Of the caller.
        sleeve: Of the caller.
        hand: Which one goes up.
        company: Whether somebody else, who does not call, is in the room.
        sign: What the raised hand shows; a wave is an open hand that goes to and fro.
    """

    distance_m: float
    light: str
    blur: str
    skin: str
    sleeve: str
    hand: str
    company: str
    sign: str = "palm"


def draw_conditions(
    distances_m: Sequence[float], episodes: int, rng: np.random.Generator
) -> list[Conditions]:
    """Deal the levels of all factors out to the episodes of each distance.

    Args:
        distances_m: Of the callers; episodes are spread evenly over them.
        episodes: How many in all.
        rng: Shuffles.
    """
    drawn = []
    for row, distance_m in enumerate(distances_m):
        count = len(range(row, episodes, len(distances_m)))
        dealt = {name: _deal(levels, count, rng) for name, levels in FACTORS.items()}
        drawn += [
            Conditions(distance_m, **{name: levels[item] for name, levels in dealt.items()})
            for item in range(count)
        ]
    return drawn


def caller_scene(
    conditions: Conditions, up_s: float, rate_hz: float, rng: np.random.Generator
) -> Scene:
    """A room in which somebody raises a hand at `HAND_UP_S`, in the camera's view.

    The caller is person 1; stature, build, clothes, posture, the way to call, the room and the
    height of the camera (0.9 to 1.6 m) are drawn until the whole hand is in view.

    Args:
        conditions: What is given.
        up_s: How long the hand stays up.
        rate_hz: Images per second.
        rng: Of the rest.

    Raises:
        SceneError: At this distance no raised hand fits into the picture.
    """
    until_s = HAND_UP_S + up_s
    for _ in range(_ATTEMPTS):
        caller = _person(
            1,
            conditions.distance_m,
            rng.uniform(-0.5, 0.5),
            rng,
            skin=conditions.skin,
            sleeve=conditions.sleeve,
            hand=conditions.hand,
            **_call(conditions.sign, rng),
            raises=(Raise(from_s=HAND_UP_S, until_s=until_s),),
        )
        people = [caller]
        if conditions.company != "alone":
            farther_m = conditions.distance_m + rng.uniform(0.3, 1.5)
            what = _BUSY[rng.integers(len(_BUSY))]
            people.append(_idler(2, farther_m, rng.uniform(-0.5, 0.5), what, rng))
        scene = _room(people, conditions.light, conditions.blur, until_s, rate_hz, rng)
        if is_in_view(scene, HAND_UP_S):
            return scene
    raise SceneError(
        f"At {conditions.distance_m:g} m no raised hand fits into the picture; choose a larger "
        "distance."
    )


def idlers_scene(
    number: int,
    duration_s: float,
    distances_m: tuple[float, float],
    rate_hz: float,
    rng: np.random.Generator,
) -> Scene:
    """A room of people who do not call.

    Args:
        number: Of the scene; activities, light and blur take turns by it.
        duration_s: How long.
        distances_m: Nearest and farthest place.
        rate_hz: Images per second.
        rng: Of the rest.
    """
    bearings = np.linspace(-0.4, 0.4, IDLERS) + rng.uniform(-0.08, 0.08, IDLERS)
    whats = [_BUSY[(number * IDLERS + place) % len(_BUSY)] for place in range(IDLERS)]
    rng.shuffle(whats)
    people = [
        _idler(place + 1, rng.uniform(*distances_m), bearings[place], whats[place], rng)
        for place in range(IDLERS)
    ]
    light = FACTORS["light"][number % len(_LIGHT)]
    blur = FACTORS["blur"][number % len(_BLUR)]
    return _room(people, light, blur, duration_s, rate_hz, rng)


def is_in_view(scene: Scene, time_s: float) -> bool:
    """Whether the first person's raised hand falls into the picture."""
    view = Viewpoint.of(scene.camera, map_from_camera(scene, time_s))
    return bool(hands_in_view(scene, view, people_at(scene, time_s))[0])


def _deal(levels: Sequence[str], count: int, rng: np.random.Generator) -> list[str]:
    order = [str(level) for level in rng.permutation(levels)]  # who gets one more, if any
    dealt = [order[row % len(order)] for row in range(count)]
    rng.shuffle(dealt)
    return dealt


def _call(sign: str, rng: np.random.Generator) -> dict[str, Any]:
    """How somebody calls; a closed hand before the shoulder, and a slow wave, would be no call."""
    if sign == "wave":
        return {"wave_hz": rng.uniform(0.8, 2.0)}
    if sign == "palm":
        return {}
    return {"sign": sign, "raise_style": str(rng.choice(("beside", "straight")))}


def _idler(
    number: int, distance_m: float, bearing_rad: float, what: str, rng: np.random.Generator
) -> Person:
    doing = Activity.model_validate({"what": what, "tempo": rng.uniform(0.7, 1.5)})
    return _person(
        number,
        distance_m,
        bearing_rad,
        rng,
        skin=str(rng.choice(FACTORS["skin"])),
        sleeve=str(rng.choice(FACTORS["sleeve"])),
        hand=str(rng.choice(FACTORS["hand"])),
        activities=(doing,),
    )


def _person(
    number: int,
    distance_m: float,
    bearing_rad: float,
    rng: np.random.Generator,
    *,
    skin: str,
    sleeve: str,
    **others: Any,
) -> Person:
    look = PersonLook.model_validate(
        {
            "stature_m": rng.uniform(1.5, 1.95),
            "skin": _SKIN[skin],
            "hair": str(rng.choice(_HAIR)),
            "hair_style": str(rng.choice(("short", "long", "bun", "bald"))),
            "shirt": _color(rng, 30, 240),
            "trousers": _color(rng, 20, 120),
            "sleeve": sleeve,
            "build": rng.uniform(0.85, 1.3),
            "hand_m": rng.uniform(0.16, 0.20),
            "spread": rng.uniform(0.3, 1.0),
        }
    )
    place = WayPoint(x_m=distance_m, y_m=distance_m * float(np.tan(bearing_rad)), facing_deg=180.0)
    return Person.model_validate(
        {
            "id": number,
            "path": (place,),
            "seat_m": 0.5 if rng.random() < 0.6 else None,
            "raise_style": str(rng.choice(("beside", "straight", "low"))),
            "lean_deg": rng.uniform(-20.0, 20.0),
            "look": look,
            **others,
        }
    )


def _room(
    people: list[Person],
    light: str,
    blur: str,
    duration_s: float,
    rate_hz: float,
    rng: np.random.Generator,
) -> Scene:
    shown = {**_LIGHT[light], **_BLUR[blur]}
    backlight = shown.pop("backlight", 1.0)
    camera = Camera(x_m=0.0, z_m=rng.uniform(0.9, 1.6), rate_hz=rate_hz, **shown)
    behind_m = max(person.path[0].x_m for person in people) + rng.uniform(0.5, 3.0)
    wall = Wall(
        corners_m=((behind_m, -8.0), (behind_m, 8.0)),
        color=_color(rng, 90, 240, _ROOM_TINT),
        panel=_color(rng, 40, 160, _ROOM_TINT),
        pictures=bool(rng.random() < 0.7),
    )
    return Scene(
        duration_s=duration_s,
        camera=camera,
        walls=(wall,),
        floor=_color(rng, 60, 180, _ROOM_TINT),
        people=tuple(people),
        backlight=backlight,
    )


def _color(rng: np.random.Generator, low: int, high: int, tint: int = 255) -> str:
    """Channels from `low` to `high`, none farther than `tint` from a common gray."""
    gray = int(rng.integers(low, high))
    first, last = max(low, gray - tint), min(high, gray + tint + 1)
    red, green, blue = rng.integers(first, last, 3)
    return f"#{red:02x}{green:02x}{blue:02x}"
