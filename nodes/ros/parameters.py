"""Which parameters does an rclpy node have? Those of `Config`: declared, checked, handed on."""

from __future__ import annotations

from collections.abc import Callable

from rcl_interfaces.msg import (
    FloatingPointRange,
    IntegerRange,
    ParameterDescriptor,
    SetParametersResult,
)
from rclpy.node import Node
from rclpy.parameter import Parameter

from nodes.shared.parameters import Descriptor, changed, descriptors
from tracker.config import Config
from tracker.errors import ConfigError
from tracker.parameters.retired import without_retired
from tracker.parameters.ros_file import is_ours


class RosParameters:
    """The parameters of a node; whatever is set is checked at once.

    Args:
        node: Made with `automatically_declare_parameters_from_overrides=True`, so that an
            unknown name is found rather than ignored.
        is_managed: Whether the node may be configured again while it lives, so that nothing is
            read-only for good.

    Raises:
        ConfigError: The user gave a parameter that is unknown or out of range.
    """

    def __init__(self, node: Node, *, is_managed: bool = False) -> None:
        self._hand_on: Callable[[Config], None] | None = None
        self._config = _declared(node, is_managed)
        node.add_pre_set_parameters_callback(_with_floats)
        node.add_on_set_parameters_callback(self._check)
        node.add_post_set_parameters_callback(self._take)

    @property
    def config(self) -> Config:
        """The parameters as they are now."""
        return self._config

    def hand_on(self, configure: Callable[[Config], None] | None) -> None:
        """Tell somebody of changes from now on; while nobody is told, everything may change."""
        self._hand_on = configure

    def _check(self, parameters: list[Parameter]) -> SetParametersResult:
        try:
            self._changed(parameters)
        except ConfigError as error:
            return SetParametersResult(successful=False, reason=str(error))
        return SetParametersResult(successful=True)

    def _take(self, parameters: list[Parameter]) -> None:
        self._config = self._changed(parameters)
        if self._hand_on is not None:
            self._hand_on(self._config)

    def _changed(self, parameters: list[Parameter]) -> Config:
        values = {item.name: item.value for item in parameters}
        return changed(self._config, values, is_running=self._hand_on is not None)


def _declared(node: Node, is_managed: bool) -> Config:
    """Declare every parameter of the configuration, with the values the user gave."""
    given = {
        name: parameter.value
        for name, parameter in node.get_parameters_by_prefix("").items()
        if is_ours(name)
    }
    ours = without_retired(given, "parameters", node.get_logger().warning)
    config = Config.from_mapping(ours, origin="parameters")
    for name in given:
        node.undeclare_parameter(name)
    for item in descriptors():
        described = _to_ros(item)
        described.read_only = described.read_only and not is_managed
        value = getattr(config, item.name)
        node.declare_parameter(item.name, value, described, ignore_override=True)
    return config


def _with_floats(parameters: list[Parameter]) -> list[Parameter]:
    """People write 8 for 8.0, and ROS would refuse it."""
    return [
        Parameter(item.name, Parameter.Type.DOUBLE, float(item.value))
        if item.type_ is Parameter.Type.INTEGER
        and item.name in Config.model_fields
        and Config.model_fields[item.name].annotation is float
        else item
        for item in parameters
    ]


def _to_ros(item: Descriptor) -> ParameterDescriptor:
    ros = ParameterDescriptor(
        description=item.description,
        additional_constraints=item.constraints,
        read_only=item.is_read_only,
    )
    if item.minimum is not None and item.maximum is not None:
        if isinstance(item.default, float):
            ros.floating_point_range = [
                FloatingPointRange(from_value=item.minimum, to_value=item.maximum)
            ]
        else:
            ros.integer_range = [
                IntegerRange(from_value=int(item.minimum), to_value=int(item.maximum), step=1)
            ]
    return ros
