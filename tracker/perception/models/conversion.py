"""The ONNX graph under construction, and what the operators' converters share."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import onnx
import tflite
from numpy.typing import NDArray
from onnx import helper, numpy_helper

from tracker.errors import ModelFileError
from tracker.perception.models.tflite_graph import Operator, TfliteGraph


@dataclass(eq=False)
class Conversion:
    """The ONNX graph under construction.

    Attributes:
        graph: The TFLite graph.
        operators: Those of its operators that are converted, in order.
        size_is_free: Height and width are not fixed.
        constants: Values known now, by tensor number.
        names: ONNX names of computed values, by tensor number.
        pads: Zero padding (top, left, bottom, right) still owed to a value, by tensor number; the
            convolutions that consume it pay.
        scales: Enlargement (vertical, horizontal) still owed to a value, likewise.
        nodes: ONNX nodes so far.
        initializers: ONNX constants so far, by name.
    """

    graph: TfliteGraph
    operators: Sequence[Operator]
    size_is_free: bool = False
    constants: dict[int, NDArray[Any]] = field(default_factory=dict)
    names: dict[int, str] = field(default_factory=dict)
    pads: dict[int, tuple[int, int, int, int]] = field(default_factory=dict)
    scales: dict[int, tuple[float, float]] = field(default_factory=dict)
    nodes: list[onnx.NodeProto] = field(default_factory=list)
    initializers: dict[str, onnx.TensorProto] = field(default_factory=dict)

    def __post_init__(self) -> None:
        for index, tensor in enumerate(self.graph.tensors):
            if tensor.data is not None:
                self.constants[index] = tensor.data

    def shape(self, index: int) -> tuple[int, ...]:
        """Shape of a value in the TFLite file, channels last."""
        return self.graph.tensors[index].shape

    def output_dims(self, index: int) -> list[int | str]:
        """Dimensions of a value after the batch, as the ONNX file declares them."""
        shape = self.shape(index)
        if len(shape) == 4:
            shape = (shape[0], shape[3], shape[1], shape[2])
        dims: list[int | str] = list(shape[1:])
        if self.size_is_free and len(shape) == 3:
            dims[0] = "anchors"
        if self.size_is_free and len(shape) == 4:
            dims[1:] = ["rows", "columns"]
        return dims

    def only_feeds(self, index: int, accepts: Callable[["Conversion", Operator], bool]) -> bool:
        """Whether a value is used, and by nothing but operators that pass a test."""
        consumers = [operator for operator in self.operators if index in operator.inputs]
        is_output = index in self.graph.outputs
        return bool(consumers) and not is_output and all(accepts(self, o) for o in consumers)

    def constant(self, index: int, operator: Operator) -> NDArray[Any]:
        """Value of an input that has to be known now."""
        if index not in self.constants:
            raise unsupported(operator, f"'{self.graph.tensors[index].name}' is not a constant")
        return self.constants[index]

    def add_constant(self, name: str, values: NDArray[Any]) -> str:
        """Store a constant once under its name."""
        if name not in self.initializers:
            self.initializers[name] = numpy_helper.from_array(np.asarray(values), name)
        return name

    def add_node(self, kind: str, inputs: Sequence[str], output: str, **attributes: Any) -> str:
        """Append a node with one output and return that output's name."""
        self.nodes.append(helper.make_node(kind, inputs, [output], output, **attributes))
        return output

    def finish(self, operator: Operator, value: str, activation: int = 0) -> None:
        """Apply the operator's fused activation and make the value its output."""
        if activation == tflite.ActivationFunctionType.RELU:
            value = self.add_node("Relu", [value], f"{value}_relu")
        elif activation == tflite.ActivationFunctionType.RELU6:
            bounds = [
                self.add_constant("zero", np.float32(0.0)),
                self.add_constant("six", np.float32(6.0)),
            ]
            value = self.add_node("Clip", [value, *bounds], f"{value}_relu6")
        elif activation != tflite.ActivationFunctionType.NONE:
            raise unsupported(operator, f"fused activation {activation}")
        self.names[operator.outputs[0]] = value


def unsupported(operator: Operator, what: str) -> ModelFileError:
    """The error for an operator used in a way that no catalog model uses it."""
    return ModelFileError(
        f"The model uses {operator.kind} in a way this converter does not know ({what}); use the "
        "model files named in the catalog."
    )
