"""Who sits, stands and walks in a restaurant drawn at random, and when do they raise a hand?"""

from __future__ import annotations

from typing import Any

import numpy as np

from tracker.simulation.random_rooms.guests import (
    STRIDE_S,
    along_path,
    draw_apart,
    draw_guest,
    draw_walk,
)
from tracker.simulation.scene import Scene, scene_from_mapping

_ROOM = [[-1.0, -6.0], [8.0, -6.0], [8.0, 6.0], [-1.0, 6.0]]
_TABLES = 3
_TABLES_APART_M = 1.7
_SEAT_TO_TABLE_M = 0.55


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
    stamps_s = np.arange(0.0, duration_s + STRIDE_S, STRIDE_S)
    tables = draw_apart(rng, _TABLES, _TABLES_APART_M)
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
            times_s, places = draw_walk(rng, stamps_s, np.stack(obstacles, axis=1), pause_s)
            path = [
                {"at_s": at_s, "x_m": x, "y_m": y}
                for at_s, (x, y) in zip(times_s, places.tolist(), strict=True)
            ]
            obstacles.append(along_path(stamps_s, times_s, places))
        guest = draw_guest(rng, path, duration_s, hand_up_s, hand_down_s)
        guests.append(guest | {"id": len(guests) + 1, "seat_m": 0.45 if sits else None})
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
