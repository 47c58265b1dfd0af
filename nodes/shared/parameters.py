"""What does ROS say of each parameter? Descriptors and checks, all from the one Config.

No ROS import: the shells turn a `Descriptor` into rcl_interfaces' messages.
"""

from __future__ import annotations

from typing import Any, NamedTuple

from tracker.config import Config, allowed_values, parameter_extra
from tracker.config_file import grouped_parameters
from tracker.errors import ConfigError
from tracker.parameters.ros_file import is_ours


class Descriptor(NamedTuple):
    """What `ros2 param describe` shows of a parameter.

    Attributes:
        name: As in the YAML file.
        default: Of type bool, int, float or str.
        description: Its meaning, with the unit, and whether it is for experts.
        constraints: What it may be, in words.
        is_read_only: Needs a new start of the node.
        minimum: Inclusive, as ROS has it; where the bound itself is not allowed, the check says.
        maximum: The same.
    """

    name: str
    default: bool | int | float | str
    description: str
    constraints: str
    is_read_only: bool
    minimum: float | None
    maximum: float | None


def descriptors() -> list[Descriptor]:
    """One for each parameter, in the order of the YAML file: basic ones first."""
    return [_descriptor(name) for _, _, names in grouped_parameters() for name in names]


def changed(config: Config, changes: dict[str, Any], *, is_running: bool = True) -> Config:
    """The configuration with parameters set while the node lives.

    Args:
        config: The one in force.
        changes: New values by name; ROS's own parameters are passed over.
        is_running: Whether those that are not `live` have had their effect already.

    Raises:
        ConfigError: A value is refused, or the parameter cannot change while the node runs.
    """
    ours = {name: value for name, value in changes.items() if is_ours(name)}
    fixed = [
        name
        for name, value in ours.items()
        if is_running
        and name in Config.model_fields
        and not parameter_extra(name)["live"]
        and value != getattr(config, name)
    ]
    if fixed:
        raise ConfigError(
            f"{', '.join(f'`{name}`' for name in fixed)} cannot change while the node runs; "
            "restart the node with the new value, or clean up the lifecycle node first."
        )
    return config.replace(**ours) if ours else config


def _descriptor(name: str) -> Descriptor:
    info, extra = Config.model_fields[name], parameter_extra(name)
    unit = f"[{extra['unit']}]" if extra["unit"] else ""
    note = "(expert)" if extra["level"] == "expert" else ""
    return Descriptor(
        name=name,
        default=info.default,
        description=" ".join(filter(None, [info.description, unit, note])),
        constraints=allowed_values(name),
        is_read_only=not extra["live"],
        minimum=_bound(info.metadata, "gt", "ge"),
        maximum=_bound(info.metadata, "lt", "le"),
    )


def _bound(metadata: list[Any], *attributes: str) -> float | None:
    for item in metadata:
        for attribute in attributes:
            value = getattr(item, attribute, None)
            if value is not None:
                return float(value)
    return None
