"""The gesture of one hand over time: filtered signs, and movement (wave, come, stop).

- wave: an open, upright hand goes to and fro sideways, there and back and there again; a hand that
  calls may take its time for it;
- come: the fingers of a hand that stays in its place stretch and bend again and again;
- stop: an open palm is held still before the camera, by a hand that does not call.

Times and ways are guesses at what people do.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np

from tracker.containers import FloatArray
from tracker.gesture import Gesture

#: A sign is named from this probability on.
SURE = 0.8
#: What is believed of a hand that was never seen, by `model.SIGNS`: about the shares of the drawn
#: hands.
PRIOR = np.array([4.0, 1.0, 1.0, 1.0, 1.0, 0.5, 0.5]) / 9.0
#: How fast a belief fades to that; images of one hand are alike, and each adds this share of its
#: evidence; none is surer than this.
_FADE_S, _IMAGE_SHARE, _DOUBT = 2.0, 0.5, 0.01
#: So long a time is looked back upon, for each; a wave overhead takes up to three seconds.
_WAVE_S, _SLOW_WAVE_S, _COME_S, _STOP_S = 1.5, 4.0, 3.0, 0.8
#: Shorter ways than this are noise, in hand lengths; there, back and there again is a wave.
_WAVE_STEP, _WAVE_TURNS = 0.3, 2
#: An open hand, in the mean of the last images: `finger_stretch`.
_OPEN = 0.35
#: The share of the images in which a hand that waves slowly must call.
_CALLS = 0.7
#: Between two turns a hand that waves or beckons still does.
_HOLD_S = 1.0
#: Fingers that bend and stretch change by so much of `finger_stretch`; so often they turn.
_COME_STEP, _COME_TURNS = 0.8, 4
#: A hand that beckons, or says stop, keeps its place within so many hand lengths.
_COME_STILL, _STOP_STILL = 1.0, 0.25
#: So much of the palm is seen: `palm_faces`.
_FACES = 0.35


class Look(NamedTuple):
    """What one image shows of a hand.

    Attributes:
        stamp_ns: When.
        wrist_px: Place in the picture, shape (2,).
        tip_px: Of the middle finger, likewise; NaN where only the wrist was seen.
        size_px: Length of the open hand.
        stretch: Of the four fingers, -1 to 1; NaN likewise.
        upright: The fingers point up.
        faces: How much of the palm the camera sees; below 0 it is the back.
        raised: The hand calls, by the detector's verdict.
    """

    stamp_ns: int
    wrist_px: FloatArray
    tip_px: FloatArray
    size_px: float
    stretch: float
    upright: bool
    faces: float
    raised: bool


@dataclass(slots=True)
class SigningHand:
    """One hand and what it said.

    Attributes:
        belief: Shape (7,): probability of each of `model.SIGNS`.
        looks: Of the last seconds.
        moves: What its movement said last ...
        moved_ns: ... and when.
    """

    belief: FloatArray = field(default_factory=PRIOR.copy)
    looks: list[Look] = field(default_factory=list)
    moves: Gesture = Gesture.NONE
    moved_ns: int = -(10**18)

    def see(self, look: Look, chances: FloatArray) -> Gesture:
        """What the hand says after one more image.

        Args:
            look: Of this image.
            chances: Shape (7,): of each sign, by this image alone; NaN where it tells nothing.
        """
        passed_s = (look.stamp_ns - self.looks[-1].stamp_ns) / 1e9 if self.looks else 0.0
        self.belief = update_signs(self.belief, passed_s, chances)
        self.looks = [*self._last(_SLOW_WAVE_S, look.stamp_ns), look]
        if self._waves() or self._beckons():
            self.moves = Gesture.WAVE if self._waves() else Gesture.COME
            self.moved_ns = look.stamp_ns
        if look.stamp_ns - self.moved_ns <= _HOLD_S * 1e9:
            return self.moves
        best = int(self.belief.argmax())
        if self.belief[best] < SURE:
            return Gesture.NONE
        return Gesture.STOP if best == Gesture.PALM and self._stops() else Gesture(best)

    def _waves(self) -> bool:
        looks = self._last(_SLOW_WAVE_S)
        if _mean([float(item.raised) for item in looks], 0.0) < _CALLS:
            looks = self._last(_WAVE_S)
        open_hand = _mean([item.stretch for item in looks], 1.0)
        upright = _mean([float(item.upright) for item in looks], 0.0)
        if open_hand < _OPEN or upright < 0.5:
            return False
        step_px = _WAVE_STEP * _size_px(looks)
        ways = ([item.wrist_px[0] for item in looks], [item.tip_px[0] for item in looks])
        return any(count_turns(way, step_px) >= _WAVE_TURNS for way in ways)

    def _beckons(self) -> bool:
        looks = self._last(_COME_S)
        turns = count_turns([item.stretch for item in looks], _COME_STEP)
        return turns >= _COME_TURNS and _extent(looks) <= _COME_STILL

    def _stops(self) -> bool:
        looks = self._last(_STOP_S)
        lasts_s = (looks[-1].stamp_ns - self.looks[0].stamp_ns) / 1e9
        faces = min(item.faces for item in looks) >= _FACES
        calls = any(item.raised for item in looks)
        return lasts_s >= _STOP_S and faces and not calls and _extent(looks) <= _STOP_STILL

    def _last(self, time_s: float, now_ns: int | None = None) -> list[Look]:
        now_ns = self.looks[-1].stamp_ns if now_ns is None else now_ns
        since_ns = now_ns - int(time_s * 1e9)
        return [item for item in self.looks if item.stamp_ns >= since_ns]


def update_signs(before: FloatArray, passed_s: float, chances: FloatArray) -> FloatArray:
    """The probability of each sign, shape (7,), after one more image: a filter of seven states.

        b' = prior + (b - prior) exp(-dt / tau);   b ~ b' (chances / prior)^share

    Args:
        before: Shape (7,).
        passed_s: Since then.
        chances: Shape (7,): by this image alone; NaN where it tells nothing.
    """
    faded = PRIOR + (before - PRIOR) * np.exp(-passed_s / _FADE_S)
    if not np.isfinite(chances).all():
        return np.asarray(faded)
    belief = faded * (np.maximum(chances, _DOUBT) / PRIOR) ** _IMAGE_SHARE
    return np.asarray(belief / belief.sum())


def count_turns(values: Sequence[float], step: float) -> int:
    """How often a sequence turns around; ways shorter than `step` and NaN are passed over."""
    known = [value for value in values if value == value]
    turns, direction, farthest = 0, 0, known[0] if known else 0.0
    for value in known:
        way = value - farthest
        if direction == 0 and abs(way) < step:
            continue
        if way * direction >= 0:
            direction, farthest = direction or int(np.sign(way)), value
        elif abs(way) >= step:
            turns, direction, farthest = turns + 1, -direction, value
    return turns


def _extent(looks: Sequence[Look]) -> float:
    """How far the wrist goes, in hand lengths, in the wider direction."""
    way_px = np.ptp([item.wrist_px for item in looks], axis=0).max()
    return float(way_px / _size_px(looks))


def _size_px(looks: Sequence[Look]) -> float:
    """How long the hand is: hands that turn away only seem short."""
    return max(item.size_px for item in looks)


def _mean(values: Sequence[float], unknown: float) -> float:
    known = [value for value in values if value == value]
    return sum(known) / len(known) if known else unknown
