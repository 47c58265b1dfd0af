"""How does a TFLite model file become an ONNX one?

The result computes in channels-first order, which is what ONNX Runtime's fast kernels want; the
batch dimension is free. Weights become float32 constants. Values keep the numbers they have in
the TFLite file, so that a node `t127` can be looked up there.
"""

from collections.abc import Iterable, Mapping

import numpy as np
import onnx
from onnx import TensorProto, helper

from tracker.errors import ModelFileError
from tracker.perception.models.catalog import CONVERTER_VERSION
from tracker.perception.models.conversion import Conversion
from tracker.perception.models.convert_operators import CONVERTERS
from tracker.perception.models.densify import densify
from tracker.perception.models.tflite_graph import Operator, TfliteGraph, read_graph

INPUT_NAME = "image"
_CHANNELS_FIRST = (0, 3, 1, 2)
# The oldest that has all that is needed, so that ONNX Runtime 1.17 and later read the files.
_OPSET = 17
_IR_VERSION = 8


def convert_tflite(
    content: bytes,
    outputs: Mapping[str, str],
    *,
    size_is_free: bool = False,
    metadata: Mapping[str, str] | None = None,
) -> bytes:
    """Convert one TFLite image model to ONNX.

    The ONNX model has one input, `image`: float32, shape (N, H, W, 3), as in the TFLite file but
    for the free batch dimension. The transpose inside costs 0.02 to 0.1 ms, while channels-first
    images cost the caller 0.2 to 0.3 ms more to make. Outputs keep their TFLite shapes with a free
    batch dimension, but for those of rank 4, which are channels first.

    A session that fixes the free dimensions `batch`, `height` and `width` (ONNX Runtime's
    `add_free_dimension_override_by_name`) runs the palm models 6 % faster.

    Args:
        content: The TFLite file.
        outputs: Name in the ONNX file of each output to keep, mapped to its TFLite name. Operators
            that feed no kept output are left out.
        size_is_free: Leave height and width free. The caller must keep them to multiples of the
            network's total stride (32 for the palm models), since padding is fixed here.
        metadata: Texts to store in the file beside the converter's version.

    Returns:
        The ONNX file.

    Raises:
        ModelFileError: The content is no TFLite file, has no such output, or uses an operator or
            an option this converter does not know; the message names it.
    """
    graph = read_graph(content)
    kept = {name: _find_output(graph, source) for name, source in outputs.items()}
    needed = _needed_operators(graph, kept.values())

    conversion = Conversion(graph, needed, size_is_free=size_is_free)
    (image,) = graph.inputs
    conversion.names[image] = conversion.add_node(
        "Transpose", [INPUT_NAME], f"t{image}", perm=_CHANNELS_FIRST
    )
    for operator in needed:
        if not _fold(conversion, operator):
            if operator.kind not in CONVERTERS:
                raise ModelFileError(
                    f"The model uses the operator {operator.kind}, which this converter does not "
                    f"know (it knows {', '.join(sorted(CONVERTERS))}); use the model files named "
                    "in the catalog."
                )
            CONVERTERS[operator.kind](conversion, operator)

    return _assemble(conversion, image, kept, metadata or {})


def _find_output(graph: TfliteGraph, name: str) -> int:
    for index in graph.outputs:
        if graph.tensors[index].name == name:
            return index
    known = ", ".join(graph.tensors[index].name for index in graph.outputs)
    raise ModelFileError(f"The model has no output '{name}', only {known}; fetch it again.")


def _needed_operators(graph: TfliteGraph, outputs: Iterable[int]) -> list[Operator]:
    wanted = set(outputs)
    needed = []
    for operator in reversed(graph.operators):
        if wanted.intersection(operator.outputs):
            wanted.update(operator.inputs)
            needed.append(operator)
    return needed[::-1]


def _fold(conversion: Conversion, operator: Operator) -> bool:
    """Compute what works on constants alone: half precision to single, sparse to dense."""
    if operator.kind not in ("DEQUANTIZE", "DENSIFY"):
        return False
    source = conversion.graph.tensors[operator.inputs[0]]
    values = conversion.constants.get(operator.inputs[0])
    if values is None:
        raise ModelFileError(
            f"{operator.kind} works on '{source.name}', which is not a constant; only models "
            "with floating-point values are supported, use those named in the catalog."
        )
    if operator.kind == "DENSIFY":
        if source.sparsity is None:
            raise ModelFileError(f"DENSIFY works on '{source.name}', which is not sparse.")
        values = densify(values, source.shape, source.sparsity)
    else:
        values = values.astype(np.float32)
    conversion.constants[operator.outputs[0]] = values
    return True


def _assemble(
    conversion: Conversion, image: int, outputs: Mapping[str, int], metadata: Mapping[str, str]
) -> bytes:
    _, height, width, channels = conversion.graph.tensors[image].shape
    size = ["height", "width"] if conversion.size_is_free else [height, width]
    nodes = list(conversion.nodes)
    infos = []
    for name, index in outputs.items():
        nodes.append(helper.make_node("Identity", [conversion.names[index]], [name]))
        infos.append(
            helper.make_tensor_value_info(
                name, TensorProto.FLOAT, ["batch", *conversion.output_dims(index)]
            )
        )
    model = helper.make_model(
        helper.make_graph(
            nodes,
            "converted",
            [
                helper.make_tensor_value_info(
                    INPUT_NAME, TensorProto.FLOAT, ["batch", *size, channels]
                )
            ],
            infos,
            list(conversion.initializers.values()),
        ),
        opset_imports=[helper.make_opsetid("", _OPSET)],
        ir_version=_IR_VERSION,
        producer_name="raised-hand-tracker",
    )
    helper.set_model_props(model, {"converter_version": str(CONVERTER_VERSION), **metadata})
    onnx.checker.check_model(model)
    content: bytes = model.SerializeToString(deterministic=True)
    return content
