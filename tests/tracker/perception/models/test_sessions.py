import numpy as np
import onnx
import onnxruntime
import pytest
from onnx import TensorProto, helper

from tracker.config import Config
from tracker.errors import ConfigError, ModelFileError
from tracker.perception.models.sessions import PROVIDERS, choose_providers, open_session


class FolderStore:
    def __init__(self, folder):
        self.folder = folder

    def path(self, name):
        return self.folder / f"{name}.onnx"


@pytest.mark.parametrize(
    "content", [b"", b"no model at all", None], ids=["empty", "text", "absent"]
)
def test_a_file_that_is_no_model_is_named_with_the_remedy(tmp_path, content):
    if content is not None:
        (tmp_path / "broken.onnx").write_bytes(content)
    with pytest.raises(ModelFileError, match=r"broken\.onnx.*models fetch"):
        open_session(FolderStore(tmp_path), "broken", threads=1)


@pytest.mark.model
def test_threads_and_fixed_sizes_change_speed_not_results(model_store):
    image = np.random.default_rng(3).random((1, 192, 192, 3), dtype=np.float32)
    sizes = {"batch": 1, "height": 192, "width": 192}
    name = "palm_detection_lite"
    free = open_session(model_store, name, threads=1).run(["boxes"], {"image": image})[0]
    fixed = open_session(model_store, name, threads=2, fixed_sizes=sizes)
    np.testing.assert_allclose(fixed.run(["boxes"], {"image": image})[0], free, atol=1e-3)


@pytest.fixture
def runtime_with(monkeypatch):
    """Makes ONNX Runtime say what it was built with."""

    def pretend(*names):
        there = [PROVIDERS[name] for name in names] + ["AzureExecutionProvider"]
        monkeypatch.setattr(onnxruntime, "get_available_providers", lambda: there)

    return pretend


@pytest.fixture
def store(tmp_path):
    """One model, which gives back what it gets."""
    ends = [helper.make_tensor_value_info(name, TensorProto.FLOAT, [1]) for name in "ab"]
    same = helper.make_node("Identity", ["a"], ["b"])
    graph = helper.make_graph([same], "same", ends[:1], ends[1:])
    model = helper.make_model(graph, opset_imports=[helper.make_opsetid("", 17)])
    model.ir_version = 8
    onnx.save(model, tmp_path / "same.onnx")
    return FolderStore(tmp_path)


def test_every_provider_of_the_parameter_is_known():
    choices = Config.model_fields["execution_provider"].annotation.__args__
    assert sorted(choices) == sorted([*PROVIDERS, "auto"])


@pytest.mark.parametrize("provider", ["cuda", "tensorrt", "openvino", "coreml"])
def test_a_provider_stands_before_the_processor(runtime_with, provider):
    runtime_with(provider, "cpu")
    assert choose_providers(provider) == [PROVIDERS[provider], "CPUExecutionProvider"]
    assert choose_providers("cpu") == ["CPUExecutionProvider"]


@pytest.mark.parametrize(
    ("there", "chosen"),
    [
        (("tensorrt", "cuda", "cpu"), "cuda"),
        (("openvino", "cpu"), "openvino"),
        (("tensorrt", "cpu"), "cpu"),
    ],
)
def test_auto_takes_the_first_that_is_there_but_never_tensorrt(runtime_with, there, chosen):
    runtime_with(*there)
    assert choose_providers("auto")[0] == PROVIDERS[chosen]


def test_a_provider_that_is_not_there_is_refused_with_those_that_are(runtime_with, store):
    runtime_with("cuda", "cpu")
    with pytest.raises(ConfigError, match=r"'openvino'.* has cpu, cuda\."):
        open_session(store, "same", threads=1, provider="openvino")


def test_a_provider_that_does_not_start_is_no_silent_processor(runtime_with, store):
    # As with the CUDA build on a machine without CUDA's libraries: offered, but not started.
    runtime_with("cuda", "cpu")
    with pytest.warns(UserWarning, match="CUDAExecutionProvider"):
        with pytest.raises(ConfigError, match=r"`execution_provider: cuda`.* cannot start"):
            open_session(store, "same", threads=1, provider="cuda")


def test_the_processor_runs_a_model(store):
    session = open_session(store, "same", threads=1, provider="auto")
    assert session.run(None, {"a": np.ones(1, np.float32)})[0].tolist() == [1.0]
