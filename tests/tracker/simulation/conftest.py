from copy import deepcopy

import pytest

from tracker.simulation import scene_from_mapping

#: Small pictures keep the tests fast; one guest walks, one sits and raises the left hand.
ROOM = {
    "duration_s": 2.0,
    "map_from_odom": {"x_m": 0.5, "y_m": -0.3, "yaw_deg": 20.0},
    "robot": {
        "path": [
            {"at_s": 0.0, "x_m": 0.0, "y_m": 0.0, "yaw_deg": 0.0},
            {"at_s": 2.0, "x_m": 0.4, "y_m": 0.2, "yaw_deg": 30.0},
        ]
    },
    "camera": {"width": 160, "height": 120, "fx": 115.0, "fy": 115.0, "cx": 80.0, "cy": 60.0},
    "laser": {"x_m": 0.1, "y_m": 0.05, "yaw_deg": 90.0, "first_beam_deg": 0.0},
    "walls": [{"corners_m": [[-2, -3], [5, -3], [5, 3], [-2, 3]], "closed": True}],
    "tables": [{"x_m": 3.5, "y_m": 1.0, "yaw_deg": 10.0}],
    "people": [
        {
            "id": 4,
            "path": [{"at_s": 0.0, "x_m": 2.0, "y_m": 0.4}, {"at_s": 2.0, "x_m": 2.0, "y_m": 1.4}],
        },
        {
            "id": 9,
            "hand": "left",
            "seat_m": 0.5,
            "path": [{"x_m": 1.5, "y_m": -0.2}],
            "raises": [{"from_s": 0.5, "until_s": 1.2}],
        },
    ],
}


@pytest.fixture
def room():
    """The scene file of a small room as nested dictionaries, to be changed at will."""
    return deepcopy(ROOM)


@pytest.fixture
def scene(room):
    """The small room."""
    return scene_from_mapping(room)
