import pytest

from tracker.errors import ModelFileError
from tracker.perception.models import MODELS, find_model


def test_names_hashes_and_places_are_unique() -> None:
    for values in zip(*((m.name, m.sha256, m.wheel_path) for m in MODELS), strict=True):
        assert len(set(values)) == len(MODELS) == 6


def test_entries_are_found_by_name() -> None:
    for entry in MODELS:
        assert find_model(entry.name) is entry
        assert entry.wheel_path.endswith(f"/{entry.name}.tflite")


def test_unknown_name_lists_the_known_ones() -> None:
    with pytest.raises(ModelFileError, match="no model 'palm'; choose one of palm_detection_lite"):
        find_model("palm")
