"""What is a name in full, and what does DDS call it?"""

from __future__ import annotations

import re
from collections.abc import Iterable

from tracker.errors import ConfigError

_FULL_NAME = re.compile(r"(/[A-Za-z_][A-Za-z0-9_]*)+")
_NODE_NAME = re.compile(r"[A-Za-z_][A-Za-z0-9_]*")


class Names:
    """The names of one node, after remapping.

    Args:
        node_name: Such as `hand_detector`.
        namespace: Such as `/robot1`.
        remaps: Rules as ROS 2 writes them: `from:=to`, `__node:=name`, `__ns:=/namespace`;
            both sides may be relative or begin with `~/`.

    Attributes:
        node_name: After `__node`.
        namespace: After `__ns`; begins with a slash.

    Raises:
        ConfigError: A rule or a name is none.
    """

    def __init__(self, node_name: str, namespace: str = "/", remaps: Iterable[str] = ()) -> None:
        rules = [_rule(text) for text in remaps]
        special = dict(rules)
        self.node_name = special.get("__node", special.get("__name", node_name))
        self.namespace = "/" + special.get("__ns", namespace).strip("/")
        if not _NODE_NAME.fullmatch(self.node_name):
            raise ConfigError(
                f"The node's name is {self.node_name!r}; allowed are letters, digits and _."
            )
        if self.namespace != "/":
            _check(self.namespace)
        self._remaps = {
            self._expand(source): self._expand(target)
            for source, target in rules
            if source not in ("__node", "__name", "__ns")
        }

    @property
    def full_node_name(self) -> str:
        """Namespace and name, as `/robot1/hand_detector`."""
        return self._expand(self.node_name)

    def resolve(self, name: str) -> str:
        """A topic's or service's full name, remapped.

        Raises:
            ConfigError: It is no name.
        """
        full = self._expand(name)
        return self._remaps.get(full, full)

    def _expand(self, name: str) -> str:
        root = self.namespace.rstrip("/")
        if name.startswith("~/"):
            name = f"{root}/{self.node_name}{name[1:]}"
        elif not name.startswith("/"):
            name = f"{root}/{name}"
        return _check(name)


def dds_type_name(type_name: str) -> str:
    """`sensor_msgs/msg/Image` as DDS calls it: `sensor_msgs::msg::dds_::Image_`."""
    package, kind, name = type_name.split("/")
    return f"{package}::{kind}::dds_::{name}_"


def ros_type_name(dds_name: str) -> str | None:
    """`sensor_msgs::msg::dds_::Image_` as ROS calls it; None for a type of another world."""
    found = re.fullmatch(r"(\w+)::(msg|srv)::dds_::(\w+)_", dds_name)
    return "/".join(found.groups()) if found else None


def _rule(text: str) -> tuple[str, str]:
    source, separator, target = text.partition(":=")
    if not separator or not source or not target:
        raise ConfigError(f"A remapping is {text!r}; expected FROM:=TO.")
    return source, target


def _check(full_name: str) -> str:
    if not _FULL_NAME.fullmatch(full_name):
        raise ConfigError(
            f"The name {full_name!r} is not a valid ROS name; allowed are letters, digits, _ and "
            "/."
        )
    return full_name
