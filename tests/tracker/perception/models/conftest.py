"""A writer of small TFLite files, LiteRT as the oracle, and a catalog of one small model."""

import hashlib
import os
import tempfile
import zipfile
from collections.abc import Callable, Sequence
from contextlib import AbstractContextManager
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import flatbuffers
import numpy as np
import onnxruntime
import platformdirs
import pytest
import tflite
from ai_edge_litert.interpreter import Interpreter

from tracker.perception.models import ModelEntry, ModelOutput, ModelStore, catalog, fetch, store
from tracker.perception.models import wheel as wheel_module
from tracker.perception.models.convert import convert_tflite
from tracker.perception.models.densify import Sparsity
from tracker.perception.models.wheel import download_wheel, read_wheel

_TYPES = {
    np.dtype(np.float32): tflite.TensorType.FLOAT32,
    np.dtype(np.float16): tflite.TensorType.FLOAT16,
    np.dtype(np.int32): tflite.TensorType.INT32,
}


@dataclass
class Step:
    """One operator; constants are given as arrays, values by name."""

    kind: str
    inputs: Sequence[Any]
    output: str
    shape: tuple[int, ...]
    options: str = ""
    fields: dict[str, int] = field(default_factory=dict)


@dataclass
class SparseConstant:
    values: np.ndarray
    shape: tuple[int, ...]
    sparsity: Sparsity


class TfliteWriter:
    """Builds one TFLite file; the schema's own builder functions do the encoding."""

    def __init__(self) -> None:
        self._builder = flatbuffers.Builder(1024)
        self._tensors: list[int] = []
        self._buffers: list[int] = [self._table("Buffer", {})]
        self._numbers: dict[str, int] = {}
        self._codes: list[str] = []

    def write(
        self, image_shape: tuple[int, ...], steps: Sequence[Step], outputs: Sequence[str]
    ) -> bytes:
        self._numbers["input"] = self._add_tensor("input", image_shape, np.dtype(np.float32), 0)
        operators = [self._add_operator(step) for step in steps]
        graph = self._table(
            "SubGraph",
            {
                "Tensors": self._offsets(self._tensors),
                "Inputs": self._ints([0]),
                "Outputs": self._ints([self._numbers[name] for name in outputs]),
                "Operators": self._offsets(operators),
            },
        )
        codes = []
        for kind in self._codes:
            number = getattr(tflite.BuiltinOperator, kind)
            codes.append(
                self._table(
                    "OperatorCode",
                    {
                        "DeprecatedBuiltinCode": min(number, 127),
                        "BuiltinCode": number,
                        "Version": 1,
                    },
                )
            )
        model = self._table(
            "Model",
            {
                "Version": 3,
                "OperatorCodes": self._offsets(codes),
                "Subgraphs": self._offsets([graph]),
                "Buffers": self._offsets(self._buffers),
            },
        )
        self._builder.Finish(model, b"TFL3")
        return bytes(self._builder.Output())

    def _add_operator(self, step: Step) -> int:
        inputs = [
            self._numbers[value] if isinstance(value, str) else self._add_constant(value)
            for value in step.inputs
        ]
        number = self._add_tensor(step.output, step.shape, np.dtype(np.float32), 0)
        self._numbers[step.output] = number
        if step.kind not in self._codes:
            self._codes.append(step.kind)
        fields = {
            "OpcodeIndex": self._codes.index(step.kind),
            "Inputs": self._ints(inputs),
            "Outputs": self._ints([number]),
        }
        if step.options:
            fields["BuiltinOptionsType"] = getattr(tflite.BuiltinOptions, step.options)
            fields["BuiltinOptions"] = self._table(step.options, step.fields)
        return self._table("Operator", fields)

    def _add_constant(self, value: Any) -> int:
        sparsity = 0
        array = value
        shape = np.shape(value)
        if isinstance(value, SparseConstant):
            array, shape = value.values, value.shape
            sparsity = self._sparsity(value.sparsity)
        data = self._builder.CreateNumpyVector(
            np.frombuffer(np.ascontiguousarray(array).tobytes(), np.uint8)
        )
        self._buffers.append(self._table("Buffer", {"Data": data}))
        name = f"constant{len(self._tensors)}"
        return self._add_tensor(name, shape, array.dtype, len(self._buffers) - 1, sparsity)

    def _add_tensor(
        self, name: str, shape: Sequence[int], dtype: Any, buffer: int, sparsity: int = 0
    ) -> int:
        fields = {
            "Name": self._builder.CreateString(name),
            "Shape": self._ints(shape),
            "Type": _TYPES[np.dtype(dtype)],
            "Buffer": buffer,
        }
        if sparsity:
            fields["Sparsity"] = sparsity
        self._tensors.append(self._table("Tensor", fields))
        return len(self._tensors) - 1

    def _sparsity(self, sparsity: Sparsity) -> int:
        levels = []
        for level in sparsity.levels:
            if level.segments is None:
                fields = {"Format": tflite.DimensionType.DENSE, "DenseSize": level.size}
            else:
                fields = {
                    "Format": tflite.DimensionType.SPARSE_CSR,
                    "ArraySegmentsType": tflite.SparseIndexVector.Uint8Vector,
                    "ArraySegments": self._bytes_table(level.segments),
                    "ArrayIndicesType": tflite.SparseIndexVector.Uint8Vector,
                    "ArrayIndices": self._bytes_table(level.indices),
                }
            levels.append(self._table("DimensionMetadata", fields))
        return self._table(
            "SparsityParameters",
            {
                "TraversalOrder": self._ints(sparsity.traversal_order),
                "BlockMap": self._ints(sparsity.block_map),
                "DimMetadata": self._offsets(levels),
            },
        )

    def _bytes_table(self, values: Any) -> int:
        vector = self._builder.CreateNumpyVector(np.asarray(values, np.uint8))
        return self._table("Uint8Vector", {"Values": vector})

    def _ints(self, values: Sequence[int]) -> int:
        return int(self._builder.CreateNumpyVector(np.asarray(values, np.int32)))

    def _offsets(self, offsets: Sequence[int]) -> int:
        self._builder.StartVector(4, len(offsets), 4)
        for offset in reversed(offsets):
            self._builder.PrependUOffsetTRelative(offset)
        return int(self._builder.EndVector())

    def _table(self, kind: str, fields: dict[str, int]) -> int:
        getattr(tflite, f"{kind}Start")(self._builder)
        for name, value in fields.items():
            getattr(tflite, f"{kind}Add{name}")(self._builder, value)
        return int(getattr(tflite, f"{kind}End")(self._builder))


def run_litert(content: bytes, image: np.ndarray) -> dict[str, np.ndarray]:
    """Outputs by name, of the reference implementation at batch 1."""
    interpreter = Interpreter(model_content=content, num_threads=1)
    source = interpreter.get_input_details()[0]["index"]
    interpreter.resize_tensor_input(source, image.shape)
    interpreter.allocate_tensors()
    interpreter.set_tensor(source, image)
    interpreter.invoke()
    return {
        detail["name"]: interpreter.get_tensor(detail["index"])
        for detail in interpreter.get_output_details()
    }


def run_onnx(content: bytes, image: np.ndarray) -> dict[str, np.ndarray]:
    """Outputs by name."""
    options = onnxruntime.SessionOptions()
    options.intra_op_num_threads = 1
    session = onnxruntime.InferenceSession(content, options, providers=["CPUExecutionProvider"])
    names = [output.name for output in session.get_outputs()]
    return dict(zip(names, session.run(names, {"image": image}), strict=True))


@pytest.fixture(scope="session")
def write_tflite() -> Callable[..., bytes]:
    def write(
        steps: Sequence[Step],
        outputs: Sequence[str] = ("out",),
        image_shape: tuple[int, ...] = (1, 8, 8, 3),
    ) -> bytes:
        return TfliteWriter().write(image_shape, steps, outputs)

    return write


@pytest.fixture(scope="session")
def step() -> type[Step]:
    return Step


@pytest.fixture(scope="session")
def sparse_constant() -> type[SparseConstant]:
    return SparseConstant


@pytest.fixture(scope="session")
def litert() -> Callable[[bytes, np.ndarray], dict[str, np.ndarray]]:
    return run_litert


@pytest.fixture(scope="session")
def run() -> Callable[[bytes, np.ndarray], dict[str, np.ndarray]]:
    return run_onnx


@pytest.fixture(scope="session")
def tflite_sources(
    model_store: ModelStore, skip_when_offline: Callable[[], AbstractContextManager[None]]
) -> dict[str, bytes]:
    """The original model files, from a wheel kept in the user's cache."""
    folder = platformdirs.user_cache_path("raised-hand-tracker", appauthor=False)
    kept = folder / "wheel-for-tests.whl"
    if not kept.exists():
        folder.mkdir(parents=True, exist_ok=True)
        with skip_when_offline(), tempfile.TemporaryDirectory(dir=folder) as scratch:
            os.replace(download_wheel(Path(scratch), lambda *_: None), kept)
    return read_wheel(kept)


@pytest.fixture(scope="session")
def small_tflite() -> bytes:
    """One pointwise convolution."""
    weights = np.ones((2, 1, 1, 3), np.float32)
    bias = np.zeros(2, np.float32)
    conv = Step(
        "CONV_2D",
        ["input", weights, bias],
        "Identity",
        (1, 8, 8, 2),
        "Conv2DOptions",
        {"StrideH": 1, "StrideW": 1},
    )
    return TfliteWriter().write((1, 8, 8, 3), [conv], ["Identity"])


@pytest.fixture
def small_catalog(monkeypatch: pytest.MonkeyPatch, small_tflite: bytes) -> tuple[ModelEntry, ...]:
    """Instead of the six models, two small ones that share a file."""
    sha256 = hashlib.sha256(small_tflite).hexdigest()
    outputs = (ModelOutput("boxes", "Identity"),)
    entries = tuple(
        ModelEntry(name, f"mediapipe/modules/{name}.tflite", sha256, 8, (0.0, 1.0), outputs)
        for name in ("first", "second")
    )
    for module in (catalog, store, fetch, wheel_module):
        monkeypatch.setattr(module, "MODELS", entries)
    return entries


@pytest.fixture
def small_wheel(
    tmp_path: Path, small_catalog: tuple[ModelEntry, ...], small_tflite: bytes
) -> Path:
    path = tmp_path / "mediapipe-0.10.21-cp311-cp311-manylinux_2_28_x86_64.whl"
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        for entry in small_catalog:
            archive.writestr(entry.wheel_path, small_tflite)
    return path


@pytest.fixture
def small_onnx(small_catalog: tuple[ModelEntry, ...], small_tflite: bytes) -> bytes:
    """The converted file of either small model."""
    return convert_tflite(
        small_tflite, {"boxes": "Identity"}, metadata={"source_sha256": small_catalog[0].sha256}
    )
