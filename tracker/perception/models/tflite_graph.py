"""What is inside a TFLite file: tensors, operators and their options, free of flatbuffers."""

from dataclasses import dataclass
from typing import Any

import numpy as np
import tflite
from numpy.typing import NDArray

from tracker.errors import ModelFileError
from tracker.perception.models.densify import SparseLevel, Sparsity

# Only the types that occur as constants in the catalog's models.
_DTYPES = {
    tflite.TensorType.FLOAT32: np.dtype("<f4"),
    tflite.TensorType.FLOAT16: np.dtype("<f2"),
    tflite.TensorType.INT32: np.dtype("<i4"),
    tflite.TensorType.INT64: np.dtype("<i8"),
}
_OPERATOR_NAMES = {
    code: name for name, code in vars(tflite.BuiltinOperator).items() if isinstance(code, int)
}
_OPTIONS_NAMES = {
    code: name for name, code in vars(tflite.BuiltinOptions).items() if isinstance(code, int)
}


@dataclass(frozen=True, slots=True, eq=False)
class Tensor:
    """One value of the graph.

    Attributes:
        name: Its name in the file.
        shape: Its shape in the file, channels last; the batch dimension is 1.
        data: The stored values of a constant, shape (V,) if sparse, else `shape`; None for a
            value that is computed.
        sparsity: Layout of a sparse constant, else None.
    """

    name: str
    shape: tuple[int, ...]
    data: NDArray[Any] | None
    sparsity: Sparsity | None


@dataclass(frozen=True, slots=True, eq=False)
class Operator:
    """One step of the graph.

    Attributes:
        kind: Name of the operator in the TFLite schema, as in "CONV_2D".
        inputs: Numbers of its input tensors; -1 is an input left out.
        outputs: Numbers of its output tensors.
        options: The schema's own options object (`tflite.Conv2DOptions`, ...), or None.
    """

    kind: str
    inputs: tuple[int, ...]
    outputs: tuple[int, ...]
    options: Any


@dataclass(frozen=True, slots=True, eq=False)
class TfliteGraph:
    """The main graph of a TFLite file; operators are in an order that can be run."""

    tensors: tuple[Tensor, ...]
    operators: tuple[Operator, ...]
    inputs: tuple[int, ...]
    outputs: tuple[int, ...]


def read_graph(content: bytes) -> TfliteGraph:
    """Read the main graph of a TFLite file.

    Args:
        content: The whole file.

    Raises:
        ModelFileError: The content is not a TFLite file.
    """
    if content[4:8] != b"TFL3":
        raise ModelFileError(
            f"The model file ({len(content)} bytes) is not a TFLite file; fetch it again."
        )
    model = tflite.Model.GetRootAsModel(content, 0)
    graph = model.Subgraphs(0)
    return TfliteGraph(
        tensors=tuple(_read_tensor(model, graph.Tensors(i)) for i in range(graph.TensorsLength())),
        operators=tuple(
            _read_operator(model, graph.Operators(i)) for i in range(graph.OperatorsLength())
        ),
        inputs=tuple(graph.Inputs(i) for i in range(graph.InputsLength())),
        outputs=tuple(graph.Outputs(i) for i in range(graph.OutputsLength())),
    )


def _read_tensor(model: Any, tensor: Any) -> Tensor:
    name = tensor.Name().decode()
    shape = tuple(tensor.Shape(i) for i in range(tensor.ShapeLength()))
    sparsity = _read_sparsity(tensor.Sparsity())
    buffer = model.Buffers(tensor.Buffer())
    data = None
    if buffer.DataLength():
        if tensor.Type() not in _DTYPES:
            raise ModelFileError(
                f"Constant '{name}' has TFLite type {tensor.Type()}, which this converter does "
                "not know; use the model files named in the catalog."
            )
        data = buffer.DataAsNumpy().view(_DTYPES[tensor.Type()])
        data = data if sparsity else data.reshape(shape)
    return Tensor(name, shape, data, sparsity)


def _read_operator(model: Any, operator: Any) -> Operator:
    code = model.OperatorCodes(operator.OpcodeIndex())
    # Codes above 127 live in the newer field; the older one then holds 127.
    number = max(code.BuiltinCode(), code.DeprecatedBuiltinCode())
    kind = _OPERATOR_NAMES.get(number, f"operator {number}")
    if kind == "CUSTOM":
        kind = f"CUSTOM {code.CustomCode().decode()}"
    options = None
    table = operator.BuiltinOptions()
    if table is not None and operator.BuiltinOptionsType() in _OPTIONS_NAMES:
        options = getattr(tflite, _OPTIONS_NAMES[operator.BuiltinOptionsType()])()
        options.Init(table.Bytes, table.Pos)
    return Operator(
        kind,
        tuple(operator.Inputs(i) for i in range(operator.InputsLength())),
        tuple(operator.Outputs(i) for i in range(operator.OutputsLength())),
        options,
    )


def _read_sparsity(sparsity: Any) -> Sparsity | None:
    if sparsity is None:
        return None
    levels = []
    for i in range(sparsity.DimMetadataLength()):
        level = sparsity.DimMetadata(i)
        if level.Format() == tflite.DimensionType.DENSE:
            levels.append(SparseLevel(level.DenseSize()))
        else:
            segments = _read_index_vector(level.ArraySegments(), level.ArraySegmentsType())
            indices = _read_index_vector(level.ArrayIndices(), level.ArrayIndicesType())
            levels.append(SparseLevel(0, segments, indices))
    return Sparsity(
        [sparsity.TraversalOrder(i) for i in range(sparsity.TraversalOrderLength())],
        [sparsity.BlockMap(i) for i in range(sparsity.BlockMapLength())],
        levels,
    )


def _read_index_vector(table: Any, kind: int) -> NDArray[np.int64]:
    vector = {
        tflite.SparseIndexVector.Int32Vector: tflite.Int32Vector,
        tflite.SparseIndexVector.Uint16Vector: tflite.Uint16Vector,
        tflite.SparseIndexVector.Uint8Vector: tflite.Uint8Vector,
    }[kind]()
    vector.Init(table.Bytes, table.Pos)
    return np.asarray(vector.ValuesAsNumpy(), np.int64)
