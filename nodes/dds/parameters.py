"""How do `ros2 param list`, `get`, `set` and `describe` reach this node? By six services."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from nodes.dds.node import Node
from nodes.dds.profiles import PARAMETER_EVENTS, PARAMETER_SERVICES
from nodes.shared.parameters import Descriptor, changed, descriptors
from tracker.config import Config
from tracker.errors import ConfigError
from tracker.messages.parts import header
from tracker.messages.types import build, serialize

_EVENT = "rcl_interfaces/msg/ParameterEvent"
_SRV = "rcl_interfaces/srv"

#: The one parameter of every ROS node that this one has too.
_SIM_TIME = "use_sim_time"

#: rcl_interfaces/msg/ParameterType, and the field of ParameterValue that holds it.
_NOT_SET = 0
_KINDS: dict[type, tuple[int, str]] = {
    bool: (1, "bool_value"),
    int: (2, "integer_value"),
    float: (3, "double_value"),
    str: (4, "string_value"),
}


class ParameterServer:
    """The parameters of one node, as services.

    Args:
        node: Whose.
        config: The parameters in force.
        configure: Puts new ones in force.
        use_sim_time: Shown beside them.
        now_ns: The clock of the events.
    """

    def __init__(
        self,
        node: Node,
        config: Callable[[], Config],
        configure: Callable[[Config], None],
        *,
        use_sim_time: bool,
        now_ns: Callable[[], int],
    ) -> None:
        self._node_name = node.names.full_node_name
        self._config, self._configure = config, configure
        self._use_sim_time, self._now_ns = use_sim_time, now_ns
        self._descriptors = {item.name: item for item in descriptors()} | {
            _SIM_TIME: Descriptor(
                _SIM_TIME, False, "Use the time from /clock.", "true or false", True, None, None
            )
        }
        self._events = node.publisher("/parameter_events", _EVENT, PARAMETER_EVENTS)
        for name, service, answer in (
            ("list_parameters", "ListParameters", self._list),
            ("get_parameters", "GetParameters", self._get),
            ("get_parameter_types", "GetParameterTypes", self._types),
            ("describe_parameters", "DescribeParameters", self._describe),
            ("set_parameters", "SetParameters", self._set),
            ("set_parameters_atomically", "SetParametersAtomically", self._set_atomically),
        ):
            node.serve(f"~/{name}", f"{_SRV}/{service}", answer, PARAMETER_SERVICES)

    def _list(self, request: Any) -> Any:
        asked = [f"{prefix}." for prefix in request.prefixes]
        names = [
            name
            for name in self._descriptors
            if not asked or any(f"{name}.".startswith(prefix) for prefix in asked)
        ]
        result = build("rcl_interfaces/msg/ListParametersResult", names=names)
        return build(f"{_SRV}/ListParameters_Response", result=result)

    def _get(self, request: Any) -> Any:
        values = [_ros_value(self._value(name)) for name in request.names]
        return build(f"{_SRV}/GetParameters_Response", values=values)

    def _types(self, request: Any) -> Any:
        kinds = [_ros_value(self._value(name)).type for name in request.names]
        return build(f"{_SRV}/GetParameterTypes_Response", types=np.array(kinds, dtype=np.uint8))

    def _describe(self, request: Any) -> Any:
        found = [self._descriptors[name] for name in request.names if name in self._descriptors]
        return build(
            f"{_SRV}/DescribeParameters_Response",
            descriptors=[_ros_descriptor(it) for it in found],
        )

    def _set(self, request: Any) -> Any:
        results = [self._change([parameter]) for parameter in request.parameters]
        return build(f"{_SRV}/SetParameters_Response", results=results)

    def _set_atomically(self, request: Any) -> Any:
        result = self._change(request.parameters)
        return build(f"{_SRV}/SetParametersAtomically_Response", result=result)

    def _change(self, parameters: list[Any]) -> Any:
        """Change all of these or none."""
        changes = {item.name: _plain_value(item.value) for item in parameters}
        try:
            if changes.get(_SIM_TIME, self._use_sim_time) != self._use_sim_time:
                raise ConfigError(f"`{_SIM_TIME}` cannot change while the node runs.")
            self._configure(changed(self._config(), changes))
        except ConfigError as error:
            return build(
                "rcl_interfaces/msg/SetParametersResult", successful=False, reason=str(error)
            )
        stamp = header(max(self._now_ns(), 0), "").stamp
        event = build(
            _EVENT, stamp=stamp, node=self._node_name, changed_parameters=list(parameters)
        )
        self._events.publish(serialize(event).cdr)
        return build("rcl_interfaces/msg/SetParametersResult", successful=True)

    def _value(self, name: str) -> Any:
        """None where there is no such parameter."""
        values = self._config().model_dump() | {_SIM_TIME: self._use_sim_time}
        return values.get(name)


def _ros_value(value: Any) -> Any:
    kind, field = _KINDS.get(type(value), (_NOT_SET, ""))
    return build(
        "rcl_interfaces/msg/ParameterValue", type=kind, **({field: value} if field else {})
    )


def _plain_value(value: Any) -> Any:
    for kind, field in _KINDS.values():
        if value.type == kind:
            return getattr(value, field)
    return None  # unset, or an array, which no parameter is


def _ros_descriptor(item: Descriptor) -> Any:
    ranges = {}
    if item.minimum is not None and item.maximum is not None:
        kind, field, number = (
            ("FloatingPointRange", "floating_point_range", float)
            if isinstance(item.default, float)
            else ("IntegerRange", "integer_range", int)
        )
        low, high = number(item.minimum), number(item.maximum)
        ranges[field] = [build(f"rcl_interfaces/msg/{kind}", from_value=low, to_value=high)]
    return build(
        "rcl_interfaces/msg/ParameterDescriptor",
        name=item.name,
        type=_ros_value(item.default).type,
        description=item.description,
        additional_constraints=item.constraints,
        read_only=item.is_read_only,
        **ranges,
    )
