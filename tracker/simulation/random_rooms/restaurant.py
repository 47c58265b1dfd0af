"""Who sits, stands and walks in a restaurant drawn at random, and when do they raise a hand?"""

from __future__ import annotations

from typing import Any

import numpy as np

from tracker.simulation.random_rooms.guests import (
    Visit,
    along_path,
    draw_apart,
    draw_guest,
    draw_walk,
    path_of,
)
from tracker.simulation.scene import Scene, scene_from_mapping

_ROOM = [[-1.0, -6.0], [8.0, -6.0], [8.0, 6.0], [-1.0, 6.0]]
_TABLES = 3
_TABLES_APART_M = 1.7
_SEAT_TO_TABLE_M = 0.55


def draw_restaurant(rng: np.random.Generator, visit: Visit) -> Scene:
    """Furnish a room and let people in; they walk around each other and around the tables.

    Args:
        rng: All randomness.
        visit: Who comes.
    """
    stamps_s = visit.stamps_s
    tables = draw_apart(rng, _TABLES, _TABLES_APART_M)
    seats = [(table, side) for table in tables for side in (0.0, np.pi / 2, np.pi, -np.pi / 2)]
    free_seats = [seats[row] for row in rng.permutation(len(seats))]
    obstacles = [np.broadcast_to(table, (len(stamps_s), 2)) for table in tables]
    guests: list[dict[str, Any]] = []
    is_sitting = rng.random(visit.people) < visit.sitting_share
    for sits in sorted(is_sitting.tolist(), reverse=True):  # who walks makes way for who sits
        if sits:
            table, side = free_seats.pop()
            place = table + _SEAT_TO_TABLE_M * np.array([np.cos(side), np.sin(side)])
            facing = float(np.degrees(side)) + 180.0
            path = [{"x_m": place[0], "y_m": place[1], "facing_deg": facing}]
            obstacles.append(np.broadcast_to(place, (len(stamps_s), 2)))
        else:
            times_s, places = draw_walk(rng, stamps_s, np.stack(obstacles, axis=1), visit.pause_s)
            path = path_of(times_s, places)
            obstacles.append(along_path(stamps_s, times_s, places))
        guest = draw_guest(rng, path, visit)
        guests.append(guest | {"id": len(guests) + 1, "seat_m": 0.45 if sits else None})
    return scene_from_mapping(
        {
            **visit.sensors,
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
