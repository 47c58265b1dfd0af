"""The six real models against LiteRT."""

from collections.abc import Callable
from typing import Any

import numpy as np
import onnxruntime
import pytest
import tflite

from tracker.perception.models import MODELS, ModelEntry, ModelStore, find_model

pytestmark = pytest.mark.model

Outputs = dict[str, np.ndarray]
Litert = Callable[[bytes, np.ndarray], Outputs]

# Largest difference allowed: about three to ten times the largest seen over 26 images (noise,
# smooth noise, flat, photos), which is single precision at work. A wrong pad or layout shows as 1
# or more.
_TOLERANCES = {
    "palm_detection": {"boxes": 2e-3, "scores": 5e-4},
    "hand_landmark": {
        "landmarks": 2e-3,
        "presence": 1e-5,
        "handedness": 2e-5,
        "world_landmarks": 5e-6,
    },
    "pose_detection": {"boxes": 1e-2, "scores": 3e-3},
    "pose_landmark": {"landmarks": 3e-2, "presence": 1e-4, "world_landmarks": 5e-4},
}

each_model = pytest.mark.parametrize(
    "entry", [entry for entry in MODELS if not entry.in_bytes], ids=lambda entry: entry.name
)
each_palm_model = pytest.mark.parametrize("name", ["palm_detection_lite", "palm_detection_full"])


def _tolerances(name: str) -> dict[str, float]:
    return next(value for prefix, value in _TOLERANCES.items() if name.startswith(prefix))


def _open(store: ModelStore, name: str) -> onnxruntime.InferenceSession:
    options = onnxruntime.SessionOptions()
    options.intra_op_num_threads = 1
    return onnxruntime.InferenceSession(
        str(store.path(name)), options, providers=["CPUExecutionProvider"]
    )


def _noise(side: int) -> np.ndarray:
    return np.random.default_rng(3).random((1, side, side, 3), np.float32)


def _figure(side: int) -> np.ndarray:
    """A skin-colored disk with five bars above it, before a gradient."""
    y, x = np.mgrid[:side, :side] / side
    is_hand = (x - 0.5) ** 2 + (y - 0.65) ** 2 < 0.15**2
    is_hand |= (abs((x * 20) % 1.2 - 0.6) < 0.4) & (abs(x - 0.5) < 0.15) & (abs(y - 0.4) < 0.15)
    background = np.stack([0.3 + 0.3 * x, 0.4 + 0.2 * y, 0.5 - 0.3 * x], axis=-1)
    image = np.where(is_hand[..., None], [0.85, 0.65, 0.55], background)
    return image[None].astype(np.float32)


def _check(found: Outputs, expected: Outputs, entry: ModelEntry) -> None:
    for output in entry.outputs:
        reference = expected[output.source_name]
        assert found[output.name].shape == reference.shape
        np.testing.assert_allclose(
            found[output.name],
            reference,
            rtol=0,
            atol=_tolerances(entry.name)[output.name],
            err_msg=f"{entry.name} {output.name}",
        )


def _run(session: onnxruntime.InferenceSession, image: np.ndarray) -> Outputs:
    names = [output.name for output in session.get_outputs()]
    return dict(zip(names, session.run(names, {"image": image}), strict=True))


@each_model
@pytest.mark.parametrize("make", [_noise, _figure], ids=["noise", "figure"])
def test_model_agrees_with_litert(
    entry: ModelEntry,
    make: Callable[[int], np.ndarray],
    model_store: ModelStore,
    tflite_sources: dict[str, bytes],
    litert: Litert,
) -> None:
    low, high = entry.input_range
    image = low + (high - low) * make(entry.size_px)
    found = _run(_open(model_store, entry.name), image)
    assert list(found) == [output.name for output in entry.outputs]
    _check(found, litert(tflite_sources[entry.name], image), entry)


@each_model
def test_batch_of_two_is_twice_a_batch_of_one(entry: ModelEntry, model_store: ModelStore) -> None:
    session = _open(model_store, entry.name)
    images = [_noise(entry.size_px), _figure(entry.size_px)]
    both = _run(session, np.concatenate(images))
    for name, tolerance in _tolerances(entry.name).items():
        singles = np.concatenate([_run(session, image)[name] for image in images])
        np.testing.assert_allclose(both[name], singles, rtol=0, atol=tolerance)


@each_palm_model
def test_palm_model_at_160_pixels_agrees_with_litert(
    name: str, model_store: ModelStore, tflite_sources: dict[str, bytes], litert: Litert
) -> None:
    image = _figure(160)
    smaller = _with_upsampling_sizes(tflite_sources[name], {12: 10, 24: 20})
    found = _run(_open(model_store, name), image)
    assert found["boxes"].shape == (1, 1400, 18)
    _check(found, litert(smaller, image), find_model(name))


def _with_upsampling_sizes(content: bytes, sizes: dict[int, int]) -> bytes:
    """The TFLite file with other targets of its RESIZE_BILINEAR operators."""
    changed = bytearray(content)
    model = tflite.Model.GetRootAs(changed, 0)
    graph = model.Subgraphs(0)
    for i in range(graph.OperatorsLength()):
        operator: Any = graph.Operators(i)
        code = model.OperatorCodes(operator.OpcodeIndex()).DeprecatedBuiltinCode()
        if code == tflite.BuiltinOperator.RESIZE_BILINEAR:
            buffer = model.Buffers(graph.Tensors(operator.Inputs(1)).Buffer())
            target = buffer.DataAsNumpy().view("<i4")
            target[:] = [sizes[side] for side in target]
    return bytes(changed)


@each_palm_model
def test_palm_model_takes_other_multiples_of_32(name: str, model_store: ModelStore) -> None:
    session = _open(model_store, name)
    image = np.zeros((1, 96, 320, 3), np.float32)
    anchors = 12 * 40 * 2 + 6 * 20 * 6
    assert _run(session, image)["scores"].shape == (1, anchors, 1)
