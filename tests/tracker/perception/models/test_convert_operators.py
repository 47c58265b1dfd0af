"""Each operator alone, against LiteRT and, where the order matters, against values by hand."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
import tflite

from tracker.perception.models.convert import convert_tflite
from tracker.perception.models.densify import SparseLevel, Sparsity

SAME, VALID = tflite.Padding.SAME, tflite.Padding.VALID
RELU, RELU6 = tflite.ActivationFunctionType.RELU, tflite.ActivationFunctionType.RELU6
STRIDE_1 = {"StrideH": 1, "StrideW": 1}


@pytest.fixture
def check(
    step: Any,
    write_tflite: Callable[..., bytes],
    litert: Callable[[bytes, np.ndarray], dict[str, np.ndarray]],
    run: Callable[[bytes, np.ndarray], dict[str, np.ndarray]],
) -> Callable[..., np.ndarray]:
    """Run steps on both sides; compare; return ONNX's result, channels last."""

    def check(
        steps: list[tuple[Any, ...]],
        image: np.ndarray | None = None,
        shape: tuple[int, ...] = (1, 8, 8, 3),
    ) -> np.ndarray:
        if image is None:
            image = 4 * np.random.default_rng(1).standard_normal(shape).astype(np.float32)
        last = steps[-1][2]
        content = write_tflite([step(*s) for s in steps], [last], image.shape)
        expected = litert(content, image)[last]
        converted = convert_tflite(content, {"out": last})
        found = run(converted, image)["out"]
        twice = run(converted, np.concatenate([image, -image]))["out"]
        np.testing.assert_allclose(twice[:1], found, rtol=1e-5, atol=1e-5)
        if found.ndim == 4:
            found = found.transpose(0, 2, 3, 1)
        assert found.shape == expected.shape
        np.testing.assert_allclose(found, expected, rtol=1e-5, atol=1e-5)
        return found

    return check


def _random(*shape: int) -> np.ndarray:
    return np.random.default_rng(2).standard_normal(shape).astype(np.float32)


def _conv(
    source: str, out: str, shape: tuple[int, ...], weights: np.ndarray, **fields: int
) -> tuple[Any, ...]:
    bias = np.linspace(-1, 1, weights.shape[0]).astype(np.float32)
    options = {**STRIDE_1, "Padding": VALID, **fields}
    return ("CONV_2D", [source, weights, bias], out, shape, "Conv2DOptions", options)


@pytest.mark.parametrize(
    ("size", "kernel", "stride", "dilation"),
    [(8, 3, 2, 1), (9, 3, 2, 1), (8, 5, 2, 1), (7, 2, 2, 1), (8, 3, 1, 1), (8, 3, 1, 2)],
)
def test_same_padding(
    check: Callable[..., Any], size: int, kernel: int, stride: int, dilation: int
) -> None:
    out = -(-size // stride)
    fields = {"StrideH": stride, "StrideW": stride, "Padding": SAME}
    fields |= {"DilationHFactor": dilation, "DilationWFactor": dilation}
    check(
        [_conv("input", "out", (1, out, out, 4), _random(4, kernel, kernel, 3), **fields)],
        shape=(1, size, size, 3),
    )


def test_odd_rest_of_same_padding_goes_to_the_end(check: Callable[..., Any]) -> None:
    image = np.array([1, 2, 3, 4], np.float32).reshape(1, 1, 4, 1)
    conv = _conv(
        "input", "out", (1, 1, 2, 1), np.ones((1, 1, 3, 1), np.float32), StrideW=2, Padding=SAME
    )
    conv[1][2] = np.zeros(1, np.float32)
    np.testing.assert_array_equal(check([conv], image).ravel(), [1 + 2 + 3, 3 + 4])


@pytest.mark.parametrize("activation", [0, RELU, RELU6])
def test_conv_with_fused_activation(check: Callable[..., Any], activation: int) -> None:
    check(
        [
            _conv(
                "input",
                "out",
                (1, 6, 6, 5),
                _random(5, 3, 3, 3),
                FusedActivationFunction=activation,
            )
        ]
    )


@pytest.mark.parametrize(("channels", "multiplier"), [(3, 1), (3, 2)])
def test_depthwise_conv(check: Callable[..., Any], channels: int, multiplier: int) -> None:
    out = channels * multiplier
    options = {"StrideH": 2, "StrideW": 2, "Padding": SAME, "DepthMultiplier": multiplier}
    inputs = ["input", _random(1, 3, 3, out), _random(out)]
    check(
        [
            (
                "DEPTHWISE_CONV_2D",
                inputs,
                "out",
                (1, 4, 4, out),
                "DepthwiseConv2DOptions",
                options,
            )
        ],
        shape=(1, 8, 8, channels),
    )


@pytest.mark.parametrize(("size", "padding"), [(8, VALID), (7, SAME)])
def test_max_pool(check: Callable[..., Any], size: int, padding: int) -> None:
    options = {"StrideH": 2, "StrideW": 2, "FilterHeight": 2, "FilterWidth": 2, "Padding": padding}
    pool = ("MAX_POOL_2D", ["input"], "out", (1, 4, 4, 3), "Pool2DOptions", options)
    check([pool], shape=(1, size, size, 3))


def test_pad_before_convolutions_becomes_their_padding(check: Callable[..., Any]) -> None:
    amounts = np.array([[0, 0], [0, 2], [1, 0], [0, 0]], np.int32)
    check(
        [
            ("PAD", ["input", amounts], "padded", (1, 10, 9, 3), "PadOptions"),
            _conv("padded", "a", (1, 8, 7, 2), _random(2, 3, 3, 3)),
            _conv("padded", "b", (1, 8, 7, 2), _random(2, 3, 3, 3)),
            ("ADD", ["a", "b"], "out", (1, 8, 7, 2), "AddOptions"),
        ]
    )


def test_pad_of_channels(check: Callable[..., Any]) -> None:
    amounts = np.array([[0, 0], [0, 0], [1, 0], [0, 5]], np.int32)
    padded = check([("PAD", ["input", amounts], "out", (1, 8, 9, 8), "PadOptions")])
    assert not padded[..., 3:].any()
    assert not padded[:, :, 0].any()


def test_pad_that_others_use_too_is_kept(check: Callable[..., Any]) -> None:
    amounts = np.array([[0, 0], [1, 1], [1, 1], [0, 0]], np.int32)
    check(
        [
            ("PAD", ["input", amounts], "padded", (1, 10, 10, 3), "PadOptions"),
            _conv("padded", "a", (1, 10, 10, 3), _random(3, 1, 1, 3)),
            ("ADD", ["a", "padded"], "out", (1, 10, 10, 3), "AddOptions"),
        ]
    )


def test_prelu_with_slopes_on_both_sides_of_one(check: Callable[..., Any]) -> None:
    image = np.array([-2.0, -2.0, -2.0, -2.0, 3.0, 3.0, 3.0, 3.0], np.float32).reshape(1, 1, 2, 4)
    slopes = np.array([[[0.0, 0.25, 1.0, 1.5]]], np.float32)
    found = check([("PRELU", ["input", slopes], "out", (1, 1, 2, 4))], image)
    np.testing.assert_allclose(found[0, 0], [[0, -0.5, -2, -3], [3, 3, 3, 3]], rtol=1e-6)


def test_prelu_on_random_values(check: Callable[..., Any]) -> None:
    check([("PRELU", ["input", _random(1, 1, 3)], "out", (1, 8, 8, 3))])


def test_depth_to_space_takes_blocks_before_channels(check: Callable[..., Any]) -> None:
    # One pixel of 2 x 2 x 2 channels: rows of the block first, then columns, then channels.
    image = np.arange(8, dtype=np.float32).reshape(1, 1, 1, 8)
    d2s = ("DEPTH_TO_SPACE", ["input"], "out", (1, 2, 2, 2), "DepthToSpaceOptions")
    found = check([(*d2s, {"BlockSize": 2})], image)
    np.testing.assert_array_equal(found[0], [[[0, 1], [2, 3]], [[4, 5], [6, 7]]])


def _resize(out: str, side: int, channels: int = 3) -> tuple[Any, ...]:
    sizes = np.array([side, side], np.int32)
    return (
        "RESIZE_BILINEAR",
        ["input", sizes],
        out,
        (1, side, side, channels),
        "ResizeBilinearOptions",
        {"HalfPixelCenters": 1},
    )


@pytest.mark.parametrize("factor", [2, 3])
def test_resize_bilinear(check: Callable[..., Any], factor: int) -> None:
    check([_resize("out", 8 * factor)])


def test_resize_by_two_mixes_one_to_three(check: Callable[..., Any]) -> None:
    image = np.array([[0.0, 4.0], [0.0, 4.0]], np.float32).reshape(1, 2, 2, 1)
    found = check([_resize("out", 4, channels=1)], image)
    np.testing.assert_allclose(found[0, 0, :, 0], [0, 1, 3, 4])


@pytest.mark.parametrize("activation", [0, RELU6])
def test_resize_and_pointwise_convolution_swap_places(
    check: Callable[..., Any], activation: int
) -> None:
    check(
        [
            _resize("large", 16),
            _conv(
                "large",
                "out",
                (1, 16, 16, 5),
                _random(5, 1, 1, 3),
                FusedActivationFunction=activation,
            ),
        ]
    )


def test_resize_before_a_wide_convolution_stays(check: Callable[..., Any]) -> None:
    check([_resize("large", 16), _conv("large", "out", (1, 14, 14, 5), _random(5, 3, 3, 3))])


@pytest.mark.parametrize("shape", [(1, 192), (1, 64, 3), (1, 32, 6)])
def test_reshape_reads_channels_last(check: Callable[..., Any], shape: tuple[int, ...]) -> None:
    target = np.array(shape, np.int32)
    reshape = ("RESHAPE", ["input", target], "out", shape, "ReshapeOptions")
    image = np.arange(192, dtype=np.float32).reshape(1, 8, 8, 3)
    np.testing.assert_array_equal(check([reshape], image).ravel(), np.arange(192))


@pytest.mark.parametrize(
    ("axis", "shape"), [(1, (1, 16, 8, 3)), (2, (1, 8, 16, 3)), (-1, (1, 8, 8, 6))]
)
def test_concatenation_along_any_axis(
    check: Callable[..., Any], axis: int, shape: tuple[int, ...]
) -> None:
    concat = ("CONCATENATION", ["a", "input"], "out", shape, "ConcatenationOptions")
    logistic = ("LOGISTIC", ["input"], "a", (1, 8, 8, 3))
    check([logistic, (*concat, {"Axis": axis})])


def test_mean_then_fully_connected(check: Callable[..., Any]) -> None:
    check(
        [
            ("MEAN", ["input", np.array([1, 2], np.int32)], "mean", (1, 3), "ReducerOptions"),
            (
                "FULLY_CONNECTED",
                ["mean", _random(5, 3), _random(5)],
                "out",
                (1, 5),
                "FullyConnectedOptions",
                {"FusedActivationFunction": RELU},
            ),
        ]
    )


def test_add_with_fused_activation(check: Callable[..., Any]) -> None:
    check(
        [
            (
                "ADD",
                ["input", "input"],
                "out",
                (1, 8, 8, 3),
                "AddOptions",
                {"FusedActivationFunction": RELU6},
            )
        ]
    )


def test_half_precision_weights_are_widened(check: Callable[..., Any]) -> None:
    conv = _conv("input", "out", (1, 8, 8, 2), _random(2, 1, 1, 3))
    weights = conv[1][1].astype(np.float16)
    conv[1][1] = "wide"
    check([("DEQUANTIZE", [weights], "wide", (2, 1, 1, 3)), conv])


def test_sparse_weights_are_filled_with_zeros(
    check: Callable[..., Any], sparse_constant: Callable[..., Any]
) -> None:
    # Output channel 0 sees input channels 0 and 2, output channel 1 sees channel 1.
    layout = Sparsity(
        [0, 1, 2, 3],
        [],
        [
            SparseLevel(2),
            SparseLevel(1),
            SparseLevel(1),
            SparseLevel(0, np.array([0, 2, 3]), np.array([0, 2, 1])),
        ],
    )
    values = np.array([10, 1, 100], np.float32)
    conv = _conv("input", "out", (1, 1, 1, 2), np.zeros((2, 1, 1, 3), np.float32))
    conv[1][1:] = ["dense", np.zeros(2, np.float32)]
    densify = ("DENSIFY", [sparse_constant(values, (2, 1, 1, 3), layout)], "dense", (2, 1, 1, 3))
    image = np.array([1, 2, 3], np.float32).reshape(1, 1, 1, 3)
    np.testing.assert_array_equal(check([densify, conv], image).ravel(), [13, 200])
