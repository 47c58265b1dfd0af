"""How was this made? Parameters that differ from the defaults, versions, the command."""

from __future__ import annotations

import platform
from importlib.metadata import PackageNotFoundError, version

from tracker.config import Config, allowed_values, parameter_extra
from tracker.report.page import Section, Table, Text

_DISTRIBUTIONS = (
    "raised-hand-tracker", "numpy", "scipy", "opencv-python-headless", "onnxruntime", "matplotlib",
)  # fmt: skip


def settings_section(config: Config) -> Section:
    """The parameters that differ from the defaults, with what they mean.

    Args:
        config: The parameters in force.
    """
    default = Config()
    changed = [
        name for name in Config.model_fields if getattr(config, name) != getattr(default, name)
    ]
    if not changed:
        return Section("Settings", (Text(("Every parameter has its default.",)),))
    rows = tuple(
        (
            name,
            _written(config, name),
            _written(default, name),
            str(parameter_extra(name)["unit"]),
            str(Config.model_fields[name].description),
            allowed_values(name),
        )
        for name in changed
    )
    columns = ("parameter", "here", "default", "unit", "meaning", "allowed")
    table = Table(columns, rows, numeric=frozenset({1, 2}))
    note = f"{len(changed)} of {len(Config.model_fields)} parameters differ from the defaults."
    return Section("Settings", (Text((note,)), table))


def provenance_section(command: str) -> Section:
    """Versions, and the command that repeats it.

    Args:
        command: As typed; "" where there was none.
    """
    rows = [(name, found) for name in _DISTRIBUTIONS if (found := _version(name))]
    rows += [("Python", platform.python_version()), ("system", platform.platform(terse=True))]
    if command:
        rows.insert(0, ("command", command))
    return Section("Versions and command", (Table(("what", "which"), tuple(rows)),))


def _written(config: Config, name: str) -> str:
    value = getattr(config, name)
    return f"{value:g}" if isinstance(value, float) else str(value)


def _version(distribution: str) -> str | None:
    """None where it is not installed under this name, as a distribution's OpenCV is not."""
    try:
        return version(distribution)
    except PackageNotFoundError:
        return None
