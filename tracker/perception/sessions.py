"""How do the model files run? ONNX Runtime, tuned for small models on a busy machine."""

from __future__ import annotations

from typing import Any

import onnxruntime
from onnxruntime.capi import onnxruntime_pybind11_state as runtime_errors

from tracker.errors import ModelFileError
from tracker.perception.models import ModelStore


def open_session(
    store: ModelStore, name: str, *, threads: int, fixed_sizes: dict[str, int] | None = None
) -> onnxruntime.InferenceSession:
    """Open a model for inference on the processor.

    Args:
        store: Where the model files live.
        name: A name in the catalog, such as "palm_detection_full".
        threads: Processor threads that one call may use. A session of one thread may be called
            from several Python threads at once; ONNX Runtime leaves the interpreter free.
        fixed_sizes: Free dimensions of the input (`batch`, `height`, `width`) that will never
            change; the palm models run 6-8 % faster when told.

    Raises:
        ModelFileError: The file is absent, stale, damaged, or not understood by ONNX Runtime.
    """
    path = store.path(name)
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
        return onnxruntime.InferenceSession(str(path), options, providers=["CPUExecutionProvider"])
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
            f"ONNX Runtime {onnxruntime.__version__} cannot open {path} ({reason}); "
            "delete the file and run 'raised-hand models fetch'."
        ) from error
