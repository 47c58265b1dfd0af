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
from tracker.containers import CameraImage, ImageArray
from tracker.errors import ModelFileError
from tracker.perception.bodies import Bodies, one_row_each
from tracker.perception.known_bodies import KnownBodies
from tracker.perception.palm_search import Window
from tracker.perception.pose_layouts import PoseLayout, recognize
from tracker.perception.sessions import open_file
from tracker.perception.strips import upright_strips

#: Somebody not found again for so long, in seconds, is forgotten (guess).
_FORGET_AFTER_S = 1.0
_NUMBERS: dict[str, Any] = {
    "tensor(float)": np.float32,
    "tensor(float16)": np.float16,
    "tensor(int32)": np.int32,
    "tensor(uint8)": np.uint8,
}


class PoseFile:
    """A pose model in an ONNX file.

    Args:
        session: The opened file.
        origin: Its name, for messages.

    Raises:
        ModelFileError: Its inputs and outputs are of no layout that is understood.
    """

    def __init__(self, session: onnxruntime.InferenceSession, origin: str) -> None:
        self._session = session
        self._origin = origin
        self.layout: PoseLayout = recognize(
            origin, _shapes(session.get_inputs()), _shapes(session.get_outputs())
        )
        (self._input,) = session.get_inputs()
        if self._input.type not in _NUMBERS:
            raise ModelFileError(
                f"{origin} wants {self._input.type} as its input; needed is one of "
                f"{', '.join(_NUMBERS)}."
            )

    @staticmethod
    def open(path: Path, config: Config) -> PoseFile:
        """The model of an ONNX file.

        Raises:
            ModelFileError: The file is absent, no ONNX file, or of no layout that is understood.
            ConfigError: ONNX Runtime has no such execution provider.
        """
        session = open_file(
            path.expanduser(),
            threads=config.inference_threads,
            provider=config.execution_provider,
            remedy="`pose_model` must name a file in ONNX format, or be empty",
        )
        return PoseFile(session, str(path))

    def look(self, bgr: ImageArray, window: Window) -> Bodies:
        """Everybody whom the model sees in a part of the picture, however unsure.

        Args:
            bgr: Shape (height, width, 3), the full image.
            window: Left, top, width, height of the part, inside the picture.

        Raises:
            ModelFileError: The model fails, or its answers are not what its layout promises.
        """
        left, top, width, height = window
        (shape,) = _shapes([self._input]).values()
        size = self.layout.input_size(shape)
        part = bgr[top : top + height, left : left + width]
        picture, per_px = fit(part, size, self.layout.fill)
        numbers = self.layout.pack(picture, _NUMBERS[self._input.type])
        names = [output.name for output in self._session.get_outputs()]
        try:
            answers = self._session.run(names, {self._input.name: numbers})
            bodies = self.layout.decode(dict(zip(names, answers, strict=True)), size)
        except (
            runtime_errors.Fail,
            runtime_errors.InvalidArgument,
            runtime_errors.RuntimeException,
            ValueError,
        ) as error:
            reason = str(error).splitlines()[0]
            raise ModelFileError(
                f"{self._origin} looks like {self.layout.name} but does not answer like it "
                f"({reason}); export it anew, for batches of one picture."
            ) from error
        points = np.where(np.isfinite(bodies.points_px), bodies.points_px, np.nan)
        return replace(bodies, points_px=points / per_px + (left, top))


class PoseFileFinder(KnownBodies):
    """A pose model of the user's own as `BodyDetector`.

    Models for one person look at one upright strip after the other, the rest at whole pictures.

    Args:
        model: The opened file.
        config: The pose group.
    """

    def __init__(self, model: PoseFile, config: Config) -> None:
        super().__init__(config)
        self._model = model

    @staticmethod
    def open(path: Path, config: Config) -> PoseFileFinder:
        """The model of an ONNX file.

        Raises:
            ModelFileError: The file is absent, no ONNX file, or of no layout that is understood.
            ConfigError: ONNX Runtime has no such execution provider.
        """
        return PoseFileFinder(PoseFile.open(path, config), config)

    def reset(self) -> None:
        """Forget everybody."""
        super().reset()
        self._looks = 0

    def _look(self, image: CameraImage, known: Bodies) -> Bodies:
        known = known[:0] if self._sees_all else known[known.age_s <= _FORGET_AFTER_S]
        known = Bodies.concatenate(self._seen_now(image), known)
        return known[one_row_each(known)]

    @property
    def _sees_all(self) -> bool:
        return not self._model.layout.one_person

    def _seen_now(self, image: CameraImage) -> Bodies:
        windows: list[Window] = [(0, 0, image.width, image.height)]
        if not self._sees_all:
            windows = upright_strips(image.width, image.height)
        window = windows[self._looks % len(windows)]
        self._looks += 1
        found = self._model.look(image.bgr, window)
        return found[found.score >= self._config.pose_confidence]


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
