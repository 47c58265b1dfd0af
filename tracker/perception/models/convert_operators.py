"""What does each TFLite operator become in ONNX?

TFLite keeps channels last (N, H, W, C); here every value of rank 4 is channels first. Values of
other ranks are left as they are, so a change of rank goes through a transpose.
"""

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
import tflite
from numpy.typing import NDArray

from tracker.perception.models.conversion import Conversion, unsupported
from tracker.perception.models.tflite_graph import Operator

_CHANNELS_LAST = (0, 2, 3, 1)
_CHANNELS_FIRST_AXIS = {0: 0, 1: 2, 2: 3, 3: 1}


def _convert_conv(conversion: Conversion, operator: Operator) -> None:
    weights = conversion.constant(operator.inputs[1], operator)  # (out, height, width, in)
    _convolve(conversion, operator, weights.transpose(0, 3, 1, 2))


def _convert_depthwise_conv(conversion: Conversion, operator: Operator) -> None:
    weights = conversion.constant(operator.inputs[1], operator)  # (1, height, width, out)
    _convolve(conversion, operator, weights.transpose(3, 0, 1, 2))


def _convolve(conversion: Conversion, operator: Operator, weights: NDArray[Any]) -> None:
    """Convolve with weights of shape (out, in per group, height, width)."""
    source, _, bias = operator.inputs
    options = operator.options
    out = f"t{operator.outputs[0]}"
    dilations = [options.DilationHFactor(), options.DilationWFactor()]
    reach = [d * (k - 1) + 1 for d, k in zip(dilations, weights.shape[2:], strict=True)]
    pads = _window_pads(conversion, operator, reach)
    owed = conversion.pads.get(source, (0, 0, 0, 0))
    value = conversion.add_node(
        "Conv",
        [
            conversion.names[source],
            conversion.add_constant(f"{out}_weights", weights),
            conversion.add_constant(f"{out}_bias", conversion.constant(bias, operator)),
        ],
        out,
        kernel_shape=weights.shape[2:],
        strides=[options.StrideH(), options.StrideW()],
        dilations=dilations,
        pads=[p + q for p, q in zip(pads, owed, strict=True)],
        group=conversion.shape(source)[3] // weights.shape[1],
    )
    if source in conversion.scales:
        value = _enlarge(conversion, value, conversion.scales[source])
    conversion.finish(operator, value, options.FusedActivationFunction())


def _convert_max_pool(conversion: Conversion, operator: Operator) -> None:
    options = operator.options
    window = [options.FilterHeight(), options.FilterWidth()]
    value = conversion.add_node(
        "MaxPool",
        [conversion.names[operator.inputs[0]]],
        f"t{operator.outputs[0]}",
        kernel_shape=window,
        strides=[options.StrideH(), options.StrideW()],
        pads=_window_pads(conversion, operator, window),
    )
    conversion.finish(operator, value, options.FusedActivationFunction())


def _window_pads(
    conversion: Conversion, operator: Operator, window: Sequence[int]
) -> tuple[int, int, int, int]:
    """Padding (top, left, bottom, right) of a convolution or a pooling.

    SAME means an output of ceil(input / stride); an odd rest goes to the bottom and the right.
    With a free size it is right for all inputs the stride divides, so others are refused.
    """
    options = operator.options
    if options.Padding() == tflite.Padding.VALID:
        return (0, 0, 0, 0)
    if operator.inputs[0] in conversion.pads:
        raise unsupported(operator, "SAME padding after a PAD")
    before, after = [], []
    size = conversion.shape(operator.inputs[0])[1:3]
    for length, reach, stride in zip(
        size, window, (options.StrideH(), options.StrideW()), strict=True
    ):
        if conversion.size_is_free and length % stride:
            raise unsupported(operator, f"stride {stride} on {length} pixels with a free size")
        total = max((-(-length // stride) - 1) * stride + reach - length, 0)
        before.append(total // 2)
        after.append(total - total // 2)
    return (before[0], before[1], after[0], after[1])


def _convert_pad(conversion: Conversion, operator: Operator) -> None:
    source, output = operator.inputs[0], operator.outputs[0]
    amounts = conversion.constant(operator.inputs[1], operator)
    if amounts.shape != (4, 2):
        raise unsupported(operator, f"padding of shape {amounts.shape}")
    (n0, n1), (top, bottom), (left, right), (c0, c1) = amounts.tolist()
    if not (n0 or n1 or c0 or c1) and conversion.only_feeds(output, _is_unpadded_convolution):
        conversion.names[output] = conversion.names[source]
        conversion.pads[output] = (top, left, bottom, right)
        return
    pads = np.array([n0, c0, top, left, n1, c1, bottom, right], np.int64)
    out = f"t{output}"
    name = conversion.add_constant(f"{out}_pads", pads)
    conversion.finish(operator, conversion.add_node("Pad", [conversion.names[source], name], out))


def _is_unpadded_convolution(_: Conversion, operator: Operator) -> bool:
    return (
        operator.kind in ("CONV_2D", "DEPTHWISE_CONV_2D")
        and operator.options.Padding() == tflite.Padding.VALID
    )


def _convert_prelu(conversion: Conversion, operator: Operator) -> None:
    """Write PReLU(x) as a x + (1 - a) relu(x), each product a 1x1 depthwise convolution.

    ONNX Runtime has no PRelu kernel for its blocked channel layout and would leave and enter that
    layout around each one: 14 of 39 ms of the palm model.
    """
    source = operator.inputs[0]
    slope = conversion.constant(operator.inputs[1], operator)
    channels = conversion.shape(source)[-1]
    if len(conversion.shape(source)) != 4 or slope.size != channels:
        raise unsupported(operator, f"slope of shape {slope.shape}")
    slope = slope.reshape(channels, 1, 1, 1)
    out = f"t{operator.outputs[0]}"
    x = conversion.names[source]
    relu = conversion.add_node("Relu", [x], f"{out}_relu")
    parts = []
    for part, value, factor in (("whole", x, slope), ("positive", relu, 1.0 - slope)):
        weights = conversion.add_constant(f"{out}_{part}_weights", factor.astype(np.float32))
        parts.append(
            conversion.add_node(
                "Conv", [value, weights], f"{out}_{part}", kernel_shape=[1, 1], group=channels
            )
        )
    conversion.finish(operator, conversion.add_node("Add", parts, out))


def _convert_add(conversion: Conversion, operator: Operator) -> None:
    a, b = operator.inputs
    if conversion.shape(a) != conversion.shape(b):
        raise unsupported(operator, f"shapes {conversion.shape(a)} and {conversion.shape(b)}")
    if a in conversion.constants or b in conversion.constants:
        raise unsupported(operator, "a constant term")
    value = conversion.add_node(
        "Add", [conversion.names[a], conversion.names[b]], f"t{operator.outputs[0]}"
    )
    conversion.finish(operator, value, operator.options.FusedActivationFunction())


def _convert_resize_bilinear(conversion: Conversion, operator: Operator) -> None:
    options = operator.options
    if options.AlignCorners() or not options.HalfPixelCenters():
        raise unsupported(operator, "pixel centers other than half-pixel")
    source, output = operator.inputs[0], operator.outputs[0]
    (height, width), (new_height, new_width) = (
        conversion.shape(source)[1:3],
        conversion.shape(output)[1:3],
    )
    if new_height % height or new_width % width:
        raise unsupported(operator, f"from {height}x{width} to {new_height}x{new_width}")
    scales = (new_height / height, new_width / width)
    value = conversion.names[source]
    if conversion.only_feeds(output, _is_pointwise):
        # Weighing neighbors and weighing channels can swap places; the convolution then has a
        # quarter of the pixels: 4 % of the palm model's time, 10 % of the pose detector's.
        conversion.names[output] = value
        conversion.scales[output] = scales
    else:
        conversion.finish(operator, _enlarge(conversion, value, scales))


def _is_pointwise(conversion: Conversion, operator: Operator) -> bool:
    if operator.kind != "CONV_2D":
        return False
    options = operator.options
    window = conversion.shape(operator.inputs[1])[1:3]
    return window == (1, 1) and options.StrideH() == options.StrideW() == 1


def _enlarge(conversion: Conversion, value: str, scales: tuple[float, float]) -> str:
    factors = np.array([1, 1, *scales], np.float32)
    return conversion.add_node(
        "Resize",
        [value, "", conversion.add_constant(f"{value}_scales", factors)],
        f"{value}_enlarged",
        mode="linear",
        coordinate_transformation_mode="half_pixel",
    )


def _convert_concatenation(conversion: Conversion, operator: Operator) -> None:
    rank = len(conversion.shape(operator.outputs[0]))
    axis = operator.options.Axis() % rank
    value = conversion.add_node(
        "Concat",
        [conversion.names[index] for index in operator.inputs],
        f"t{operator.outputs[0]}",
        axis=_CHANNELS_FIRST_AXIS[axis] if rank == 4 else axis,
    )
    conversion.finish(operator, value, operator.options.FusedActivationFunction())


def _convert_reshape(conversion: Conversion, operator: Operator) -> None:
    source, output = operator.inputs[0], operator.outputs[0]
    before, after = conversion.shape(source), conversion.shape(output)
    if before[0] != after[0] or len(after) not in (2, 3):
        raise unsupported(operator, f"from shape {before} to {after}")
    out = f"t{output}"
    value = conversion.names[source]
    if len(before) == 4:
        value = conversion.add_node(
            "Transpose", [value], f"{out}_channels_last", perm=_CHANNELS_LAST
        )
    # 0 keeps the batch, -1 is what remains: the anchors, whose number depends on the input's size.
    target = np.array([0, -1, *after[2:]], np.int64)
    name = conversion.add_constant(f"{out}_shape", target)
    conversion.finish(operator, conversion.add_node("Reshape", [value, name], out))


def _convert_fully_connected(conversion: Conversion, operator: Operator) -> None:
    source, weights, bias = operator.inputs
    options = operator.options
    if len(conversion.shape(source)) != 2 or options.WeightsFormat():
        raise unsupported(operator, f"input of shape {conversion.shape(source)}")
    out = f"t{operator.outputs[0]}"
    value = conversion.add_node(
        "Gemm",
        [
            conversion.names[source],
            conversion.add_constant(f"{out}_weights", conversion.constant(weights, operator)),
            conversion.add_constant(f"{out}_bias", conversion.constant(bias, operator)),
        ],
        out,
        transB=1,
    )
    conversion.finish(operator, value, options.FusedActivationFunction())


def _convert_mean(conversion: Conversion, operator: Operator) -> None:
    axes = sorted(np.atleast_1d(conversion.constant(operator.inputs[1], operator)).tolist())
    if axes != [1, 2] or operator.options.KeepDims():
        raise unsupported(operator, f"axes {axes}")
    out = f"t{operator.outputs[0]}"
    value = conversion.add_node(
        "GlobalAveragePool", [conversion.names[operator.inputs[0]]], f"{out}_pooled"
    )
    conversion.finish(operator, conversion.add_node("Flatten", [value], out, axis=1))


def _convert_depth_to_space(conversion: Conversion, operator: Operator) -> None:
    value = conversion.add_node(
        "DepthToSpace",
        [conversion.names[operator.inputs[0]]],
        f"t{operator.outputs[0]}",
        blocksize=operator.options.BlockSize(),
        mode="DCR",
    )
    conversion.finish(operator, value)


def _convert_logistic(conversion: Conversion, operator: Operator) -> None:
    value = conversion.add_node(
        "Sigmoid", [conversion.names[operator.inputs[0]]], f"t{operator.outputs[0]}"
    )
    conversion.finish(operator, value)


CONVERTERS: dict[str, Callable[[Conversion, Operator], None]] = {
    "ADD": _convert_add,
    "CONCATENATION": _convert_concatenation,
    "CONV_2D": _convert_conv,
    "DEPTHWISE_CONV_2D": _convert_depthwise_conv,
    "DEPTH_TO_SPACE": _convert_depth_to_space,
    "FULLY_CONNECTED": _convert_fully_connected,
    "LOGISTIC": _convert_logistic,
    "MAX_POOL_2D": _convert_max_pool,
    "MEAN": _convert_mean,
    "PAD": _convert_pad,
    "PRELU": _convert_prelu,
    "RESHAPE": _convert_reshape,
    "RESIZE_BILINEAR": _convert_resize_bilinear,
}
