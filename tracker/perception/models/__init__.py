"""Model files: which there are, where they live, and how they get there."""

from tracker.perception.models.catalog import MODELS, ModelEntry, ModelOutput, find_model
from tracker.perception.models.fetch import ensure_models, fetch_models
from tracker.perception.models.numbers import (
    file_to_run,
    model_to_run,
    processor_features,
    processor_kind,
    runs_here,
)
from tracker.perception.models.store import ModelState, ModelStatus, ModelStore
from tracker.perception.models.wheel import Progress

__all__ = [
    "MODELS",
    "ModelEntry",
    "ModelOutput",
    "ModelState",
    "ModelStatus",
    "ModelStore",
    "Progress",
    "ensure_models",
    "fetch_models",
    "file_to_run",
    "find_model",
    "model_to_run",
    "processor_features",
    "processor_kind",
    "runs_here",
]
