"""Do the messages for this node arrive? Losses are reported, and repaired if possible."""

from __future__ import annotations

from collections import deque
from collections.abc import Mapping

from nodes.dds.endpoints import Subscription
from nodes.dds.node import Node
from nodes.dds.sockets import SocketLoad, own_sockets
from nodes.shared.link import Link
from nodes.shared.topics import Input

#: Reports that "of late" goes over, as in /diagnostics.
_REPORTS = 10


class LinkWatch:
    """Watches the connections of one node.

    Images are listened to best effort, as drivers send them; then of an image with a fragment
    missing nothing is sent again. An image larger than the socket's receive buffer never arrives
    that way: as soon as datagrams are dropped, images are asked for reliably, if all who publish
    them offer that.

    Args:
        node: Whose connections.
        subscriptions: Its inputs.
    """

    def __init__(self, node: Node, subscriptions: Mapping[Input, Subscription]) -> None:
        self._node = node
        self._subscriptions = subscriptions
        self._images = subscriptions[Input.IMAGES]
        self._dropped = deque([own_sockets().dropped], maxlen=_REPORTS + 1)

    def report(self) -> dict[Input, Link]:
        """How every input is connected now; to be called once in a while."""
        load = own_sockets()
        self._dropped.append(load.dropped)
        dropped = load.dropped - self._dropped[0]
        if self._images.profile.reliable:
            if self._images.refused.times:
                self._node.listen_again(self._images, reliable=False)
        elif dropped and self._images.is_offered_reliably:
            self._node.listen_again(self._images, reliable=True)
        links = {item: _link(subscription) for item, subscription in self._subscriptions.items()}
        links[Input.IMAGES] = self._with_load(links[Input.IMAGES], load, dropped)
        return links

    def _with_load(self, link: Link, load: SocketLoad, dropped: int) -> Link:
        is_reliable = self._images.profile.reliable
        loss = (
            f"{dropped} datagrams recently did not fit into the socket's receive buffer of "
            f"{load.buffer_bytes} bytes, and an image that lacks one is lost; {load.remedy}"
        )
        values = {
            "is_reliable": is_reliable,
            "socket_buffer_bytes": load.buffer_bytes,
            "datagrams_dropped": load.dropped,
        }
        return link._replace(loss=loss if dropped and not is_reliable else "", values=values)


def _link(subscription: Subscription) -> Link:
    count, policy = subscription.refused
    refusal = f"{count} offer less {policy} than requested; nothing is received from them"
    return Link(subscription.publishers, refusal if count else "")
