"""Who sits, stands and walks in a bistro drawn at random, full of furniture?

Tables with one, two and four posts, chairs with somebody on them and without, a bar with stools.
Guests who sit have their shins under the table; some of those who stand do so close together.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from tracker.containers import FloatArray
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
_BAR = [[7.3, -2.0], [7.3, 2.0]]
_STOOL_X_M = 6.9
_TABLES = (3, 5)
_TABLES_APART_M = 2.1
_ROUND_M, _LENGTH_M, _WIDTH_M = 0.75, 1.3, 0.75
#: From a table's edge to the middle of a chair.
_CHAIR_TO_EDGE_M = 0.25
#: How much a chair that nobody sits on was moved, and turned (guesses).
_MOVED_M, _TURNED_DEG = 0.1, 25.0
#: How far the shins are in front of the body: from upright to leaning back (guess).
_SHINS_M = (0.1, 0.35)
#: Of those who walk, this share goes with the one before, at arm's length (guesses).
_TOGETHER_SHARE, _TOGETHER_M = 0.4, (0.4, 0.6)


def draw_bistro(rng: np.random.Generator, visit: Visit) -> Scene:
    """Furnish a room and let people in; they walk around each other and around the furniture.

    Args:
        rng: All randomness.
        visit: Who comes.
    """
    stamps_s = visit.stamps_s
    count = int(rng.integers(_TABLES[0], _TABLES[1] + 1))
    tables = [_draw_table(rng, place) for place in draw_apart(rng, count, _TABLES_APART_M)]
    seats = [seat for table in tables for seat in _draw_seats(rng, table)]
    seats = [seats[row] for row in rng.permutation(len(seats))]
    sitting = min(
        int(np.count_nonzero(rng.random(visit.people) < visit.sitting_share)), len(seats)
    )
    still = [(thing["x_m"], thing["y_m"]) for thing in (*tables, *seats)]
    obstacles = [np.broadcast_to(place, (len(stamps_s), 2)) for place in still]
    guests: list[dict[str, Any]] = []
    for seat in seats[:sitting]:
        path = [{"x_m": seat["x_m"], "y_m": seat["y_m"], "facing_deg": seat["yaw_deg"]}]
        guest = draw_guest(rng, path, visit)
        guests.append(
            guest | {"seat_m": 0.45, "stool": False, "shins_m": float(rng.uniform(*_SHINS_M))}
        )
    times_s, places = [0.0], np.zeros((1, 2))
    for number in range(visit.people - sitting):
        if number and rng.random() < _TOGETHER_SHARE:
            aside = rng.uniform(-np.pi, np.pi)
            toward = np.array([np.cos(aside), np.sin(aside)])
            places = places + rng.uniform(*_TOGETHER_M) * toward
        else:
            times_s, places = draw_walk(rng, stamps_s, np.stack(obstacles, axis=1), visit.pause_s)
        path = path_of(times_s, places)
        guests.append(draw_guest(rng, path, visit))
        obstacles.append(along_path(stamps_s, times_s, places))
    empty = [_moved(rng, seat) for seat in seats[sitting:]]
    stools = [
        {"kind": "bar_stool", "x_m": _STOOL_X_M, "y_m": float(y)}
        for y in np.linspace(-1.5, 1.5, int(rng.integers(2, 5)))
    ]
    return scene_from_mapping(
        {
            **visit.sensors,
            "walls": [
                {"corners_m": _ROOM, "closed": True},
                {"corners_m": _BAR, "height_m": 1.1},
            ],
            "tables": tables,
            "chairs": [*seats[:sitting], *empty, *stools],
            "people": [guest | {"id": number + 1} for number, guest in enumerate(guests)],
        },
        origin="random bistro",
    )


def _draw_table(rng: np.random.Generator, place: FloatArray) -> dict[str, Any]:
    posts = int(rng.choice([1, 2, 4]))
    size = (_ROUND_M, _ROUND_M) if posts == 1 else (_LENGTH_M, _WIDTH_M)
    return {
        "x_m": float(place[0]),
        "y_m": float(place[1]),
        "yaw_deg": float(rng.uniform(0.0, 90.0)),
        "length_m": size[0],
        "width_m": size[1],
        "round": posts == 1,
        "posts": posts,
    }


def _draw_seats(rng: np.random.Generator, table: dict[str, Any]) -> list[dict[str, Any]]:
    """Two to four chairs that face the table, at different sides of it."""
    seats = []
    for side in rng.permutation(4)[: int(rng.integers(2, 5))].tolist():
        across_m = (table["length_m"] if side % 2 == 0 else table["width_m"]) / 2
        way = np.radians(table["yaw_deg"] + 90.0 * side)
        away_m = across_m + _CHAIR_TO_EDGE_M
        seats.append(
            {
                "x_m": float(table["x_m"] + away_m * np.cos(way)),
                "y_m": float(table["y_m"] + away_m * np.sin(way)),
                "yaw_deg": float(np.degrees(way)) - 180.0,
            }
        )
    return seats


def _moved(rng: np.random.Generator, seat: dict[str, Any]) -> dict[str, Any]:
    dx, dy = rng.normal(0.0, _MOVED_M, 2).tolist()
    turned_deg = float(rng.normal(0.0, _TURNED_DEG))
    return {
        "x_m": seat["x_m"] + dx,
        "y_m": seat["y_m"] + dy,
        "yaw_deg": seat["yaw_deg"] + turned_deg,
    }
