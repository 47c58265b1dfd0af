"""Who sits, stands and walks in a restaurant drawn at random, and when do they raise a hand?"""

from __future__ import annotations

from typing import Any

import numpy as np

from tracker.containers import FloatArray
from tracker.simulation.scene import ARM_MOTION_S, Scene, scene_from_mapping

#: The room; the robot stands at the map's origin and looks along x.
_ROOM = [[-1.0, -6.0], [8.0, -6.0], [8.0, 6.0], [-1.0, 6.0]]
_X_FROM_M, _X_UNTIL_M = 1.8, 6.5
#: How far to the side, per meter ahead: a little beyond what the camera sees.
_SIDEWAYS = 0.75
_TABLES = 3
_TABLES_APART_M = 1.7
_SEAT_TO_TABLE_M = 0.55
#: Nobody walks closer past somebody, or past a table's middle.
_KEPT_APART_M = 0.6
_STRIDE_S = 0.2  # steps in which paths are held against each other
_TRIES = 40
_SPEED_MPS = 1.0


def draw_restaurant(
    rng: np.random.Generator,
    *,
    people: int,
    duration_s: float,
    rate_hz: float,
    sitting_share: float,
    pause_s: float,
    hand_up_s: tuple[float, float],
    hand_down_s: tuple[float, float],
) -> Scene:
    """Furnish a room and let people in; they walk around each other and around the tables.

    Args:
        rng: All randomness.
        people: How many.
        duration_s: How long.
        rate_hz: Of camera and laser.
        sitting_share: How many of them sit at a table all the time, on average.
        pause_s: Mean of the (exponentially distributed) stops of those who walk.
        hand_up_s: How long a hand stays up, from and to.
        hand_down_s: How long it stays down, from and to.
    """
    stamps_s = np.arange(0.0, duration_s + _STRIDE_S, _STRIDE_S)
    tables = _draw_tables(rng)
    seats = [(table, side) for table in tables for side in (0.0, np.pi / 2, np.pi, -np.pi / 2)]
    free_seats = [seats[row] for row in rng.permutation(len(seats))]
    obstacles = [np.broadcast_to(table, (len(stamps_s), 2)) for table in tables]
    guests: list[dict[str, Any]] = []
    is_sitting = rng.random(people) < sitting_share
    for sits in sorted(is_sitting.tolist(), reverse=True):  # who walks makes way for who sits
        if sits:
            table, side = free_seats.pop()
            place = table + _SEAT_TO_TABLE_M * np.array([np.cos(side), np.sin(side)])
            facing = float(np.degrees(side)) + 180.0
            path = [{"x_m": place[0], "y_m": place[1], "facing_deg": facing}]
            obstacles.append(np.broadcast_to(place, (len(stamps_s), 2)))
        else:
            times_s, places = _draw_walk(rng, stamps_s, np.stack(obstacles, axis=1), pause_s)
            path = [
                {"at_s": at_s, "x_m": x, "y_m": y}
                for at_s, (x, y) in zip(times_s, places.tolist(), strict=True)
            ]
            obstacles.append(_along(stamps_s, times_s, places))
        guests.append(
            {
                "id": len(guests) + 1,
                "path": path,
                "seat_m": 0.45 if sits else None,
                "hand": str(rng.choice(["left", "right"])),
                "look": {"stature_m": float(rng.uniform(1.6, 1.9))},
                "raises": _draw_raises(rng, duration_s, hand_up_s, hand_down_s),
            }
        )
    return scene_from_mapping(
        {
            "duration_s": duration_s,
            "camera": {"rate_hz": rate_hz},
            "laser": {"rate_hz": rate_hz},
            "walls": [{"corners_m": _ROOM, "closed": True}],
            "tables": [
                {
                    "x_m": float(x),
                    "y_m": float(y),
                    "yaw_deg": float(rng.uniform(0.0, 90.0)),
                    "posts": int(rng.choice([1, 4])),
                }
                for x, y in tables
            ],
            "people": guests,
        },
        origin="random restaurant",
    )


def draw_place(rng: np.random.Generator) -> FloatArray:
    """Somewhere in front of the robot, shape (2,)."""
    x = rng.uniform(_X_FROM_M, _X_UNTIL_M)
    return np.array([x, rng.uniform(-1.0, 1.0) * _SIDEWAYS * x])


def _draw_tables(rng: np.random.Generator) -> list[FloatArray]:
    tables: list[FloatArray] = []
    for _ in range(_TABLES):
        candidates = [draw_place(rng) for _ in range(_TRIES)]
        roomy = [place for place in candidates if _room_to(place, tables) >= _TABLES_APART_M]
        tables.append((roomy or candidates)[0])
    return tables


def _room_to(place: FloatArray, others: list[FloatArray]) -> float:
    return min((float(np.linalg.norm(place - other)) for other in others), default=np.inf)


def _draw_walk(
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
            clearance = _clearance(others[during], _along(stamps_s[during], *leg))
            if clearance > best_clearance:
                best, best_clearance = leg, clearance
            if clearance >= _KEPT_APART_M:
                break
        assert best is not None
        times += best[0][1:]
        places += list(best[1][1:])
    return times, np.array(places)


def _clearance(others: FloatArray, path: FloatArray) -> float:
    distance = np.linalg.norm(others - path[:, None], axis=-1)
    return float(distance.min(initial=np.inf))


def _along(stamps_s: FloatArray, times_s: list[float], places: FloatArray) -> FloatArray:
    columns = [np.interp(stamps_s, times_s, places[:, axis]) for axis in (0, 1)]
    return np.stack(columns, axis=-1)


def _draw_raises(
    rng: np.random.Generator,
    duration_s: float,
    hand_up_s: tuple[float, float],
    hand_down_s: tuple[float, float],
) -> list[dict[str, float]]:
    raises = []
    # Down at first, for part of a pause, so that not everybody calls at once.
    at_s = ARM_MOTION_S + rng.uniform(0.0, hand_down_s[0])
    while at_s < duration_s:
        until_s = at_s + rng.uniform(*hand_up_s)
        raises.append({"from_s": at_s, "until_s": until_s})
        at_s = until_s + rng.uniform(*hand_down_s)
    return raises
