"""Who publishes a topic, and what? As DDS discovery has heard."""

from __future__ import annotations

import time
from typing import NamedTuple

from cyclonedds.builtin import BuiltinDataReader, BuiltinTopicDcpsPublication
from cyclonedds.core import Policy
from cyclonedds.domain import DomainParticipant

from nodes.dds.names import ros_type_name

_POLL_S = 0.02
_MANY = 1000


class Offer(NamedTuple):
    """One publisher of a topic.

    Attributes:
        type_name: As `std_msgs/msg/Bool`.
        reliable: Whether it sends lost messages again.
        transient_local: Whether it repeats its last messages to who comes late.
    """

    type_name: str
    reliable: bool
    transient_local: bool


def offers(participant: DomainParticipant, topic: str, timeout_s: float) -> list[Offer]:
    """The publishers of a topic.

    Args:
        participant: Who has listened to discovery.
        topic: Its full name.
        timeout_s: Wait so long for the first one.
    """
    reader = BuiltinDataReader(participant, BuiltinTopicDcpsPublication)
    deadline = time.monotonic() + timeout_s
    while True:
        found = []
        for endpoint in reader.read(_MANY):
            if endpoint.topic_name != f"rt{topic}":
                continue
            type_name = ros_type_name(endpoint.type_name)
            if type_name is not None:
                qos = endpoint.qos
                found.append(
                    Offer(
                        type_name,
                        isinstance(qos[Policy.Reliability], Policy.Reliability.Reliable),
                        qos[Policy.Durability] != Policy.Durability.Volatile,
                    )
                )
        if found or time.monotonic() >= deadline:
            return found
        time.sleep(_POLL_S)
