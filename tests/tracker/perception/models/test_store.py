import errno
import os
import stat
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest

from tracker.errors import ModelFileError
from tracker.perception.models import ModelState, ModelStore, store
from tracker.perception.models.convert import convert_tflite

pytestmark = pytest.mark.usefixtures("small_catalog")


def _states(models: ModelStore) -> list[ModelState]:
    return [status.state for status in models.status()]


def test_default_folder_is_the_users_cache(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("RAISED_HAND_MODELS", raising=False)
    monkeypatch.setenv("XDG_CACHE_HOME", "/cache")
    monkeypatch.setattr("sys.platform", "linux")
    assert ModelStore().directory.parts[-2:] == ("raised-hand-tracker", "models")


def test_environment_variable_is_used_as_is(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setenv("RAISED_HAND_MODELS", str(tmp_path))
    assert ModelStore().directory == tmp_path
    assert ModelStore("elsewhere").directory == Path("elsewhere")


def test_empty_environment_variable_counts_as_unset(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("RAISED_HAND_MODELS", "")
    assert ModelStore().directory.name == "models"


def test_absent_file_names_the_command(tmp_path: Path) -> None:
    models = ModelStore(tmp_path / "none")
    assert _states(models) == [ModelState.ABSENT, ModelState.ABSENT]
    with pytest.raises(ModelFileError, match=r"first\.onnx is absent; run 'raised-hand models"):
        models.path("first")
    assert not models.directory.exists()


def test_unknown_name_lists_the_known_ones(tmp_path: Path) -> None:
    models = ModelStore(tmp_path)
    for attempt in (models.path, lambda name: models.write(name, b"")):
        with pytest.raises(ModelFileError, match="no model 'third'; choose one of first, second"):
            attempt("third")


def test_written_file_is_present(tmp_path: Path, small_onnx: bytes) -> None:
    models = ModelStore(tmp_path / "a" / "b")
    path = models.write("first", small_onnx)
    assert path == models.path("first") == tmp_path / "a" / "b" / "first.onnx"
    assert path.read_bytes().startswith(small_onnx)
    first, second = models.status()
    assert (first.name, first.state, first.path) == ("first", ModelState.PRESENT, path)
    assert first.size_bytes == path.stat().st_size
    assert len(first.source_sha256) == 64
    assert (second.state, second.size_bytes, second.source_sha256) == (ModelState.ABSENT, 0, "")
    assert not models.has_all()
    models.write("second", small_onnx)
    assert models.has_all()


@pytest.mark.parametrize("share", [0.02, 0.5, 0.999], ids=["begin", "middle", "end"])
def test_a_file_with_wrong_bytes_is_damaged(
    tmp_path: Path, small_onnx: bytes, share: float
) -> None:
    models = ModelStore(tmp_path)
    path = models.write("first", small_onnx)
    content = bytearray(path.read_bytes())
    content[int(share * len(content))] ^= 0xFF
    path.write_bytes(content)
    assert _states(models)[0] is ModelState.DAMAGED
    with pytest.raises(ModelFileError, match="is damaged; run 'raised-hand models fetch'"):
        models.path("first")
    models.write("first", small_onnx)
    assert _states(models)[0] is ModelState.PRESENT


def test_a_file_whose_content_was_never_hashed_is_stale(tmp_path: Path, small_onnx: bytes) -> None:
    (tmp_path / "first.onnx").write_bytes(small_onnx)
    assert _states(ModelStore(tmp_path))[0] is ModelState.STALE


def test_file_of_another_converter_version_is_stale(
    tmp_path: Path, small_onnx: bytes, monkeypatch: pytest.MonkeyPatch
) -> None:
    models = ModelStore(tmp_path)
    models.write("first", small_onnx)
    monkeypatch.setattr(store, "CONVERTER_VERSION", store.CONVERTER_VERSION + 1)
    assert _states(models)[0] is ModelState.STALE
    with pytest.raises(ModelFileError, match="is stale; run"):
        models.path("first")


def test_file_of_another_source_is_stale(tmp_path: Path, small_tflite: bytes) -> None:
    models = ModelStore(tmp_path)
    other = {"source_sha256": "0" * 64}
    models.write("first", convert_tflite(small_tflite, {"a": "Identity"}, metadata=other))
    assert _states(models)[0] is ModelState.STALE
    assert models.status()[0].source_sha256 == "0" * 64


@pytest.mark.parametrize("keep", [0, 10, -1], ids=["empty", "beginning", "all-but-a-byte"])
def test_cut_off_file_is_not_present(tmp_path: Path, small_onnx: bytes, keep: int) -> None:
    models = ModelStore(tmp_path)
    models.write("first", small_onnx[:keep])
    assert _states(models)[0] is not ModelState.PRESENT
    with pytest.raises(ModelFileError, match="run 'raised-hand models fetch'"):
        models.path("first")


def test_folder_that_cannot_be_read_is_reported(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("no folder")
    with pytest.raises(ModelFileError, match=r"Cannot read.*Not a directory.*RAISED_HAND_MODELS"):
        ModelStore(tmp_path / "file").status()


def test_folder_that_cannot_be_made_is_reported(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("no folder")
    with pytest.raises(ModelFileError, match=r"Cannot write.*RAISED_HAND_MODELS"):
        ModelStore(tmp_path / "file").write("first", b"")


@pytest.mark.parametrize(
    ("function", "error", "expected"),
    [
        ("fsync", OSError(errno.ENOSPC, os.strerror(errno.ENOSPC)), ModelFileError),
        ("replace", PermissionError(errno.EACCES, os.strerror(errno.EACCES)), ModelFileError),
        ("fsync", KeyboardInterrupt(), KeyboardInterrupt),
    ],
    ids=["full-disk", "no-permission", "ctrl-c"],
)
def test_failed_write_leaves_the_old_file_and_nothing_else(
    tmp_path: Path,
    small_onnx: bytes,
    monkeypatch: pytest.MonkeyPatch,
    function: str,
    error: BaseException,
    expected: type[BaseException],
) -> None:
    models = ModelStore(tmp_path)
    models.write("first", small_onnx)

    def fail(*_: object) -> None:
        raise error

    monkeypatch.setattr(os, function, fail)
    with pytest.raises(expected) as caught:
        models.write("first", b"new")
    if expected is ModelFileError:
        assert error.strerror in str(caught.value)
        assert "free some space or allow writing" in str(caught.value)
    assert [path.name for path in tmp_path.iterdir()] == ["first.onnx"]
    assert models.path("first").read_bytes().startswith(small_onnx)


def test_other_accounts_may_read_what_the_umask_allows(tmp_path: Path, small_onnx: bytes) -> None:
    before = os.umask(0o022)
    try:
        path = ModelStore(tmp_path).write("first", small_onnx)
    finally:
        os.umask(before)
    assert stat.S_IMODE(path.stat().st_mode) == 0o644


def test_two_writers_and_a_reader_never_see_half_a_file(tmp_path: Path, small_onnx: bytes) -> None:
    models = [ModelStore(tmp_path) for _ in range(3)]
    models[0].write("first", small_onnx)
    with ThreadPoolExecutor(2) as pool:
        writes = [pool.submit(m.write, "first", small_onnx) for m in models[:2] for _ in range(30)]
        while not all(write.done() for write in writes):
            assert _states(models[2])[0] is ModelState.PRESENT
    assert [write.result().name for write in writes] == ["first.onnx"] * 60
    assert [path.name for path in tmp_path.iterdir()] == ["first.onnx"]
