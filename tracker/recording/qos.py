"""With which quality of service does a recorded topic replay? As rosbag2 writes it down."""

from __future__ import annotations

import yaml

from tracker.config import NODE_NAME

#: Topics that a late subscriber must still get, and how many of their last messages. /tf_static
#: may come in many pieces; 100 is what tf2's own listener keeps.
LATCHED = {
    "/tf_static": 100,
    "/map": 1,
    "/hand_raised": 1,
    f"/{NODE_NAME}/raised_hands": 1,
    f"/{NODE_NAME}/waiting_list": 1,
}

# rmw's numbers: keep last, reliable, transient local or volatile, automatic.
_KEEP_LAST, _RELIABLE, _TRANSIENT_LOCAL, _VOLATILE, _AUTOMATIC = 1, 1, 1, 2, 1


def offered_qos(topic: str) -> str:
    """The profile a topic was offered with, as rosbag2's YAML (metadata up to version 8).

    Reliable, which every subscriber can hear, and latched where that is the topic's custom.
    """
    return yaml.safe_dump(
        [
            {
                "history": _KEEP_LAST,
                "depth": LATCHED.get(topic, 10),
                "reliability": _RELIABLE,
                "durability": _TRANSIENT_LOCAL if topic in LATCHED else _VOLATILE,
                "deadline": _forever(),
                "lifespan": _forever(),
                "liveliness": _AUTOMATIC,
                "liveliness_lease_duration": _forever(),
                "avoid_ros_namespace_conventions": False,
            }
        ],
        sort_keys=False,
    )


def _forever() -> dict[str, int]:
    return {"sec": 9223372036, "nsec": 854775807}  # rmw's infinite duration, 2**63 - 1 ns
