"""Whose hand is up in these photos? The user's own labels.csv, and what else is known of them."""

from __future__ import annotations

import csv
import os
from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np

from tracker.containers import FloatArray
from tracker.errors import RecordingError

LABELS, ATTRIBUTES = "labels.csv", "attributes.csv"

_COLUMNS = ("file", "raised", "x", "y")
_YES, _NO = frozenset({"1", "true", "yes"}), frozenset({"0", "false", "no"})


@dataclass(frozen=True, slots=True, eq=False)
class LabeledPhoto:
    """One photo and its raised hands.

    Attributes:
        path: The photo.
        wrists_px: Shape (R, 2): column and row of each raised hand's wrist; NaN where the labels
            say only that there is one.
        traits: What attributes.csv says of the photo, by column; figures are broken down by it.
    """

    path: Path
    wrists_px: FloatArray
    traits: dict[str, str] = field(default_factory=dict)


def read_photos(folder: str | Path) -> tuple[LabeledPhoto, ...]:
    """Read the labels of a folder, or of each folder in it that has some.

    `attributes.csv` in the folder may say more of the photos: its column `file` names each from
    there (`bar/03.jpg`), the others are free, such as `hand` (palm, fist, finger) or `light`.

    Args:
        folder: Holds labels.csv, or folders that do.

    Raises:
        RecordingError: As `read_labels`; or attributes.csv has no column `file`.
    """
    folder = Path(folder)
    inner = sorted(path.parent for path in folder.glob(f"*/{LABELS}"))
    if (folder / LABELS).exists() or not inner:
        inner = [folder]
    traits = _read_traits(folder / ATTRIBUTES)
    photos = [photo for place in inner for photo in read_labels(place)]
    return tuple(
        replace(
            photo,
            traits={
                **({"folder": photo.path.parent.name} if len(inner) > 1 else {}),
                **traits.get(Path(os.path.relpath(photo.path, folder)).as_posix(), {}),
            },
        )
        for photo in photos
    )


def read_labels(folder: str | Path) -> tuple[LabeledPhoto, ...]:
    """Read the labels of a folder of photos.

    The columns are `file`, `raised` (1 or 0) and, if wanted, `x` and `y`: the pixel of the wrist.
    There is a row for each raised hand; a photo without any has one row with raised 0.

    Args:
        folder: Holds the photos and `labels.csv`.

    Returns:
        The photos, in the order of their first rows.

    Raises:
        RecordingError: There are no labels, a row is off, or a photo is not there; the message
            names the line.
    """
    path = Path(folder) / LABELS
    wrists: dict[str, list[tuple[float, float]]] = {}
    empty: dict[str, int] = {}
    for line, row in _rows(path):
        where = f"{path}: line {line}"
        name = (row["file"] or "").strip()
        if not name or not (path.parent / name).is_file():
            raise RecordingError(
                f"{where}: there is no photo {name!r} in {path.parent}; correct the name or "
                "remove the line."
            )
        hands = wrists.setdefault(name, [])
        if _is_raised(row, where):
            hands.append(_wrist(row, where))
        else:
            empty.setdefault(name, line)
        if hands and name in empty:
            raise RecordingError(
                f"{where}: {name} has raised hands, but line {empty[name]} or this one says "
                "raised 0; remove one of them."
            )
    if not wrists:
        raise RecordingError(f"{path}: contains no labels; add a line like `photo.jpg,1`.")
    return tuple(
        LabeledPhoto(path.parent / name, np.array(hands, dtype=np.float64).reshape(-1, 2))
        for name, hands in wrists.items()
    )


def _read_traits(path: Path) -> dict[str, dict[str, str]]:
    if not path.is_file():
        return {}
    try:
        with path.open(newline="", encoding="utf-8-sig") as file:
            reader = csv.DictReader(file, skipinitialspace=True, restval="")
            if "file" not in (reader.fieldnames or ()):
                raise RecordingError(
                    f"{path}: line 1: there is no column `file`; name the photos."
                )
            return {
                row.pop("file"): {name: value for name, value in row.items() if name and value}
                for row in reader
            }
    except (OSError, UnicodeDecodeError, csv.Error) as error:
        raise RecordingError(f"{path}: cannot be read ({error}).") from error


def _rows(path: Path) -> Iterator[tuple[int, dict[str, str]]]:
    try:
        with path.open(newline="", encoding="utf-8-sig") as file:
            reader = csv.DictReader(file, skipinitialspace=True, restval="")
            names = [name.strip() for name in reader.fieldnames or ()]
            if not {"file", "raised"} <= set(names) <= set(_COLUMNS):
                raise RecordingError(
                    f"{path}: line 1: the columns are {', '.join(names) or 'none'}; expected "
                    "file,raised or file,raised,x,y."
                )
            reader.fieldnames = names
            for row in reader:
                if None in row:
                    raise RecordingError(
                        f"{path}: line {reader.line_num}: more values than the columns "
                        f"{','.join(names)}."
                    )
                yield reader.line_num, row
    except FileNotFoundError as error:
        raise RecordingError(
            f"{path}: does not exist; write one with the columns file,raised or file,raised,x,y."
        ) from error
    except OSError as error:
        raise RecordingError(f"{path}: cannot be read ({error.strerror}).") from error
    except (UnicodeDecodeError, csv.Error) as error:
        raise RecordingError(f"{path}: is not a CSV file in UTF-8 ({error}).") from error


def _is_raised(row: dict[str, str], where: str) -> bool:
    text = row["raised"].strip().lower()
    if text not in _YES | _NO:
        raise RecordingError(f"{where}: raised is {row['raised']!r}; expected 1 or 0.")
    return text in _YES


def _wrist(row: dict[str, str], where: str) -> tuple[float, float]:
    texts = [row.get(name, "").strip() for name in ("x", "y")]
    if not any(texts):
        return float("nan"), float("nan")
    try:
        x, y = (float(text) for text in texts)
    except ValueError as error:
        raise RecordingError(
            f"{where}: x, y are {texts[0]!r}, {texts[1]!r}; expected a pixel, or neither."
        ) from error
    if not (0.0 <= x < np.inf and 0.0 <= y < np.inf):
        raise RecordingError(f"{where}: x, y are {x:g}, {y:g}; expected a pixel of the photo.")
    return x, y
