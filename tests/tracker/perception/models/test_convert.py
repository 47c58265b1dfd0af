from collections.abc import Callable
from typing import Any

import numpy as np
import onnx
import pytest
import tflite

from tracker.errors import ModelFileError
from tracker.perception.models.catalog import CONVERTER_VERSION
from tracker.perception.models.convert import convert_tflite

Write = Callable[..., bytes]
Run = Callable[[bytes, np.ndarray], dict[str, np.ndarray]]

SHAPE = (1, 8, 8, 3)
OUTPUT = {"out": "out"}


def _pool(step: Any, size: int = 2) -> Any:
    fields = {"StrideH": 2, "StrideW": 2, "FilterHeight": size, "FilterWidth": size}
    return step("MAX_POOL_2D", ["input"], "out", (1, 4, 4, 3), "Pool2DOptions", fields)


def test_unknown_operator_is_named(step: Any, write_tflite: Write) -> None:
    content = write_tflite([step("TANH", ["input"], "out", SHAPE)])
    with pytest.raises(ModelFileError, match=r"operator TANH.*knows ADD, CONCAT.*catalog"):
        convert_tflite(content, OUTPUT)


def test_unknown_operator_that_feeds_no_kept_output_is_left_out(
    step: Any, write_tflite: Write
) -> None:
    content = write_tflite(
        [step("LOGISTIC", ["input"], "out", SHAPE), step("TANH", ["out"], "mask", SHAPE)],
        ["out", "mask"],
    )
    model = onnx.load_from_string(convert_tflite(content, OUTPUT))
    assert [node.op_type for node in model.graph.node] == ["Transpose", "Sigmoid", "Identity"]


@pytest.mark.parametrize(
    ("kind", "inputs", "shape", "options", "fields", "complaint"),
    [
        pytest.param(
            "ADD",
            ["input", "input"],
            SHAPE,
            "AddOptions",
            {"FusedActivationFunction": tflite.ActivationFunctionType.TANH},
            "fused activation 4",
            id="fused-tanh",
        ),
        pytest.param(
            "ADD", ["input", np.ones(SHAPE, np.float32)], SHAPE, "AddOptions", {}, "constant term",
            id="add-constant",
        ),
        pytest.param(
            "ADD", ["input", np.ones(3, np.float32)], SHAPE, "AddOptions", {}, "shapes",
            id="add-broadcast",
        ),
        pytest.param(
            "RESIZE_BILINEAR",
            ["input", np.array([16, 16], np.int32)],
            (1, 16, 16, 3),
            "ResizeBilinearOptions",
            {"AlignCorners": 1},
            "half-pixel",
            id="aligned-corners",
        ),
        pytest.param(
            "RESIZE_BILINEAR",
            ["input", np.array([12, 12], np.int32)],
            (1, 12, 12, 3),
            "ResizeBilinearOptions",
            {"HalfPixelCenters": 1},
            "8x8 to 12x12",
            id="one-and-a-half",
        ),
        pytest.param(
            "RESHAPE",
            ["input", np.array([1, 2, 32, 3], np.int32)],
            (1, 2, 32, 3),
            "ReshapeOptions",
            {},
            "from shape",
            id="reshape-to-an-image",
        ),
        pytest.param(
            "MEAN", ["input", np.array([3], np.int32)], (1, 8, 8), "ReducerOptions", {}, "axes",
            id="mean-of-channels",
        ),
        pytest.param(
            "PRELU", ["input", np.ones((8, 8, 3), np.float32)], SHAPE, "", {}, "slope",
            id="slope-per-pixel",
        ),
        pytest.param(
            "PAD", ["input", np.zeros((3, 2), np.int32)], SHAPE, "PadOptions", {}, "padding of",
            id="pad-of-rank-three",
        ),
        pytest.param(
            "FULLY_CONNECTED",
            ["input", np.ones((2, 3), np.float32), np.ones(2, np.float32)],
            (1, 8, 8, 2),
            "FullyConnectedOptions",
            {},
            "input of shape",
            id="fully-connected-image",
        ),
        pytest.param("PRELU", ["input", "input"], SHAPE, "", {}, "not a constant", id="computed"),
    ],
)  # fmt: skip
def test_unknown_use_of_an_operator_is_refused(
    step: Any,
    write_tflite: Write,
    kind: str,
    inputs: list[Any],
    shape: tuple[int, ...],
    options: str,
    fields: dict[str, int],
    complaint: str,
) -> None:
    content = write_tflite([step(kind, inputs, "out", shape, options, fields)])
    with pytest.raises(ModelFileError, match=f"uses {kind} in a way.*{complaint}"):
        convert_tflite(content, OUTPUT)


@pytest.mark.parametrize("kind", ["DEQUANTIZE", "DENSIFY"])
def test_folding_a_computed_value_is_refused(step: Any, write_tflite: Write, kind: str) -> None:
    computed = step("LOGISTIC", ["input"], "a", SHAPE)
    content = write_tflite([computed, step(kind, ["a"], "out", SHAPE)])
    with pytest.raises(ModelFileError, match=f"{kind} works on 'a', which is not a constant"):
        convert_tflite(content, OUTPUT)


def test_densify_of_a_dense_weight_is_refused(step: Any, write_tflite: Write) -> None:
    weights = np.ones((2, 1, 1, 3), np.float32)
    content = write_tflite([step("DENSIFY", [weights], "out", (2, 1, 1, 3))])
    with pytest.raises(ModelFileError, match="not sparse"):
        convert_tflite(content, OUTPUT)


def test_constant_of_unknown_type_is_refused(step: Any, write_tflite: Write) -> None:
    conv = step("CONV_2D", ["input", np.zeros((1, 1, 1, 3), np.float16)], "out", (1, 8, 8, 1))
    content = bytearray(write_tflite([conv]))
    tensor = tflite.Model.GetRootAs(content, 0).Subgraphs(0).Tensors(1)
    offset = tensor._tab.Offset(6)  # the field "type" of the table Tensor
    content[tensor._tab.Pos + offset] = tflite.TensorType.INT8
    with pytest.raises(ModelFileError, match="TFLite type 9"):
        convert_tflite(bytes(content), OUTPUT)


def test_file_that_is_no_tflite_is_refused() -> None:
    with pytest.raises(ModelFileError, match=r"20 bytes.*not a TFLite file"):
        convert_tflite(b"<html>not found</ht>", OUTPUT)


def test_missing_output_is_named(step: Any, write_tflite: Write) -> None:
    content = write_tflite([_pool(step)])
    with pytest.raises(ModelFileError, match="no output 'boxes', only out"):
        convert_tflite(content, {"boxes": "boxes"})


def test_free_size_accepts_what_the_stride_divides(
    step: Any, write_tflite: Write, run: Run
) -> None:
    steps = [_pool(step)]
    steps.append(step("RESHAPE", ["out", np.array([1, -1, 3], np.int32)], "rows", (1, 16, 3)))
    content = write_tflite(steps, ["rows"])
    converted = convert_tflite(content, {"rows": "rows"}, size_is_free=True)
    image = np.random.default_rng(0).random((2, 4, 12, 3), np.float32)
    expected = image.reshape(2, 2, 2, 6, 2, 3).max((2, 4)).reshape(2, 12, 3)
    np.testing.assert_array_equal(run(converted, image)["rows"], expected)
    declared = onnx.load_from_string(converted).graph
    for value, dims in (
        (declared.input[0], ["batch", "height", "width", 3]),
        (declared.output[0], ["batch", "anchors", 3]),
    ):
        found = [d.dim_param or d.dim_value for d in value.type.tensor_type.shape.dim]
        assert found == dims


def test_free_size_refuses_a_stride_that_does_not_divide(step: Any, write_tflite: Write) -> None:
    content = write_tflite([_pool(step)], image_shape=(1, 7, 8, 3))
    with pytest.raises(ModelFileError, match="stride 2 on 7 pixels"):
        convert_tflite(content, OUTPUT, size_is_free=True)


def test_file_tells_its_origin(small_tflite: bytes) -> None:
    content = convert_tflite(small_tflite, {"a": "Identity"}, metadata={"license": "Apache-2.0"})
    model = onnx.load_from_string(content)
    assert {p.key: p.value for p in model.metadata_props} == {
        "converter_version": str(CONVERTER_VERSION),
        "license": "Apache-2.0",
    }
    assert (model.ir_version, model.opset_import[0].version) == (8, 17)


def test_conversion_is_the_same_to_the_byte(small_tflite: bytes) -> None:
    first, second = (convert_tflite(small_tflite, {"a": "Identity"}) for _ in range(2))
    assert first == second
