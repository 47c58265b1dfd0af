"""Which units of a study are already on disk? So that a stopped study can continue.

A folder holds `settings.yaml` (which study this is), `trials.csv` (a line per trial, in order,
every number to its last bit) and, of a filter scenario, `sums.f64` (a record for each unit). They
only grow: whatever was written stays, however the study ended. One study at a time writes there.
"""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping
from contextlib import ExitStack
from pathlib import Path
from typing import Any

import numpy as np
import yaml

from tracker.closing import Closing
from tracker.containers import FloatArray
from tracker.errors import ConfigError, RecordingError
from tracker.evaluation.studies.unit import Unit
from tracker.outputs.folder_lock import FolderLock

#: What a study keeps in its folder.
LOG_FILES = ("settings.yaml", "trials.csv", "sums.f64")

#: Longer than any line of trials.csv.
_BLOCK = 1 << 16


class StudyLog(Closing):
    """The units of a study, in a folder that is kept for it until it closes.

    Args:
        folder: Made where it is missing.
        settings: All that decides what the rows are, in plain numbers, texts and lists; only a
            study with the same ones goes on.
        unit_trials: Trials of each unit but the last.
        sums: Name and shape of each of a unit's sums.

    Raises:
        ConfigError: The folder holds another study, or one writes there at this moment.
        RecordingError: The folder cannot be read or written.
    """

    def __init__(
        self,
        folder: str | Path,
        settings: Mapping[str, Any],
        unit_trials: int,
        sums: Mapping[str, tuple[int, ...]],
    ) -> None:
        self._folder = Path(folder)
        self._unit_trials = unit_trials
        self._record = np.dtype(
            [("trials", "<i8"), *((name, "<f8", shape) for name, shape in sums.items())]
        )
        self._settings_path, self._rows_path, self._sums_path = (
            self._folder / name for name in LOG_FILES
        )
        with ExitStack() as opened:
            try:
                opened.enter_context(FolderLock(self._folder))
                self._agree(dict(settings))
                self._rows = self._read_rows()
                self._sums = self._read_sums()
            except OSError as error:
                raise self._failure(error) from error
            self._opened = opened.pop_all()
        self.trials = len(next(iter(self._rows.values()), ()))

    def units(self, trials: int) -> Iterator[Unit]:
        """Those that were complete when the folder was opened, from the first on.

        Args:
            trials: Of the whole study; decides how many the last unit has.

        Raises:
            ConfigError: There are more already.
        """
        if self.trials > trials:
            raise ConfigError(
                f"{self._folder}: holds {self.trials} trials of this study, and {trials} were "
                "asked for; ask for at least as many, or choose another folder."
            )
        for number, first in enumerate(range(0, trials, self._unit_trials)):
            end = min(first + self._unit_trials, trials)
            rows = {name: values[first:end] for name, values in self._rows.items()}
            sums: dict[str, FloatArray] = {}
            if names := self._record.names[1:]:  # type: ignore[index]
                record = self._sums[number : number + 1]
                if list(record["trials"]) != [end - first]:
                    return
                sums = {name: record[name][0] for name in names}
            if end > self.trials:
                return
            yield Unit(rows, sums)

    def add(self, number: int, unit: Unit) -> None:
        """Write what a unit gave; rows that are here already stay as they are.

        Args:
            number: Of the unit, from 0; none is left out.
            unit: Rows of its trials, and sums over them.

        Raises:
            RecordingError: The disk does not take it.
        """
        first = number * self._unit_trials
        lines = [
            ",".join([str(first + row), *(repr(float(value)) for value in values)])
            for row, values in enumerate(zip(*unit.rows.values(), strict=True))
        ]
        end, lines = first + len(lines), lines[max(self.trials - first, 0) :]
        try:
            # The sums come first, so that rows are never without them.
            if unit.sums:
                self._write_sums(number, end - first, unit.sums)
            if lines:
                header = [",".join(["trial", *unit.rows])] if self.trials == 0 else []
                with self._rows_path.open("a", encoding="ascii", newline="\n") as file:
                    file.write("\n".join([*header, *lines, ""]))
        except OSError as error:
            raise self._failure(error) from error
        self.trials = max(self.trials, end)

    def close(self) -> None:
        """Let others write into the folder."""
        self._opened.close()

    def _agree(self, settings: dict[str, Any]) -> None:
        path = self._settings_path
        if not path.exists():
            if self._rows_path.exists():
                raise ConfigError(
                    f"{self._rows_path}: exists without a settings.yaml that says which study it "
                    "is; choose another folder, or delete the file."
                )
            new = path.with_suffix(".new")  # in one step: a file is there in full or not at all
            new.write_text(yaml.safe_dump(settings, sort_keys=False), encoding="utf-8")
            os.replace(new, path)
            return
        try:
            there = yaml.safe_load(path.read_text(encoding="utf-8"))
        except (yaml.YAMLError, UnicodeDecodeError) as error:
            raise RecordingError(f"{path}: is not YAML; choose another folder.") from error
        differences = list(_differences(there, settings))
        if differences:
            raise ConfigError(
                f"{self._folder}: holds another study ({'; '.join(differences[:3])}); "
                "choose another folder, or delete this one."
            )

    def _read_rows(self) -> dict[str, FloatArray]:
        path = self._rows_path
        if not path.exists():
            return {}
        _cut_half_a_line(path)
        with path.open(encoding="ascii") as file:
            names = file.readline().rstrip("\n").split(",")
            is_header_alone = not file.readline()
        if is_header_alone:
            os.truncate(path, 0)
            return {}
        try:
            table = np.loadtxt(path, delimiter=",", skiprows=1, ndmin=2)
        except ValueError as error:
            raise RecordingError(f"{path}: is damaged ({error}); delete it.") from error
        if table.shape[1] != len(names) or (table[:, 0] != np.arange(len(table))).any():
            raise RecordingError(f"{path}: does not contain the trials in order; delete it.")
        return {name: table[:, column] for column, name in enumerate(names) if column > 0}

    def _read_sums(self) -> np.ndarray:
        """One record per unit; a half-written last one is not among them."""
        if not self._sums_path.exists():
            return np.zeros(0, self._record)
        return np.fromfile(self._sums_path, self._record)

    def _write_sums(self, number: int, trials: int, sums: dict[str, FloatArray]) -> None:
        record = np.array((trials, *sums.values()), self._record)
        is_there = self._sums_path.exists()
        with self._sums_path.open("r+b" if is_there else "wb") as file:
            file.seek(number * self._record.itemsize)
            file.write(record.tobytes())

    def _failure(self, error: OSError) -> RecordingError:
        return RecordingError(
            f"{self._folder}: cannot be read and written ({error.strerror}); choose a writable "
            "folder with free space."
        )


def _cut_half_a_line(path: Path) -> None:
    with path.open("r+b") as file:
        size = file.seek(0, os.SEEK_END)
        start = file.seek(max(size - _BLOCK, 0))
        file.truncate(start + file.read().rfind(b"\n") + 1)


def _differences(there: Any, here: Any, name: str = "") -> Iterator[str]:
    """What differs between two sets of settings, by dotted names."""
    if isinstance(there, dict) and isinstance(here, dict):
        for key in sorted({*there, *here}):
            path = f"{name}.{key}".lstrip(".")
            yield from _differences(there.get(key), here.get(key), path)
    elif there != here:
        yield f"{name or 'settings'} is {there} in the folder and {here} now"
