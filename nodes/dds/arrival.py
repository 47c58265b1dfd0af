"""Did a message arrive? What its publisher can know."""

from __future__ import annotations

import time
from collections.abc import Mapping

from nodes.dds.endpoints import Publisher
from nodes.dds.sockets import SYSCTL, dropped_in_domain

#: How long confirmations are waited for, all topics together.
_CONFIRMED_S = 1.0
#: A message that is so late is worth a word; a guess.
_LATE_S = 0.5


class Arrival:
    """Watches what becomes of the messages of some publishers.

    Args:
        domain_id: Their DDS domain.
        publishers: Who sends, by topic as it was recorded.
    """

    def __init__(self, domain_id: int, publishers: Mapping[str, Publisher]) -> None:
        self._domain_id = domain_id
        self._publishers = publishers
        self._dropped_before = dropped_in_domain(domain_id)

    def doubts(self, counts: Mapping[str, int], worst_lag_s: float) -> list[str]:
        """What may not have arrived, and why, as sentences; waits a second for confirmations.

        Args:
            counts: Messages sent, by topic as it was recorded.
            worst_lag_s: How late the latest message was.
        """
        said = _unheard([self._publishers[topic] for topic in counts])
        deadline_s = time.monotonic() + _CONFIRMED_S
        for topic, count in counts.items():
            said += _of_topic(self._publishers[topic], count, deadline_s)
        dropped = dropped_in_domain(self._domain_id) - self._dropped_before
        if dropped > 0:
            said.append(
                f"{dropped} datagrams did not fit into the receive buffers of subscribers on "
                "this machine. Messages of best-effort connections are lost. "
                f"{SYSCTL}, and start the subscribers again; docs/ros.md says what ROS 2 nodes "
                "need as well."
            )
        if worst_lag_s >= _LATE_S:
            said.append(f"Slower than real time: one message was sent {worst_lag_s:.1f} s late.")
        return said


def _unheard(sent: list[Publisher]) -> list[str]:
    unheard = [publisher.topic for publisher in sent if not publisher.ever_heard_by]
    if not unheard:
        return []
    if len(unheard) == len(sent):
        return ["Nobody subscribes; check ROS_DOMAIN_ID and ROS_AUTOMATIC_DISCOVERY_RANGE."]
    return [f"Nobody subscribes to {', '.join(unheard)}."]


def _of_topic(publisher: Publisher, count: int, deadline_s: float) -> list[str]:
    said = []
    refused = publisher.refused
    if refused.times:
        said.append(
            f"{publisher.topic}: {refused.times} subscribers request more {refused.policy} than "
            "is offered, and receive nothing."
        )
    if publisher.lost:
        said.append(
            f"{publisher.topic}: {publisher.lost} of {count} messages were not sent, because a "
            "reliable subscriber was too slow."
        )
    if publisher.profile.reliable and not publisher.is_acknowledged(
        max(deadline_s - time.monotonic(), 0.0)
    ):
        said.append(
            f"{publisher.topic}: a subscriber has not confirmed the last of {count} messages."
        )
    return said
