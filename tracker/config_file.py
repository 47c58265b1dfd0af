"""How does a user read the parameters? The default YAML file and the table of the documentation.

Both are written from the one model in `tracker.config`; `make config` renews the committed file,
and a test says when that was forgotten. Basic parameters come first everywhere, then the expert
ones.
"""

from __future__ import annotations

import json
import sys
from itertools import groupby
from pathlib import Path
from textwrap import wrap

from tracker.config import NODE_NAME, Config, allowed_values, parameter_extra

GROUP_TITLES = {
    "specification": "The original node (specification, table 1)",
    "frames": "Frames and camera",
    "perception": "Perception: image to hands",
    "pose": "Detectors and body poses",
    "gestures": "Gestures: what hands say",
    "ranging": "Ranging: scan or depth image to distances",
    "tracking": "Tracking: measurements to customers",
    "selection": "Selection and poses",
    "service": "Waiting list",
    "node": "The nodes",
}


LEVEL_TITLES = {"basic": "Basic", "expert": "Expert"}


def default_yaml() -> str:
    """The ROS parameter file of every default, with meaning, unit and range as comments."""
    return parameter_yaml(
        Config(),
        "Every parameter with its default. Written from tracker/config.py by `make config`.",
    )


def parameter_yaml(config: Config, title: str) -> str:
    """The ROS parameter file of a configuration; `Config.from_yaml` and the node read it.

    Args:
        config: Every parameter.
        title: One line, the first comment.
    """
    lines = [
        f"# {title}",
        "# Basic parameters first, then expert ones. live: it may change while the node runs.",
        f"{NODE_NAME}:",
        "  ros__parameters:",
    ]
    for level, group, names in grouped_parameters():
        lines += ["", f"    # ---- {LEVEL_TITLES[level]}: {GROUP_TITLES[group]} ----"]
        for name in names:
            live = "; live" if parameter_extra(name)["live"] else ""
            words = wrap(_description(name), 90, break_on_hyphens=False)
            lines += [f"    # {line}" for line in [*words, f"({allowed_values(name)}{live})"]]
            lines.append(f"    {name}: {json.dumps(getattr(config, name))}")
    return "\n".join(lines) + "\n"


def markdown_tables(level: str) -> str:
    """One Markdown table per group of the parameters of a level."""
    parts = []
    for _, group, names in filter(lambda item: item[0] == level, grouped_parameters()):
        rows = [
            f"| `{name}` | `{_written(name)}` | {allowed_values(name)} "
            f"| {'yes' if parameter_extra(name)['live'] else 'no'} | {_description(name)} |"
            for name in names
        ]
        header = ["| Parameter | Default | Allowed | Live | Meaning |", "|" + " --- |" * 5]
        parts.append("\n".join([f"### {GROUP_TITLES[group]}", "", *header, *rows]))
    return "\n\n".join(parts) + "\n"


def grouped_parameters() -> list[tuple[str, str, list[str]]]:
    """Level, group and names: all basic parameters, group by group, then all expert ones."""
    keys = {name: _level_and_group(name) for name in Config.model_fields}
    ordered = sorted(keys, key=lambda name: keys[name][0] != "basic")  # stable: groups stay whole
    return [(*key, list(names)) for key, names in groupby(ordered, key=lambda name: keys[name])]


def _level_and_group(name: str) -> tuple[str, str]:
    extra = parameter_extra(name)
    return extra["level"], extra["group"]


def _description(name: str) -> str:
    return str(Config.model_fields[name].description)


def _written(name: str) -> str:
    return json.dumps(Config.model_fields[name].default)  # what JSON writes, YAML reads alike


def markdown_page() -> str:
    """The page of the documentation that lists every parameter."""
    return f"""# Parameters

`raised-hand parameters` shows the basic parameters in a terminal, `--all` every one. Set one with
`-p name:=value`, or several in a copy of `config/hand_detector.yaml`, for `--config` and for the
node. A typo, a wrong type or a value out of range is an error that names the parameter. Files are
read as ROS 2 reads them. *Live* parameters may change while the node runs.

This page is written from `tracker/config.py` by `make config`.

## {LEVEL_TITLES["basic"]}

A new robot, camera or room may need other values of these.

{markdown_tables("basic")}
## {LEVEL_TITLES["expert"]}

Most users keep the defaults of these. `raised-hand tune` searches for better values of some:
[Tuning](tuning.md).

{markdown_tables("expert")}"""


if __name__ == "__main__":
    for name in sys.argv[1:]:
        content = markdown_page() if name.endswith(".md") else default_yaml()
        Path(name).write_text(content, encoding="utf-8")
