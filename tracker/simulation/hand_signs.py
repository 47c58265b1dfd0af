"""How do people hold their hands? Ranges of the joints for each sign, and for what is none."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from tracker.containers import FloatArray, IntArray
from tracker.gesture import Gesture
from tracker.simulation.posed_hand import HandPose, hand_points

#: Root and middle joint of a finger, in degrees, from and to (guesses at what people do).
_FINGERS = {
    "straight": ((-10.0, 25.0), (0.0, 22.0)),
    "bent": ((50.0, 95.0), (75.0, 115.0)),
    "half": ((15.0, 55.0), (30.0, 70.0)),
    "hook": ((0.0, 25.0), (60.0, 100.0)),
    "ring": ((30.0, 60.0), (40.0, 80.0)),
}
#: The thumb: aside, out of the palm, and its two joints, likewise.
_THUMBS = {
    "open": ((32.0, 65.0), (0.0, 30.0), (-10.0, 20.0), (-20.0, 20.0)),
    "along": ((8.0, 32.0), (0.0, 25.0), (0.0, 20.0), (-5.0, 25.0)),
    "folded": ((5.0, 35.0), (30.0, 60.0), (25.0, 60.0), (15.0, 75.0)),
    "beside": ((0.0, 25.0), (20.0, 45.0), (5.0, 30.0), (0.0, 40.0)),
    "up": ((45.0, 80.0), (-10.0, 30.0), (-20.0, 12.0), (-30.0, 12.0)),
    "opposed": ((10.0, 40.0), (50.0, 85.0), (0.0, 35.0), (0.0, 40.0)),
    "touching": ((15.0, 35.0), (35.0, 55.0), (15.0, 40.0), (15.0, 40.0)),
}
#: The end joint follows the middle one.
_END_SHARE = (0.3, 0.75)
#: Fingers apart and together: how far index and little finger go from the fan, in degrees.
_APART, _ANY, _TOGETHER = (2.0, 12.0), (-8.0, 10.0), (-9.0, -5.0)


class Hold(NamedTuple):
    """One way to hold a hand.

    Attributes:
        gesture: What it says.
        fingers: Index to little finger.
        thumbs: Any of these.
        spread: Range in degrees.
    """

    gesture: Gesture
    fingers: tuple[str, str, str, str]
    thumbs: tuple[str, ...]
    spread: tuple[float, float] = _ANY


def _hold(
    gesture: Gesture, letters: str, *thumbs: str, spread: tuple[float, float] = _ANY
) -> Hold:
    words = {"s": "straight", "b": "bent", "h": "half", "k": "hook", "r": "ring"}
    index, middle, ring, little = (words[letter] for letter in letters)
    return Hold(gesture, (index, middle, ring, little), thumbs, spread)


_NONE = Gesture.NONE
#: Fingers as s(traight), b(ent), h(alf), hoo(k) or r(ing), from the index on.
HOLDS = {
    "palm": _hold(Gesture.PALM, "ssss", "open", "along"),
    "fist": _hold(Gesture.FIST, "bbbb", "folded", "beside"),
    "point": _hold(Gesture.POINT, "sbbb", "folded", "beside"),
    "victory": _hold(Gesture.VICTORY, "ssbb", "folded", "beside", spread=_APART),
    "thumb": _hold(Gesture.THUMB_UP, "bbbb", "up"),
    "call": _hold(_NONE, "bbbs", "up", "open"),
    "ok": _hold(_NONE, "rsss", "touching"),
    "pinch": _hold(_NONE, "rhhh", "touching"),
    "four": _hold(_NONE, "ssss", "folded"),
    "three": _hold(_NONE, "sssb", "folded", "touching"),
    "three with thumb": _hold(_NONE, "ssbb", "open", "up"),
    "two together": _hold(_NONE, "ssbb", "folded", "beside", spread=_TOGETHER),
    "rock": _hold(_NONE, "sbbs", "folded", "up"),
    "gun": _hold(_NONE, "sbbb", "open", "up"),
    "middle": _hold(_NONE, "bsbb", "folded", "beside"),
    "little": _hold(_NONE, "bbbs", "folded", "beside"),
    "relaxed": _hold(_NONE, "hhhh", "along", "open", "beside", "opposed"),
    "cup": _hold(_NONE, "hhhh", "opposed", "open"),
    "claw": _hold(_NONE, "kkkk", "open", "along"),
}
#: Of hands that say nothing, so many have fingers that are bent in any way.
ANYHOW = "anyhow"


class DrawnHands(NamedTuple):
    """N hands as a camera sees them.

    Attributes:
        landmarks_px: Shape (N, 21, 2): x to the right, y down.
        is_right: Shape (N,), as 0 or 1.
        gesture: Shape (N,), of `Gesture`.
    """

    landmarks_px: FloatArray
    is_right: FloatArray
    gesture: IntArray


def hold_pose(name: str, count: int, rng: np.random.Generator) -> HandPose:
    """Joints of so many hands held in one way, by its name in `HOLDS`, or `ANYHOW`."""
    common = rng.uniform(size=(count, 1))

    def between(bounds: tuple[float, float], shape: tuple[int, ...]) -> FloatArray:
        # Fingers of one hand are alike.
        share = rng.uniform(size=shape)
        share = (share + common.reshape(-1, *([1] * (len(shape) - 1)))) / 2.0
        return np.radians(bounds[0] + (bounds[1] - bounds[0]) * share)

    bend = np.zeros((count, 4, 3))
    if name == ANYHOW:
        bend[:, :, 0] = np.radians(rng.uniform(-10.0, 90.0, (count, 4)))
        bend[:, :, 1] = np.radians(rng.uniform(0.0, 110.0, (count, 4)))
        for finger in rng.permuted(np.tile(np.arange(4), (count, 1)), axis=1)[:, :2].T:
            rows = np.arange(count)  # two at least are half bent: the rest may be a sign
            for joint in (0, 1):
                low, high = np.radians(_FINGERS["half"][joint])
                bend[rows, finger, joint] = rng.uniform(low, high, count)
        kinds, spread = tuple(_THUMBS), _ANY
    else:
        hold = HOLDS[name]
        for finger, state in enumerate(hold.fingers):
            for joint in (0, 1):
                bend[:, finger, joint] = between(_FINGERS[state][joint], (count,))
        kinds, spread = hold.thumbs, hold.spread
    bend[:, :, 2] = rng.uniform(*_END_SHARE, (count, 4)) * bend[:, :, 1]
    apart = np.radians(rng.uniform(*spread, (count, 1)))
    # The middle finger goes against the index, so that a "V" opens; ring and little the other way.
    fan = apart * np.array([1.0, -0.4, -0.4, -1.0]) + rng.normal(0.0, 0.02, (count, 4))
    ranges = np.radians([_THUMBS[kind] for kind in kinds])[rng.integers(len(kinds), size=count)]
    thumb = ranges[..., 0] + (ranges[..., 1] - ranges[..., 0]) * rng.uniform(size=(count, 4))
    return HandPose(bend, fan, thumb)


def draw_hands(
    name: str,
    count: int,
    rng: np.random.Generator,
    *,
    turn_max_deg: float = 30.0,
    size_px: tuple[float, float] = (40.0, 200.0),
    noise: tuple[float, float] = (0.01, 0.03),
    edge_on: bool = False,
) -> DrawnHands:
    """Left and right hands held in one way, by palm or back, as landmark models would read them.

    Args:
        name: In `HOLDS`, or `ANYHOW`. Of "thumb" the thumb points up or down in the picture; the
            others point up, within 60 degrees.
        count: How many.
        rng: Source of all spread.
        turn_max_deg: Tilt about both axes of the picture.
        size_px: Range of the length of the open hand.
        noise: Range of the landmarks' error, as standard deviation in hand lengths.
        edge_on: Seen from the side of thumb or little finger, within 25 degrees, where a hand
            says nothing, unless it is a fist: a finger before the lips is held so.
    """
    stretch = rng.normal(1.0, 0.05, (count, 1)) * rng.normal(1.0, 0.04, (count, 20))
    pose = hold_pose(name, count, rng)
    points = hand_points(pose, stretch)
    gesture = np.full(count, HOLDS[name].gesture if name in HOLDS else _NONE)
    tilt = np.radians(turn_max_deg)
    pitch, yaw = rng.uniform(-tilt, tilt, (2, count))
    if edge_on:
        gesture[:] = Gesture.FIST if name == "fist" else _NONE
        yaw = np.radians(rng.uniform(65.0, 115.0, count))
    yaw = yaw + np.pi * rng.integers(2, size=count)
    seen = _turned(_turned(points, yaw, 0, 2), pitch, 1, 2)
    if name == "thumb":
        is_up = rng.integers(2, size=count) == 1
        gesture = np.where(is_up, Gesture.THUMB_UP, Gesture.THUMB_DOWN)
        thumb = seen[:, 4] - seen[:, 2]
        upright = np.pi / 2 - np.arctan2(thumb[:, 1], thumb[:, 0])
        turn = upright + np.where(is_up, 0.0, np.pi) + rng.uniform(-tilt, tilt, count)
    else:
        turn = np.radians(rng.uniform(-60.0, 60.0, count))
    seen = _turned(seen, turn, 0, 1)
    far = rng.uniform(2.5, 20.0, (count, 1))  # from the camera, in hand lengths
    flat = seen[..., :2] * (far / (far - seen[..., 2]))[..., None]
    flat = flat + _errors(pose, noise, rng)
    is_right = rng.integers(2, size=count)
    flat[..., 0] *= np.where(is_right == 1, 1.0, -1.0)[:, None]
    shortest_px, longest_px = size_px
    long_px = np.exp(rng.uniform(np.log(shortest_px), np.log(longest_px), (count, 1, 1)))
    pixels = flat * np.array([1.0, -1.0]) * long_px
    pixels = pixels + rng.normal(0.0, 0.5, pixels.shape)
    return DrawnHands(pixels, is_right.astype(np.float64), gesture.astype(np.int64))


def _turned(points: FloatArray, angle: FloatArray, first: int, second: int) -> FloatArray:
    """Points of shape (N, 21, 3), turned from one axis toward another."""
    cos, sin = np.cos(angle)[:, None], np.sin(angle)[:, None]
    turned = points.copy()
    turned[..., first] = cos * points[..., first] - sin * points[..., second]
    turned[..., second] = sin * points[..., first] + cos * points[..., second]
    return np.asarray(turned)


def _errors(pose: HandPose, noise: tuple[float, float], rng: np.random.Generator) -> FloatArray:
    """Shape (N, 21, 2), in hand lengths: of each point, of fingers as a whole, of hidden ends."""
    count = len(pose.bend)
    low, high = noise
    std = rng.uniform(low, high, (count, 1, 1))
    errors = std * rng.normal(size=(count, 21, 2))
    errors[:, 1:] += std * np.repeat(rng.normal(size=(count, 5, 2)), 4, axis=1)
    hidden = np.clip(pose.bend.sum(axis=-1) / np.pi, 0.0, 1.0)  # (N, 4): bent into the hand
    for finger in range(4):
        ends = slice(7 + 4 * finger, 9 + 4 * finger)
        errors[:, ends] += std * hidden[:, finger, None, None] * rng.normal(size=(count, 2, 2))
    return np.asarray(errors)
