"""What does a map file say? A YAML file and a picture beside it, as map_server reads them.

A cell is as occupied as its pixel is dark (bright with `negate`). Source: Nav2's map_server,
`map_io.cpp`, and the ROS wiki's page on it.
"""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any, Literal

import cv2
import numpy as np
from pydantic import BaseModel, ConfigDict, Field, ValidationError, model_validator

from tracker.containers import FloatArray, OccupancyGrid
from tracker.containers.occupancy_grid import UNKNOWN, CellArray
from tracker.errors import ConfigError
from tracker.parameters.yaml_reading import read_yaml
from tracker.wording import shown

#: A map of 250 m x 250 m in cells of 5 cm has so many.
_MAX_CELLS = 25_000_000
_MAX_BYTES = 8 * _MAX_CELLS  # four channels of 16 bits
_FRAME_ID = "map"  # the frame of every map that map_server reads


class _MapFile(BaseModel):
    model_config = ConfigDict(extra="ignore", frozen=True, allow_inf_nan=False)

    image: str = Field(min_length=1)
    resolution: float = Field(gt=0.0, le=100.0)
    origin: Annotated[tuple[float, float, float], Field(strict=False)]
    negate: bool = False
    occupied_thresh: float = Field(0.65, ge=0.0, le=1.0)
    free_thresh: float = Field(0.25, ge=0.0, le=1.0)
    mode: Literal["trinary", "scale", "raw"] = "trinary"

    @model_validator(mode="after")
    def _possible(self) -> _MapFile:
        if self.free_thresh >= self.occupied_thresh:
            raise ValueError(
                f"free_thresh is {self.free_thresh:g}; allowed is below occupied_thresh, which is "
                f"{self.occupied_thresh:g}"
            )
        return self


def load_map(path: str | Path) -> OccupancyGrid:
    """Read a map in the frame `map`.

    Args:
        path: The YAML file; its `image` is a PGM, PNG or BMP file, relative to it.

    Raises:
        ConfigError: The file or its picture cannot be read; the message names what is wrong.
    """
    path = Path(path)
    document = read_yaml(path)
    if not isinstance(document, dict):
        raise ConfigError(
            f"{path}: contains no map; expected `image:`, `resolution:` and `origin:`."
        )
    try:
        said = _MapFile.model_validate(document)
    except ValidationError as error:
        reasons = "; ".join(_reason(item) for item in error.errors())
        raise ConfigError(f"{path}: {reasons}.") from error
    gray, opacity = _shades(path.parent / said.image)
    cells = _cells(said, gray, opacity)
    # Pictures count rows from the top, maps from the bottom.
    return OccupancyGrid(0, _FRAME_ID, said.resolution, said.origin, np.flipud(cells))


def _shades(path: Path) -> tuple[FloatArray, FloatArray | None]:
    """How bright each pixel is and how opaque, from 0 to 1; None where all of it is opaque."""
    try:
        size = path.stat().st_size
        if size > _MAX_BYTES:
            raise ConfigError(
                f"{path}: has {size} bytes; a map's picture has at most {_MAX_BYTES}."
            )
        contents = np.frombuffer(path.read_bytes(), np.uint8)
    except OSError as error:
        text = f"{path}: the map's picture cannot be read ({error.strerror})."
        raise ConfigError(text) from error
    try:
        picture = cv2.imdecode(contents, cv2.IMREAD_UNCHANGED) if len(contents) else None
    except cv2.error:  # larger than OpenCV decodes
        picture = None
    if picture is None or picture.dtype not in (np.uint8, np.uint16):
        raise ConfigError(f"{path}: is not a picture of 8 or 16 bits; expected PGM, PNG or BMP.")
    if picture.shape[0] * picture.shape[1] > _MAX_CELLS:
        raise ConfigError(
            f"{path}: has {picture.shape[1]}x{picture.shape[0]} pixels; a map has {_MAX_CELLS} "
            "cells at most. Cut it to the rooms that the robot works in."
        )
    brightest = 255.0 if picture.dtype == np.uint8 else 65_535.0
    shades = np.asarray(picture, np.float64).reshape(*picture.shape[:2], -1) / brightest
    has_opacity = shades.shape[2] in (2, 4)
    colors = shades[..., :-1] if has_opacity else shades
    return np.asarray(colors.mean(axis=-1)), shades[..., -1] if has_opacity else None


def _cells(said: _MapFile, gray: FloatArray, opacity: FloatArray | None) -> CellArray:
    """Percent of each cell, by map_server's three ways to read a picture."""
    if said.mode == "raw":
        number = np.round(255 * gray)
        return np.where(number <= 100, number, UNKNOWN).astype(np.int8)
    if said.mode == "trinary" and opacity is not None:
        gray = (3 * gray + opacity) / 4  # so does map_server, as one more color
    occupied = gray if said.negate else 1.0 - gray
    between = np.full(gray.shape, float(UNKNOWN))
    if said.mode == "scale":
        span = said.occupied_thresh - said.free_thresh
        between = np.rint(100 * (occupied - said.free_thresh) / span)
    is_taken, is_free = occupied > said.occupied_thresh, occupied < said.free_thresh
    cells = np.select([is_taken, is_free], [100.0, 0.0], between)
    if said.mode == "scale" and opacity is not None:
        cells[opacity < 1.0] = UNKNOWN
    return cells.astype(np.int8)


def _reason(item: Any) -> str:
    key = ".".join(map(str, item["loc"]))
    message = str(item["msg"])
    if item["type"] == "missing":
        return f"`{key}` is missing"
    if item["type"] == "value_error":
        return message.removeprefix("Value error, ")
    allowed = message.replace("Input should be ", "")
    return f"`{key}` is {shown(item['input'])}; allowed is {allowed}"
