"""`raised-hand echo`: print the messages of one topic as text."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable
from typing import Any

import numpy as np
import yaml

from nodes.dds.node import Node
from nodes.shared.qos import Profile
from tracker.errors import ConfigError, RecordingError
from tracker.messages.types import deserialize, typestore

#: Hidden from ROS 2's tools, as `raised-hand play` is.
NODE_NAME = "_raised_hand_echo"

#: Longer arrays are cut, as `ros2 topic echo` does.
_LONGEST = 128
#: How often an endless wait looks whether it was interrupted.
_STEP_S = 0.2


def echo(
    topic: str,
    *,
    count: int | None = None,
    timeout_s: float | None = None,
    remaps: Iterable[str] = (),
    write: Callable[[str], object] = print,
) -> int:
    """Print the messages of a topic.

    Args:
        topic: Its name.
        count: Return after so many; None goes on until interrupted.
        timeout_s: Give up when nothing has come for so long; None waits.
        remaps: Rules `from:=to`.
        write: Takes each message as YAML, with `---` below.

    Returns:
        How many were printed.

    Raises:
        ConfigError: DDS cannot start, or the topic's type is unknown here.
        RecordingError: Nothing came in time.
    """
    with Node(NODE_NAME, remaps=remaps) as node:
        type_name, profile = _find(node, topic, timeout_s)
        waiting: list[bytes] = []
        node.subscribe(topic, type_name, waiting.append, profile)
        printed, last_s = 0, time.monotonic()
        while count is None or printed < count:
            node.spin_once(_STEP_S)
            for cdr in waiting[: None if count is None else count - printed]:
                write(f"{_text(type_name, cdr)}---")
                printed, last_s = printed + 1, time.monotonic()
            waiting.clear()
            if timeout_s is not None and time.monotonic() - last_s >= timeout_s:
                raise RecordingError(f"Nothing came on {topic} for {timeout_s:g} s.")
        return printed


def _find(node: Node, topic: str, timeout_s: float | None) -> tuple[str, Profile]:
    """The topic's type, and the most that all its publishers offer."""
    deadline = None if timeout_s is None else time.monotonic() + timeout_s
    while not (offers := node.offers(topic, _STEP_S)):
        if deadline is not None and time.monotonic() >= deadline:
            raise RecordingError(
                f"There is no publisher of {topic}; check its name, ROS_DOMAIN_ID and "
                "ROS_AUTOMATIC_DISCOVERY_RANGE."
            )
    type_name = offers[0].type_name
    if type_name not in typestore().fielddefs:
        raise ConfigError(f"{topic} has the type {type_name}, which is not supported.")
    reliable = all(offer.reliable for offer in offers)
    latched = all(offer.transient_local for offer in offers)
    return type_name, Profile(reliable, latched, 10, "Works with every publisher.")


def _text(type_name: str, cdr: bytes) -> str:
    try:
        said = _plain(deserialize(type_name, cdr))
    except RecordingError as error:
        return f"# {error}\n"
    return yaml.safe_dump(said, sort_keys=False, allow_unicode=True)


def _plain(value: Any) -> Any:
    """A message as dictionaries, lists and numbers."""
    if hasattr(value, "__msgtype__"):
        _, fields = typestore().fielddefs[value.__msgtype__]  # without the type's constants
        return {name: _plain(getattr(value, name)) for name, _ in fields}
    if isinstance(value, (list, np.ndarray)):
        shown = [_plain(item) for item in value[:_LONGEST]]
        return [*shown, "..."] if len(value) > _LONGEST else shown
    return value.item() if isinstance(value, np.generic) else value
