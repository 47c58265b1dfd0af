"""Blocks in 8 bits: found, as exact as 8 bits are, and no more than they should be."""

import numpy as np
import onnx
import onnxruntime
import pytest
from onnx import TensorProto, helper, numpy_helper

from tracker.perception.models import ModelStore
from tracker.perception.models.catalog import INT8_MODELS, INT8_SUFFIX
from tracker.perception.models.int8.quantize import BlockRange, find_blocks, quantize
from tracker.perception.models.int8.ranges import load_ranges

CHANNELS, WIDE, SIDE = 8, 24, 10


def _convolution(name: str, source: str, group: int = 1, kernel: int = 1) -> onnx.NodeProto:
    pad = kernel // 2
    return helper.make_node(
        "Conv",
        [source, f"{name}_weights", f"{name}_bias"],
        [name],
        kernel_shape=[kernel, kernel],
        strides=[1, 1],
        dilations=[1, 1],
        pads=[pad] * 4,
        group=group,
    )


def _clip(source: str) -> onnx.NodeProto:
    return helper.make_node("Clip", [source, "zero", "six"], [f"{source}_relu6"])


def _residual(*, shown: str = "out", loud: float = 1.0) -> bytes:
    """One inverted residual on a stream, channels first.

    Its output is `shown`, and its wide part so `loud`.
    """
    rng = np.random.default_rng(5)
    nodes = [
        _convolution("wide", "image"),
        _clip("wide"),
        _convolution("around", "wide_relu6", group=WIDE, kernel=3),
        _clip("around"),
        _convolution("narrow", "around_relu6"),
        helper.make_node("Add", ["narrow", "image"], ["out"]),
    ]
    constants = {"zero": np.float32(0), "six": np.float32(6)}
    for name, shape in (
        ("wide", (WIDE, CHANNELS, 1, 1)),
        ("around", (WIDE, 1, 3, 3)),
        ("narrow", (CHANNELS, WIDE, 1, 1)),
    ):
        constants[f"{name}_weights"] = rng.normal(0, 0.5, shape).astype(np.float32)
        constants[f"{name}_bias"] = rng.normal(1, 0.5, shape[0]).astype(np.float32)
    for part in ("weights", "bias"):
        constants[f"wide_{part}"] *= np.float32(loud)
    constants["wide_weights"][3] = 0.0  # a channel that says the same everywhere
    ends = [
        helper.make_tensor_value_info(name, TensorProto.FLOAT, ["batch", channels, SIDE, SIDE])
        for name, channels in (("image", CHANNELS), (shown, None))
    ]
    graph = helper.make_graph(
        nodes,
        "residual",
        ends[:1],
        ends[1:],
        [numpy_helper.from_array(np.asarray(value), name) for name, value in constants.items()],
    )
    model = helper.make_model(graph, opset_imports=[helper.make_opsetid("", 17)], ir_version=8)
    helper.set_model_props(model, {"source_sha256": "of the source"})
    return model.SerializeToString()


def _run(content: bytes, image: np.ndarray) -> np.ndarray:
    session = onnxruntime.InferenceSession(content, providers=["CPUExecutionProvider"])
    return session.run(None, {"image": image})[0]


def _image() -> np.ndarray:
    values = np.random.default_rng(6).uniform(-2, 3, (1, CHANNELS, SIDE, SIDE))
    return values.astype(np.float32)


def _range(shift: float = 0.0, reach: float = 6.0) -> dict[str, BlockRange]:
    reaches = np.full(WIDE, reach, np.float16)
    return {"narrow": BlockRange(-2.0, 3.0, reaches, np.full(CHANNELS, shift, np.float32))}


def test_a_block_in_bytes_says_nearly_the_same() -> None:
    plain = _residual()
    expected, found = _run(plain, _image()), _run(quantize(plain, _range()), _image())
    # A step of an inner value is 6 / 255; some 24 of them add up.
    assert 0.0 < np.abs(found - expected).max() < 0.25
    assert np.abs(found - expected).mean() < 0.05


def test_a_shift_is_added_to_each_channel() -> None:
    plain = _residual()
    found, shifted = (_run(quantize(plain, _range(shift)), _image()) for shift in (0.0, 0.5))
    np.testing.assert_allclose(shifted - found, 0.5, atol=1e-5)


def test_channels_that_reach_less_far_are_told_in_finer_steps() -> None:
    plain, step = _residual(loud=0.01), np.float32(5.0 / 255.0)
    image = np.rint(_image() / step) * step  # so that nothing is lost where it is read
    expected = _run(plain, image)
    coarse, fine = (
        np.abs(_run(quantize(plain, _range(reach=reach)), image) - expected).mean()
        for reach in (6.0, 0.1)
    )
    assert 0.0 < fine < 0.8 * coarse  # what is left comes of what follows


def test_values_beyond_the_reach_are_cut_to_it() -> None:
    plain = _residual()
    far, near = (_run(quantize(plain, _range(reach=reach)), _image()) for reach in (6.0, 1e-3))
    nothing_wide = _run(quantize(_residual(loud=0.0), _range()), _image())
    assert np.abs(far - nothing_wide).max() > 1.0
    np.testing.assert_allclose(near, nothing_wide, atol=0.02)


def test_values_beyond_the_range_are_cut_to_it() -> None:
    content = quantize(_residual(), _range())
    inside, outside = _image(), _image()
    inside[0, :, 2, 2], outside[0, :, 2, 2] = 3.0, 30.0
    found = _run(content, outside) - outside  # less the stream, which is not cut
    np.testing.assert_allclose(found, _run(content, inside) - inside, atol=1e-4)


def test_a_block_that_was_not_measured_stays_as_it_is() -> None:
    plain = _residual()
    np.testing.assert_array_equal(_run(quantize(plain, {}), _image()), _run(plain, _image()))


def test_a_block_whose_inside_is_shown_is_none() -> None:
    assert [b.name for b in find_blocks(onnx.load_from_string(_residual()).graph)] == ["narrow"]
    shown = onnx.load_from_string(_residual(shown="around_relu6"))
    assert not list(find_blocks(shown.graph))


def test_where_a_file_comes_from_stays_written_in_it() -> None:
    model = onnx.load_from_string(quantize(_residual(), _range()))
    assert [(item.key, item.value) for item in model.metadata_props] == [
        ("source_sha256", "of the source")
    ]


@pytest.mark.model
@pytest.mark.parametrize("name", INT8_MODELS)
def test_what_was_measured_belongs_to_blocks_of_the_model(
    name: str, model_store: ModelStore
) -> None:
    graph = onnx.load(model_store.path(name)).graph
    channels = {
        block.name: next(
            item.dims[0] for item in graph.initializer if item.name == block.narrow.input[1]
        )
        for block in find_blocks(graph)
    }
    ranges = load_ranges(name)
    assert len(ranges) >= 8
    for block, found in ranges.items():
        assert found.low <= 0.0 < found.high
        assert 0.0 < found.reach.min() <= found.reach.max() <= 6.0
        assert found.shift.shape == (channels[block],)


@pytest.mark.model
@pytest.mark.parametrize("name", INT8_MODELS)
def test_the_stored_file_is_the_quantized_one(name: str, model_store: ModelStore) -> None:
    made = quantize(model_store.path(name).read_bytes(), load_ranges(name))
    stored = onnx.load(model_store.path(name + INT8_SUFFIX))
    made_nodes = [node.op_type for node in onnx.load_from_string(made).graph.node]
    assert [node.op_type for node in stored.graph.node] == made_nodes
    assert made_nodes.count("QLinearConv") == 2 * len(load_ranges(name))
