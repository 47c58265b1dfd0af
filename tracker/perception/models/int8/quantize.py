"""How does a model compute in 8 bits? Its inverted residuals do, the stream between does not.

A model of the MobileNet family is a thin stream of values to which blocks add: a convolution that
widens it, one that looks around in each channel, and one that makes it thin again. Inside of a
block values lie between 0 and 6 and bear 8 bits; the stream stays in single precision, since what
is lost there is lost to all blocks that follow. A channel of the wide part that does not reach 6
is stretched until it does, and shrunk again where it is looked around in. A processor with
instructions for 8-bit products does such a block in less than half the time.

Source: Jacob et al., "Quantization and Training of Neural Networks for Efficient
    Integer-Arithmetic-Only Inference", CVPR 2018; stretching and shifts: Nagel et al., "Data-Free
    Quantization Through Weight Equalization and Bias Correction", ICCV 2019.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any, NamedTuple

import numpy as np
import onnx
from numpy.typing import NDArray
from onnx import helper, numpy_helper

#: ONNX Runtime's own operators; the fast kernels want channels last.
_RUNTIME_DOMAIN = "com.microsoft"
_LAST, _FIRST = (0, 2, 3, 1), (0, 3, 1, 2)
#: Where blocks clip, and what a clipped value of 255 means.
CLIPPED_AT = 6.0
_STEP = np.float32(CLIPPED_AT / 255.0)
#: Biases are counted in 32 bits; a channel of tiny weights must not overflow them.
_BIAS_MAX = 2.0**30


class BlockRange(NamedTuple):
    """What was measured of one block.

    Attributes:
        low: Least value of the stream where the block reads it; not above 0.
        high: The largest one; not below 0.
        reach: Shape (W,): up to which value each channel of its wide part counts; in (0, 6].
        shift: Shape (C,): what its output lacks on average, by channel, after what blocks before
            it lack was made up for.
    """

    low: float
    high: float
    reach: NDArray[np.float16]
    shift: NDArray[np.float32]


class Block(NamedTuple):
    """An inverted residual: the nodes that widen the stream, look around, and make it thin."""

    widen: onnx.NodeProto
    around: onnx.NodeProto
    narrow: onnx.NodeProto

    @property
    def name(self) -> str:
        """That of its output."""
        return str(self.narrow.output[0])


def find_blocks(graph: onnx.GraphProto) -> Iterator[Block]:
    """The inverted residuals whose inner values nothing else reads, in the order of the graph."""
    readers: dict[str, list[onnx.NodeProto]] = {}
    for node in graph.node:
        for name in node.input:
            readers.setdefault(name, []).append(node)
    outputs = {output.name for output in graph.output}

    def only_reader(node: onnx.NodeProto, kind: str) -> onnx.NodeProto | None:
        found = readers.get(node.output[0], [])
        alone = len(found) == 1 and node.output[0] not in outputs
        return found[0] if alone and found[0].op_type == kind else None

    for widen in graph.node:
        if widen.op_type != "Conv" or not _is_pointwise(widen):
            continue
        chain: list[onnx.NodeProto] = [widen]
        for kind in ("Clip", "Conv", "Clip", "Conv"):
            follower = only_reader(chain[-1], kind)
            if follower is None:
                break
            chain.append(follower)
        if len(chain) == 5 and _number(chain[2], "group") > 1 and _is_pointwise(chain[4]):
            yield Block(widen, chain[2], chain[4])


def quantize(content: bytes, ranges: Mapping[str, BlockRange]) -> bytes:
    """An ONNX file of which some blocks compute in 8 bits.

    Args:
        content: The file of `convert_tflite`.
        ranges: By the name of a block, for those that do.
    """
    model = onnx.load_from_string(content)
    graph = model.graph
    constants = {item.name: numpy_helper.to_array(item) for item in graph.initializer}
    replaced: dict[str, list[onnx.NodeProto]] = {}
    dropped: set[str] = set()
    for block in find_blocks(graph):
        if block.name in ranges:
            replaced[block.name] = _in_bytes(block, ranges[block.name], constants)
            dropped |= {block.widen.output[0], block.around.output[0]}
    nodes = []
    for node in graph.node:
        is_inside = node.output[0] in dropped or (
            node.op_type == "Clip" and node.input[0] in dropped
        )
        if not is_inside:
            nodes += replaced.get(node.output[0], [node])
    used = {name for node in nodes for name in node.input}
    del graph.node[:], graph.initializer[:]
    graph.node.extend(nodes)
    graph.initializer.extend(
        numpy_helper.from_array(values, name) for name, values in constants.items() if name in used
    )
    model.opset_import.append(helper.make_opsetid(_RUNTIME_DOMAIN, 1))
    quantized: bytes = model.SerializeToString(deterministic=True)
    return quantized


def _in_bytes(
    block: Block, measured: BlockRange, constants: dict[str, NDArray[Any]]
) -> list[onnx.NodeProto]:
    """The nodes that do a block's work; their constants are added."""
    widen, around, narrow = block
    step = np.float32((measured.high - measured.low) / 255.0)
    zero = np.uint8(np.rint(-measured.low / step))

    def constant(name: str, values: Any) -> str:
        constants[name] = np.asarray(values)
        return name

    inner = (constant("inner_step", _STEP), constant("inner_zero", np.uint8(0)))
    stretch = (CLIPPED_AT / measured.reach.astype(np.float32))[:, None, None, None]

    def convolution(
        node: onnx.NodeProto,
        weights: NDArray[Any],
        bias: NDArray[Any],
        source: str,
        step: np.float32,
        read: tuple[str, str],
    ) -> onnx.NodeProto:
        name = node.output[0]
        weights, scale, bias = _rounded(weights, bias, step)
        inputs = [
            *(source, *read),
            *(constant(f"{name}_bytes", weights), constant(f"{name}_scale", scale)),
            constant(f"{name}_middle", np.zeros_like(scale, dtype=np.int8)),
            *(*inner, constant(f"{name}_counts", bias)),
        ]
        return helper.make_node(
            "QLinearConv",
            inputs,
            [f"{name}_q"],
            domain=_RUNTIME_DOMAIN,
            channels_last=1,
            **{item.name: helper.get_attribute_value(item) for item in node.attribute},
        )

    widening = constants[widen.input[1]] * stretch, constants[widen.input[2]] * stretch.ravel()
    looking = constants[around.input[1]] / stretch, constants[around.input[2]]
    name, source = narrow.output[0], widen.input[0]
    read = (constant(f"{name}_read_step", step), constant(f"{name}_read_zero", zero))
    weights, scale, _ = _rounded(
        constants[narrow.input[1]][:, :, 0, 0], constants[narrow.input[2]], None
    )
    product = [
        *(f"{around.output[0]}_q", constant(f"{name}_bytes", np.ascontiguousarray(weights.T))),
        *(inner[0], constant(f"{name}_scale", scale), inner[1]),
        constant(f"{name}_middle", np.zeros_like(scale, dtype=np.int8)),
        constant(f"{name}_shifted", constants[narrow.input[2]] + measured.shift),
    ]
    return [
        helper.make_node("Transpose", [source], [f"{name}_read"], perm=_LAST),
        helper.make_node("QuantizeLinear", [f"{name}_read", *read], [f"{name}_read_q"]),
        convolution(widen, *widening, f"{name}_read_q", step, read),
        convolution(around, *looking, f"{widen.output[0]}_q", _STEP, inner),
        helper.make_node(
            "MatMulIntegerToFloat", product, [f"{name}_last"], domain=_RUNTIME_DOMAIN
        ),
        helper.make_node("Transpose", [f"{name}_last"], [name], perm=_FIRST),
    ]


def _rounded(
    weights: NDArray[Any], bias: NDArray[Any], step: np.float32 | None
) -> tuple[NDArray[np.int8], NDArray[np.float32], NDArray[np.int32]]:
    """Weights, (out, ...), as bytes times a scale of each output; biases as counts of steps."""
    flat = weights.reshape(len(weights), -1)
    scale = np.maximum(np.abs(flat).max(axis=1) / 127.0, 1e-12)
    counts = np.zeros(len(bias))
    if step is not None:
        scale = np.maximum(scale, np.abs(bias) / (step * _BIAS_MAX))
        counts = np.rint(bias / (step * scale.astype(np.float32)))
    rounded = np.rint(flat / scale[:, None]).reshape(weights.shape)
    return rounded.astype(np.int8), scale.astype(np.float32), counts.astype(np.int32)


def _is_pointwise(node: onnx.NodeProto) -> bool:
    kernel = next(item.ints for item in node.attribute if item.name == "kernel_shape")
    strides = next(item.ints for item in node.attribute if item.name == "strides")
    return {*kernel, *strides} == {1} and _number(node, "group") == 1


def _number(node: onnx.NodeProto, name: str) -> int:
    return int(next(item.i for item in node.attribute if item.name == name))
