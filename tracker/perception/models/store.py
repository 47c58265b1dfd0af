"""Where do the converted model files live, and are they the ones this version needs?

A file is recognized by the texts that the converter stored in it, and whole if its content has the
hash that was stored when it was written.
"""

import os
import secrets
from dataclasses import dataclass
from enum import Enum
from pathlib import Path

from tracker.errors import ModelFileError
from tracker.perception.models.catalog import CONVERTER_VERSION, MODELS, find_model
from tracker.perception.models.onnx_metadata import has_seal, read_metadata, sealed
from tracker.user_cache import user_cache

DIRECTORY_VARIABLE = "RAISED_HAND_MODELS"
FETCH_COMMAND = "raised-hand models fetch"


class ModelState(Enum):
    """What is found at a model file's place."""

    PRESENT = "present"
    ABSENT = "absent"
    STALE = "stale"  # readable, but from another version of the converter, or another source
    DAMAGED = "damaged"  # cut off, not what was written, or no model file at all


@dataclass(frozen=True, slots=True)
class ModelStatus:
    """One row of `raised-hand models list`.

    Attributes:
        name: The model's name in the catalog.
        state: What is there.
        size_bytes: Size of the file, 0 if absent.
        source_sha256: Hash of the TFLite file it was made from; empty if unknown.
        path: Where the file is or would be.
    """

    name: str
    state: ModelState
    size_bytes: int
    source_sha256: str
    path: Path


class ModelStore:
    """A folder with one ONNX file per model of the catalog."""

    def __init__(self, directory: Path | str | None = None) -> None:
        """Choose the folder; it need not exist yet.

        Args:
            directory: The folder itself. None takes the environment variable RAISED_HAND_MODELS,
                or the user's cache folder where that is unset or empty.

        Raises:
            ModelFileError: None of them says where.
        """
        chosen = directory or os.environ.get(DIRECTORY_VARIABLE)
        if not chosen:
            cache = user_cache()
            if cache is None:
                raise ModelFileError(
                    "There is no home folder to keep the model files in; set "
                    f"{DIRECTORY_VARIABLE} to a folder for them."
                )
            chosen = cache / "models"
        self.directory = Path(chosen).expanduser()

    def path(self, name: str) -> Path:
        """Path of a model's ONNX file, ready to be opened.

        Args:
            name: A name in the catalog, such as "palm_detection_full".

        Raises:
            ModelFileError: There is no such model, or its file is absent, stale or damaged.
        """
        status = self._status_of(name)
        if status.state is not ModelState.PRESENT:
            raise ModelFileError(
                f"The model file {status.path} is {status.state.value}; run '{FETCH_COMMAND}', or "
                f"set {DIRECTORY_VARIABLE} to a folder that has the files of this version."
            )
        return status.path

    def has_all(self) -> bool:
        """Whether every model is there and up to date; those in 8 bits may be missing."""
        return all(self.has(entry.name) for entry in MODELS if not entry.in_bytes)

    def has(self, name: str) -> bool:
        """Whether a model of the catalog is there and up to date.

        Raises:
            ModelFileError: The folder or a file in it must not be read.
        """
        return self._status_of(name).state is ModelState.PRESENT

    def status(self) -> list[ModelStatus]:
        """What is there, one row per model of the catalog.

        Raises:
            ModelFileError: The folder or a file in it must not be read.
        """
        return [self._status_of(entry.name) for entry in MODELS]

    def write(self, name: str, content: bytes) -> Path:
        """Put a model file in place, whole or not at all.

        The content goes to a temporary file beside its place and is renamed when it is on the
        disk, so that neither a failure nor a second process that does the same leaves half a file.

        Args:
            name: A name in the catalog.
            content: The ONNX file.

        Returns:
            Its path.

        Raises:
            ModelFileError: There is no such model, or the file cannot be written.
        """
        target = self._target(name)
        temporary = target.with_name(f".{target.name}.{os.getpid()}-{secrets.token_hex(4)}.tmp")
        try:
            self.directory.mkdir(parents=True, exist_ok=True)
            try:
                # Not tempfile: its files are for the owner's eyes only, and a robot's node often
                # runs under another account than the one that fetched the models.
                with temporary.open("xb") as file:
                    file.write(sealed(content))
                    file.flush()
                    os.fsync(file.fileno())
                os.replace(temporary, target)
            except BaseException:
                temporary.unlink(missing_ok=True)
                raise
        except OSError as error:
            raise self.write_error(error) from error
        return target

    def write_error(self, error: OSError) -> ModelFileError:
        """The error to raise when something could not be written to the folder."""
        return ModelFileError(
            f"Cannot write model files to {self.directory} ({error.strerror or error}); free some "
            f"space or allow writing there, or set {DIRECTORY_VARIABLE} to another folder."
        )

    def _target(self, name: str) -> Path:
        return self.directory / f"{find_model(name).name}.onnx"

    def _status_of(self, name: str) -> ModelStatus:
        path = self._target(name)
        try:
            size = path.stat().st_size
            metadata, is_whole = read_metadata(path), has_seal(path)
        except FileNotFoundError:
            return ModelStatus(name, ModelState.ABSENT, 0, "", path)
        except OSError as error:
            raise ModelFileError(
                f"Cannot read the model file {path} ({error.strerror or error}); allow reading, "
                f"or set {DIRECTORY_VARIABLE} to another folder."
            ) from error
        if not metadata or is_whole is False:
            return ModelStatus(name, ModelState.DAMAGED, size, "", path)
        sha256 = metadata.get("source_sha256", "")
        is_current = (
            is_whole is not None
            and metadata.get("converter_version") == str(CONVERTER_VERSION)
            and sha256 == find_model(name).sha256
        )
        state = ModelState.PRESENT if is_current else ModelState.STALE
        return ModelStatus(name, state, size, sha256, path)
