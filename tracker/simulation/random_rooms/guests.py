"""How do guests of a room drawn at random walk, stand, and raise their hands?"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from tracker.containers import FloatArray
from tracker.simulation.scene import ARM_MOTION_S

#: The robot stands at the map's origin and looks along x; people are so far ahead of it ...
_X_FROM_M, _X_UNTIL_M = 1.8, 6.5
#: ... and so far to the side, per meter ahead: a little beyond what the camera sees.
_SIDEWAYS = 0.75
#: Nobody walks closer past somebody, or past a table's middle.
_KEPT_APART_M = 0.6
#: Steps in which paths are held against each other.
_STRIDE_S = 0.2
_TRIES = 40
_SPEED_MPS = 1.0


class Visit(NamedTuple):
    """Who comes, for how long, and what they do.

    Attributes:
        people: How many.
        duration_s: How long.
        rate_hz: Of camera and laser.
        sitting_share: How many of them sit all the time, on average, while there are seats.
        pause_s: Mean of the (exponentially distributed) stops of those who walk.
        hand_up_s: How long a hand stays up, from and to.
        hand_down_s: How long it stays down, from and to.
    """

    people: int
    duration_s: float
    rate_hz: float
    sitting_share: float
    pause_s: float
    hand_up_s: tuple[float, float]
    hand_down_s: tuple[float, float]

    @property
    def stamps_s(self) -> FloatArray:
        """Shape (T,): when paths are held against each other."""
        return np.arange(0.0, self.duration_s + _STRIDE_S, _STRIDE_S)

    @property
    def sensors(self) -> dict[str, Any]:
        """How long and how often sensors look, as a scene file has it."""
        rate = {"rate_hz": self.rate_hz}
        return {"duration_s": self.duration_s, "camera": rate, "laser": rate}


def draw_place(rng: np.random.Generator) -> FloatArray:
    """Somewhere in front of the robot, shape (2,)."""
    x = rng.uniform(_X_FROM_M, _X_UNTIL_M)
    return np.array([x, rng.uniform(-1.0, 1.0) * _SIDEWAYS * x])


def draw_apart(rng: np.random.Generator, count: int, apart_m: float) -> list[FloatArray]:
    """Places that keep a distance from each other, where there is room for that."""
    places: list[FloatArray] = []
    for _ in range(count):
        candidates = [draw_place(rng) for _ in range(_TRIES)]
        roomy = [place for place in candidates if _room_to(place, places) >= apart_m]
        places.append((roomy or candidates)[0])
    return places


def draw_guest(
    rng: np.random.Generator,
    path: list[dict[str, float]],
    visit: Visit,
) -> dict[str, Any]:
    """Somebody on a path, as a scene file has it but for the id: build, hand and raises."""
    return {
        "path": path,
        "hand": str(rng.choice(["left", "right"])),
        "look": {"stature_m": float(rng.uniform(1.6, 1.9))},
        "raises": _draw_raises(rng, visit),
    }


def draw_walk(
    rng: np.random.Generator, stamps_s: FloatArray, others: FloatArray, pause_s: float
) -> tuple[list[float], FloatArray]:
    """Times and places of somebody who stops, goes on, and keeps away from all others.

    Args:
        rng: All randomness.
        stamps_s: Shape (T,).
        others: Shape (T, O, 2): where they are.
        pause_s: Mean of the stops.
    """
    starts = [draw_place(rng) for _ in range(_TRIES)]
    places = [max(starts, key=lambda place: _clearance(others[:1], place[None]))]
    times = [0.0]
    while times[-1] < stamps_s[-1]:
        best, best_clearance = None, -np.inf
        for _ in range(_TRIES):
            leave_s = times[-1] + rng.exponential(pause_s)
            place = draw_place(rng)
            walk_s = float(np.linalg.norm(place - places[-1])) / _SPEED_MPS
            leave_and_arrive_s = [leave_s, leave_s + walk_s]
            leg = ([times[-1], *leave_and_arrive_s], np.array([places[-1], places[-1], place]))
            during = (stamps_s >= times[-1]) & (stamps_s <= leave_s + walk_s)
            clearance = _clearance(others[during], along_path(stamps_s[during], *leg))
            if clearance > best_clearance:
                best, best_clearance = leg, clearance
            if clearance >= _KEPT_APART_M:
                break
        assert best is not None
        times += best[0][1:]
        places += list(best[1][1:])
    return times, np.array(places)


def path_of(times_s: list[float], places: FloatArray) -> list[dict[str, float]]:
    """Places reached at given times, as a scene file has them."""
    return [
        {"at_s": at_s, "x_m": x, "y_m": y}
        for at_s, (x, y) in zip(times_s, places.tolist(), strict=True)
    ]


def along_path(stamps_s: FloatArray, times_s: list[float], places: FloatArray) -> FloatArray:
    """Where somebody is at some stamps, shape (T, 2), between places reached at given times."""
    columns = [np.interp(stamps_s, times_s, places[:, axis]) for axis in (0, 1)]
    return np.stack(columns, axis=-1)


def _room_to(place: FloatArray, others: list[FloatArray]) -> float:
    return min((float(np.linalg.norm(place - other)) for other in others), default=np.inf)


def _clearance(others: FloatArray, path: FloatArray) -> float:
    distance = np.linalg.norm(others - path[:, None], axis=-1)
    return float(distance.min(initial=np.inf))


def _draw_raises(rng: np.random.Generator, visit: Visit) -> list[dict[str, float]]:
    raises = []
    # Down at first, for part of a pause, so that not everybody calls at once.
    at_s = ARM_MOTION_S + rng.uniform(0.0, visit.hand_down_s[0])
    while at_s < visit.duration_s:
        until_s = at_s + rng.uniform(*visit.hand_up_s)
        raises.append({"from_s": at_s, "until_s": until_s})
        at_s = until_s + rng.uniform(*visit.hand_down_s)
    return raises
