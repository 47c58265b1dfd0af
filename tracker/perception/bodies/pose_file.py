"""Who is in the picture, by a pose model of the user's own?"""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import cv2
import numpy as np
import onnxruntime
from onnxruntime.capi import onnxruntime_pybind11_state as runtime_errors

from tracker.config import Config
from tracker.containers import ImageArray
from tracker.errors import ModelFileError
from tracker.perception.bodies.bodies import Bodies
from tracker.perception.bodies.pose_layouts import PoseLayout, recognize
from tracker.perception.models.sessions import open_file
from tracker.perception.pictures import Window, upright_strips

#: The window around somebody known is so many times as large as what was seen of them.
_MARGIN = 1.4
_NUMBERS: dict[str, Any] = {
    "tensor(float)": np.float32,
    "tensor(float16)": np.float16,
    "tensor(int32)": np.int32,
    "tensor(uint8)": np.uint8,
}


class PoseFile:
    """A pose model in an ONNX file, as `BodyLook`.

    Args:
        session: The opened file.
        origin: Its name, for messages.
        config: The pose group.

    Raises:
        ModelFileError: Its inputs and outputs are of no layout that is understood.
    """

    def __init__(self, session: onnxruntime.InferenceSession, origin: str, config: Config) -> None:
        self._session = session
        self._origin = origin
        self._layout: PoseLayout = recognize(
            origin, _shapes(session.get_inputs()), _shapes(session.get_outputs())
        )
        (self._input,) = session.get_inputs()
        if self._input.type not in _NUMBERS:
            raise ModelFileError(
                f"{origin} needs {self._input.type} as input; expected one of "
                f"{', '.join(_NUMBERS)}."
            )
        self.configure(config)

    @staticmethod
    def open(config: Config) -> PoseFile:
        """The file that `pose_model` names.

        Raises:
            ModelFileError: It is absent, no ONNX file, or of no layout that is understood.
            ConfigError: ONNX Runtime has no such execution provider.
        """
        session = open_file(
            Path(config.pose_model).expanduser(),
            threads=config.inference_threads,
            provider=config.execution_provider,
            remedy="`pose_model` must name a file in ONNX format, or be empty",
        )
        return PoseFile(session, config.pose_model, config)

    def windows(self, width: int, height: int) -> list[Window]:
        """The whole picture; strips for models that take one person for granted."""
        if self._layout.one_person:
            return upright_strips(width, height)
        return [(0, 0, width, height)]

    def around(
        self, bgr: ImageArray, window: Window, known: Bodies | None = None, most: int = 0
    ) -> Bodies:
        """Everybody whom the model sees in a part of the picture, known or not."""
        bodies = self._look(bgr, window)
        return bodies[bodies.score >= self._score_min]

    def again(self, bgr: ImageArray, known: Bodies) -> Bodies:
        """Whoever is nearest to where somebody known, one alone, was."""
        points = known.points_px[0][known.is_visible[0]]
        low, high = points.min(axis=0), points.max(axis=0)
        middle, half = (low + high) / 2, _MARGIN * (high - low).max() / 2
        size = (bgr.shape[1], bgr.shape[0])
        left, top = np.clip(middle - half, 0, size).astype(int).tolist()
        right, bottom = np.clip(middle + half, 0, size).astype(int).tolist()
        if right <= left or bottom <= top:
            return Bodies.none()
        found = self.around(bgr, (left, top, right - left, bottom - top))
        apart = np.linalg.norm(found.points_px - known.points_px, axis=-1).mean(axis=-1)
        return found[np.argsort(apart, kind="stable")[:1]]

    def configure(self, config: Config) -> None:
        """Take over changed parameters; the model stays."""
        self._score_min = config.pose_confidence

    def _look(self, bgr: ImageArray, window: Window) -> Bodies:
        """Everybody in a window, however unsure."""
        left, top, width, height = window
        (shape,) = _shapes([self._input]).values()
        size = self._layout.input_size(shape)
        part = bgr[top : top + height, left : left + width]
        picture, per_px = fit(part, size, self._layout.fill)
        numbers = self._layout.pack(picture, _NUMBERS[self._input.type])
        names = [output.name for output in self._session.get_outputs()]
        try:
            answers = self._session.run(names, {self._input.name: numbers})
            bodies = self._layout.decode(dict(zip(names, answers, strict=True)), size)
        except (
            runtime_errors.Fail,
            runtime_errors.InvalidArgument,
            runtime_errors.RuntimeException,
            ValueError,
        ) as error:
            reason = str(error).splitlines()[0]
            raise ModelFileError(
                f"{self._origin} looks like {self._layout.name} but its output is different "
                f"({reason}); export it again, for batches of one picture."
            ) from error
        points = np.where(np.isfinite(bodies.points_px), bodies.points_px, np.nan)
        return replace(bodies, points_px=points / per_px + (left, top))


def fit(bgr: ImageArray, size: tuple[int, int], fill: int) -> tuple[ImageArray, float]:
    """A picture in the upper left corner of one of another size, as large as it fits.

    Args:
        bgr: Shape (height, width, 3).
        size: Width and height of the result.
        fill: Gray of the rest, 0 to 255.

    Returns:
        The result, and how many of its pixels became of one.
    """
    height, width = bgr.shape[:2]
    per_px = min(size[0] / width, size[1] / height)
    inner = (max(1, round(width * per_px)), max(1, round(height * per_px)))
    way = cv2.INTER_AREA if per_px < 1.0 else cv2.INTER_LINEAR
    result = np.full((size[1], size[0], 3), fill, np.uint8)
    result[: inner[1], : inner[0]] = cv2.resize(bgr, inner, interpolation=way)
    return result, per_px


def _shapes(sides: list[Any]) -> dict[str, tuple[int, ...]]:
    return {
        side.name: tuple(size if isinstance(size, int) else -1 for size in side.shape)
        for side in sides
    }
