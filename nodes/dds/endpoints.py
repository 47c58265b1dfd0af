"""Publishers and subscriptions of one topic, and the nodes they are connected with."""

from __future__ import annotations

import threading
from collections.abc import Callable
from enum import IntEnum
from typing import Any, NamedTuple

from cyclonedds.core import Policy, ReadCondition
from cyclonedds.internal import SampleInfo

from nodes.dds.raw import RawReader, RawWriter
from nodes.shared.qos import Profile

#: Takes a serialized message, and where it is from.
TakeFrom = Callable[[bytes, SampleInfo], None]


class QosPolicy(IntEnum):
    """The policies that can keep a reader and a writer apart, as DDS numbers them."""

    DURABILITY = 2
    PRESENTATION = 3
    DEADLINE = 4
    LATENCY_BUDGET = 5
    OWNERSHIP = 6
    LIVELINESS = 8
    RELIABILITY = 11
    DESTINATION_ORDER = 12
    DATA_REPRESENTATION = 23


class Refusal(NamedTuple):
    """Others that cannot be connected with.

    Attributes:
        times: How many came, those that have left included.
        policy: What the last one disagrees in, as `reliability`.
    """

    times: int
    policy: str


class Publisher:
    """Sends serialized messages to one topic. Made by `Node.publisher`.

    Attributes:
        topic: Its full name.
        type_name: As `std_msgs/msg/Bool`.
        profile: Its quality of service.
        lost: Messages that a slow reliable reader left no room for.
    """

    def __init__(self, topic: str, type_name: str, profile: Profile, writer: RawWriter) -> None:
        self.topic = topic
        self.type_name = type_name
        self.profile = profile
        self.lost = 0
        self._writer = writer

    def publish(self, cdr: bytes) -> None:
        """Send one message, serialized with its encapsulation; from any thread."""
        if not self._writer.write_cdr(cdr):
            self.lost += 1

    @property
    def subscribers(self) -> int:
        """How many readers it has now."""
        return int(self._writer.get_publication_matched_status().current_count)

    @property
    def ever_heard_by(self) -> int:
        """How many readers it has had, those that have left included."""
        return int(self._writer.get_publication_matched_status().total_count)

    @property
    def refused(self) -> Refusal:
        """Readers that request more than is offered and receive nothing."""
        return _refusal(self._writer.get_offered_incompatible_qos_status())

    def is_acknowledged(self, timeout_s: float) -> bool:
        """Whether all reliable readers have confirmed everything, at the latest after a wait."""
        return self._writer.wait_for_acknowledgments(timeout_s)


class Subscription:
    """Takes serialized messages of one topic. Made by `Node.subscribe`.

    Its reader is exchanged by the thread that spins while others ask about it.

    Attributes:
        profile: Its quality of service.
        take: Gets every message.
        reader: The DDS reader.
        arrived: What the node waits for.
    """

    def __init__(self, profile: Profile, take: TakeFrom, reader: RawReader, unread: int) -> None:
        self._lock = threading.Lock()
        self._unread = unread
        self.take = take
        self._connect(reader, profile)

    def exchange(self, reader: RawReader, profile: Profile) -> None:
        """Go on with another reader; the one before is deleted."""
        with self._lock:
            before = self.arrived, self.reader
            self._connect(reader, profile)
            for entity in before:
                entity.__del__()

    @property
    def publishers(self) -> int:
        """How many writers it has now."""
        with self._lock:
            return int(self.reader.get_subscription_matched_status().current_count)

    @property
    def refused(self) -> Refusal:
        """Writers that offer less than is requested; nothing is received from them."""
        with self._lock:
            return _refusal(self.reader.get_requested_incompatible_qos_status())

    @property
    def is_offered_reliably(self) -> bool:
        """Whether there are writers, and all of them send again what was lost."""
        with self._lock:
            reader = self.reader
            found = [
                reader.get_matched_publication_data(handle)
                for handle in reader.get_matched_publications()
            ]
        known = [endpoint.qos for endpoint in found if endpoint is not None]
        return bool(known) and all(
            isinstance(qos[Policy.Reliability], Policy.Reliability.Reliable) for qos in known
        )

    def _connect(self, reader: RawReader, profile: Profile) -> None:
        self.reader, self.profile = reader, profile
        self.arrived = ReadCondition(reader, self._unread)


def _refusal(status: Any) -> Refusal:
    number = int(status.last_policy_id)
    known = number in QosPolicy.__members__.values()
    name = QosPolicy(number).name.lower().replace("_", " ") if known else f"policy {number}"
    return Refusal(int(status.total_count), name)
