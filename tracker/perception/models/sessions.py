"""How do the model files run? ONNX Runtime, tuned for small models on a busy machine."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import onnxruntime
from onnxruntime.capi import onnxruntime_pybind11_state as runtime_errors

from tracker.errors import ConfigError, ModelFileError
from tracker.perception.models import ModelStore, file_to_run

#: ONNX Runtime's names of what `execution_provider` may be.
PROVIDERS = {
    "cpu": "CPUExecutionProvider",
    "cuda": "CUDAExecutionProvider",
    "tensorrt": "TensorrtExecutionProvider",
    "openvino": "OpenVINOExecutionProvider",
    "coreml": "CoreMLExecutionProvider",
}
#: What `auto` takes, the first that is there. TensorRT has to be asked for by name: it builds its
#: engines for minutes at the first start.
_AUTO_ORDER = ("cuda", "coreml", "openvino", "cpu")


def open_session(
    store: ModelStore,
    name: str,
    *,
    threads: int,
    fixed_sizes: dict[str, int] | None = None,
    provider: str = "cpu",
    numbers: str = "fp32",
) -> onnxruntime.InferenceSession:
    """Open a model of the catalog, such as "palm_detection_full", for inference.

    Args:
        store: Where the model files live.
        name: In the catalog.
        threads: Processor threads that one call may use. A session of one thread may be called
            from several Python threads at once; ONNX Runtime leaves the interpreter free.
        fixed_sizes: Free dimensions of the input (`batch`, `height`, `width`) that will never
            change; the palm models run 6-8 % faster when told.
        provider: `Config.execution_provider`.
        numbers: `Config.model_numbers`.

    Raises:
        ModelFileError: The file is absent, stale, damaged, or not understood by ONNX Runtime.
        ConfigError: This ONNX Runtime has no such provider, or it does not start; or the processor
            cannot do with such numbers.
    """
    return open_file(
        store.path(file_to_run(store, name, numbers, provider)),
        threads=threads,
        fixed_sizes=fixed_sizes,
        provider=provider,
        remedy="delete the file and run 'raised-hand models fetch'",
    )


def open_file(
    path: Path,
    *,
    threads: int,
    provider: str,
    remedy: str,
    fixed_sizes: dict[str, int] | None = None,
) -> onnxruntime.InferenceSession:
    """Open any ONNX file; as `open_session`, with the remedy that the message names."""
    providers = choose_providers(provider)
    options: Any = onnxruntime.SessionOptions()
    options.graph_optimization_level = onnxruntime.GraphOptimizationLevel.ORT_ENABLE_ALL
    options.intra_op_num_threads = threads
    options.inter_op_num_threads = 1
    # A waiting thread that spins takes the core from the robot's other processes; on a busy
    # machine spinning made the models twice as slow.
    options.add_session_config_entry("session.intra_op.allow_spinning", "0")
    options.log_severity_level = 3  # errors alone; they reach the caller as exceptions anyway
    for dimension, size in (fixed_sizes or {}).items():
        options.add_free_dimension_override_by_name(dimension, size)
    try:
        session = onnxruntime.InferenceSession(str(path), options, providers=providers)
    except (
        runtime_errors.Fail,
        runtime_errors.InvalidArgument,
        runtime_errors.InvalidGraph,
        runtime_errors.InvalidProtobuf,
        runtime_errors.NoSuchFile,
        runtime_errors.NotImplemented,
    ) as error:
        reason = str(error).splitlines()[0]
        raise ModelFileError(
            f"ONNX Runtime {onnxruntime.__version__} cannot open {path} ({reason}); {remedy}."
        ) from error
    # A provider whose libraries are missing makes ONNX Runtime go on with the processor.
    if session.get_providers()[0] != providers[0]:
        raise ConfigError(
            f"`execution_provider: {provider}`: ONNX Runtime has {providers[0]} but cannot start "
            f"it; install what it needs, or choose `cpu`."
        )
    session.disable_fallback()
    return session


def choose_providers(provider: str) -> list[str]:
    """ONNX Runtime's names for a provider; the processor stands behind, for operators it lacks.

    Raises:
        ConfigError: This ONNX Runtime was built without it; the message says what it has.
    """
    there = onnxruntime.get_available_providers()
    names = _AUTO_ORDER if provider == "auto" else (provider,)
    chosen = next((PROVIDERS[name] for name in names if PROVIDERS[name] in there), None)
    if chosen is None:
        known = [name for name, full in PROVIDERS.items() if full in there]
        raise ConfigError(
            f"`execution_provider` is {provider!r}; the installed ONNX Runtime "
            f"{onnxruntime.__version__} has {', '.join(known)}. Choose one of these, or install "
            "the build of onnxruntime that has it."
        )
    return [chosen] if chosen == PROVIDERS["cpu"] else [chosen, PROVIDERS["cpu"]]
