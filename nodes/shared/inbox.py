"""Received data that is not yet processed: all that callbacks and worker share.

Callbacks put bytes in and go; the worker takes them out. Everything is bounded: what overflows is
the oldest, and it is counted.
"""

from __future__ import annotations

import threading
from collections import deque
from collections.abc import Callable
from typing import NamedTuple

from nodes.shared.topics import Input
from tracker.messages import Encoded


class Delivery(NamedTuple):
    """What the worker takes out at a time.

    Attributes:
        orders: Functions to be called by the worker, in the order they were given.
        messages: Everything but images, transforms that hold for ever first.
    """

    orders: list[Callable[[], None]]
    messages: list[tuple[Input, Encoded]]


#: Messages kept for each input, in the order the worker takes them: static transforms come in as
#: many pieces as a robot has links; 2000 moving ones are 10 s at 200 Hz; the newest map counts;
#: intrinsics come with each image.
_KEPT = {
    Input.STATIC_TRANSFORMS: 500,
    Input.TRANSFORMS: 2000,
    Input.MAP: 1,
    Input.CAMERA_INFO: 40,
    Input.SCAN: 40,
    Input.COMMANDS: 100,
    Input.DEPTH_CAMERA_INFO: 20,
    Input.DEPTH: 20,
}


class Inbox:
    """A thread-safe, bounded queue that never blocks the callbacks."""

    def __init__(self) -> None:
        self._changed = threading.Condition()
        self._messages = {item: deque[Encoded](maxlen=size) for item, size in _KEPT.items()}
        self._orders = deque[Callable[[], None]]()
        self._has_news = False
        self._is_closed = False

    def put(self, item: Input, message: Encoded) -> None:
        """Store anything but an image."""
        with self._changed:
            self._messages[item].append(message)
            self._tell()

    def order(self, function: Callable[[], None]) -> None:
        """Let the worker call something, before it looks at anything that comes later."""
        with self._changed:
            self._orders.append(function)
            self._tell()

    def wake(self) -> None:
        """Let the worker look again whether images are ready."""
        with self._changed:
            self._tell()

    def close(self) -> None:
        """Nothing will be taken out any more."""
        with self._changed:
            self._is_closed = True
            self._changed.notify_all()

    def wait(self, timeout_s: float | None) -> bool:
        """Sleep until something has come; False once the inbox is closed."""
        with self._changed:
            self._changed.wait_for(lambda: self._has_news or self._is_closed, timeout_s)
            self._has_news = False
            return not self._is_closed

    def take(self) -> Delivery:
        """Take out everything but images."""
        with self._changed:
            orders = list(self._orders)
            self._orders.clear()
            messages = [
                (item, message) for item, kept in self._messages.items() for message in kept
            ]
            for kept in self._messages.values():
                kept.clear()
        return Delivery(orders, messages)

    def _tell(self) -> None:
        self._has_news = True
        self._changed.notify()
