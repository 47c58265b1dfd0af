"""Which parameters does a ROS parameter file, or NAME:=VALUE, give to our node? As in rcl.

A section counts when its name fits the node's full name: `/*` stands for one namespace or name,
`/**` for any number of them. Sections apply in the order of the file, so that later ones win.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from tracker.errors import ConfigError
from tracker.parameters.yaml_reading import parse_yaml, read_yaml
from tracker.wording import shown

NODE_NAME = "hand_detector"
SECTION = "ros__parameters"

#: Parameters of every ROS node, which are none of ours.
ROS_OWN = ("use_sim_time", "start_type_description_service")
ROS_OWN_PREFIXES = ("qos_overrides.",)

_WILDCARDS = {"*": r"/\w+", "**": r"(/\w+)*"}


def is_ours(name: str) -> bool:
    """Whether a parameter is the tracker's, rather than of every ROS node."""
    return name not in ROS_OWN and not name.startswith(ROS_OWN_PREFIXES)


def read_parameters(path: Path, node: str | None = None) -> dict[str, Any]:
    """The parameters that a file gives to a node; those of other nodes are left alone.

    Args:
        path: A ROS parameter file.
        node: Full name, as `/robot1/hand_detector`. None takes the one of that name in the file,
            in whatever namespace.

    Returns:
        Values by name; a name nested in others has dots: `outer.inner`.

    Raises:
        ConfigError: The file cannot be read, is no parameter file, or has nothing for this node.
    """
    document = read_yaml(path)
    if not isinstance(document, dict):
        raise ConfigError(f"{path}: contains no parameters; expected `{NODE_NAME}: {SECTION}:`.")
    sections = list(_sections(document))
    names = [name for name, _ in sections]
    # As in rcl, all that a file gives under one name applies where that name stands first.
    sections.sort(key=lambda section: names.index(section[0]))
    node = node or _only_node(names, path)
    fitting = [section for section in sections if _fits(section[0], node)]
    if not fitting:
        needed = f"{node}:` or `/**/{NODE_NAME}" if node else NODE_NAME
        raise ConfigError(f"{path}: names the nodes {', '.join(names)}; expected `{needed}:`.")
    found: dict[str, Any] = {}
    for name, parameters in fitting:
        if not isinstance(parameters, dict):
            raise ConfigError(f"{path}: `{name}:` has no `{SECTION}:` with parameters below it.")
        found |= _flat(parameters)
    return found


def read_assignment(text: str, node: str | None = None) -> tuple[str, Any]:
    """Name and value of a parameter on the command line.

    Args:
        text: NAME:=VALUE, or NODE:NAME:=VALUE.
        node: As for `read_parameters`.

    Raises:
        ConfigError: It is neither, its value is no YAML, or it is for another node.
    """
    name, separator, value = text.partition(":=")
    prefix, has_prefix, rest = name.rpartition(":")
    if not separator or not rest or not value or (has_prefix and not prefix):
        raise ConfigError(f"-p is {shown(text)}; expected NAME:=VALUE.")
    if has_prefix and not _fits(_full(prefix), node):
        raise ConfigError(
            f"-p is {shown(text)}, for the node {_full(prefix)}; this one is {node or NODE_NAME}."
        )
    return rest, parse_yaml(value, f"-p {name}:={value[:60]}")


def _sections(document: dict[str, Any], above: str = "") -> Iterator[tuple[str, Any]]:
    """Full name and parameters of each node, in the order of the file; other things as well."""
    for key, value in document.items():
        if key == SECTION:
            yield above or "/", value
        elif isinstance(value, dict) and value:
            yield from _sections(value, _full(f"{above}/{key}"))
        else:
            yield _full(f"{above}/{key}"), None


def _full(name: str) -> str:
    return "/" + "/".join(part for part in name.split("/") if part)


def _only_node(names: list[str], path: Path) -> str | None:
    """The one node of our name that a file has; None where only wildcards can mean it."""
    ours = sorted({name for name in names if name.endswith(f"/{NODE_NAME}") and "*" not in name})
    if f"/{NODE_NAME}" in ours:
        return f"/{NODE_NAME}"
    if len(ours) > 1:
        raise ConfigError(
            f"{path}: has parameters for {' and '.join(ours)}, but only one can be used; make a "
            "file for each."
        )
    return ours[0] if ours else None


def _fits(name: str, node: str | None) -> bool:
    """Whether a section is for the node; for one in an unknown namespace where that is None."""
    parts = name.split("/")[1:]
    if node is None:
        return parts[-1] in (NODE_NAME, *_WILDCARDS)
    pattern = "".join(_WILDCARDS.get(part, "/" + re.escape(part)) for part in parts)
    return re.fullmatch(pattern, node, re.ASCII) is not None


def _flat(parameters: dict[str, Any], above: str = "") -> dict[str, Any]:
    flat: dict[str, Any] = {}
    for key, value in parameters.items():
        if isinstance(value, dict):
            flat |= _flat(value, f"{above}{key}.")
        else:
            flat[f"{above}{key}"] = value
    return flat
