import pytest

from tracker.errors import ModelFileError
from tracker.perception.models import MODELS, find_model
from tracker.perception.models.catalog import INT8_MODELS, INT8_SUFFIX


def test_names_hashes_and_places_are_unique() -> None:
    plain = [entry for entry in MODELS if not entry.in_bytes]
    for values in zip(*((m.name, m.sha256, m.wheel_path) for m in plain), strict=True):
        assert len(set(values)) == len(plain) == 6


def test_entries_in_bytes_come_from_the_file_of_the_plain_one() -> None:
    in_bytes = [entry for entry in MODELS if entry.in_bytes]
    assert [entry.name for entry in in_bytes] == [name + INT8_SUFFIX for name in INT8_MODELS]
    for entry in in_bytes:
        plain = find_model(entry.name.removesuffix(INT8_SUFFIX))
        assert (entry.wheel_path, entry.sha256) == (plain.wheel_path, plain.sha256)


def test_entries_are_found_by_name() -> None:
    for entry in MODELS:
        assert find_model(entry.name) is entry
        assert entry.wheel_path.endswith(f"/{entry.name.removesuffix(INT8_SUFFIX)}.tflite")


def test_unknown_name_lists_the_known_ones() -> None:
    with pytest.raises(ModelFileError, match="no model 'palm'; choose one of palm_detection_lite"):
        find_model("palm")
