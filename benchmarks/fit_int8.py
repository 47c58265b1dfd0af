"""Which numbers do models need to compute in 8 bits? Fitted on drawn people, checked on others.

    python benchmarks/fit_int8.py --write
    python benchmarks/fit_int8.py --check ../shared/data/photos ../shared/data/people/photos

The detector looks at drawn callers; what its models are given is kept. In each block that computes
in 8 bits these are measured: the range of what it reads, how far each channel of its wide part
reaches, and what its output lacks on average, block after block. `--write` puts that into
`tracker/perception/models/int8/ranges.npz`; raise `CONVERTER_VERSION` with it. Drawn people of
another seed, and photos, say how far the results move from those in single precision. No real
picture takes part in the fit.
"""

from __future__ import annotations

import argparse
from collections import defaultdict
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any

import cv2
import numpy as np
import onnx
import onnxruntime
from onnx import TensorProto, helper
from rich.console import Console
from rich.table import Table

from tracker.config import Config
from tracker.containers import CameraImage
from tracker.evaluation.detection.scenes import caller_scene, draw_conditions
from tracker.perception import open_detector
from tracker.perception.models import ModelStore
from tracker.perception.models.catalog import INT8_MODELS
from tracker.perception.models.int8.quantize import (
    CLIPPED_AT,
    Block,
    BlockRange,
    find_blocks,
    quantize,
)
from tracker.perception.models.int8.ranges import load_ranges, save_ranges
from tracker.simulation import simulate

FIT_SEED, CHECK_SEED = 7001, 7002
DISTANCES_M = (0.8, 1.2, 1.8, 2.6, 3.6)
#: Scenes of the fit, and inputs of each model that it and the check look at, at most.
SCENES, FIT_INPUTS, CHECK_INPUTS = 30, 90, 600
#: So many blocks at the beginning stay in single precision, since they would move the results.
LEFT_FLOAT = {
    "hand_landmark_lite": 0,
    "hand_landmark_full": 0,
    "pose_detection": 1,
}
#: How much farther than on the pictures of the fit a channel may reach, and how far at least.
MARGIN, REACH_MIN = 1.25, 0.2
#: A hand of which the model in single precision is so sure must not be lost.
SURE, LOST = 0.8, 0.5
Inputs = dict[str, list[np.ndarray]]


def record(images: Iterable[tuple[bool, CameraImage]]) -> Inputs:
    """What the models of either complexity are given, images of shape (1, height, width, 3).

    Args:
        images: Each with True where a new sequence begins.
    """
    configs = [
        Config(model_complexity=complexity, inference_threads=1, model_numbers="fp32")
        for complexity in (0, 1)
    ]
    kept: Inputs = defaultdict(list)
    plain = onnxruntime.InferenceSession

    class Recorder(plain):  # type: ignore[misc, valid-type]
        def __init__(self, path: str, *others: Any, **named: Any) -> None:
            super().__init__(path, *others, **named)
            self._name = Path(path).stem

        def run(self, names: Any, feed: dict[str, np.ndarray], *others: Any) -> Any:
            if self._name in INT8_MODELS:
                kept[self._name].append(feed["image"].astype(np.float16))
            return super().run(names, feed, *others)

    onnxruntime.InferenceSession = Recorder
    try:
        detectors = [open_detector(config) for config in configs]
        for is_first, image in images:
            for detector in detectors:
                if is_first:
                    detector.reset()
                detector.find(image)
    finally:
        onnxruntime.InferenceSession = plain
    return kept


def drawn(seed: int, scenes: int) -> Iterator[tuple[bool, CameraImage]]:
    """Pictures of drawn people who call, of all kinds and in any light."""
    rng = np.random.default_rng(seed)
    for number, conditions in enumerate(draw_conditions(DISTANCES_M, scenes, rng)):
        scene, is_first = caller_scene(conditions, 0.8, 10.0, rng), True
        for _, event in simulate(scene, seed=number):
            if isinstance(event, CameraImage):
                yield is_first, event
                is_first = False


def photos(folders: Iterable[Path], looks: int = 5) -> Iterator[tuple[bool, CameraImage]]:
    """Each photo a few times."""
    for path in (path for folder in folders for path in sorted(folder.glob("*.[jp][pn]g"))):
        picture = cv2.imread(str(path))
        for look in range(looks):
            yield look == 0, CameraImage(look * 100_000_000, "", picture)


def spread(images: list[np.ndarray], count: int) -> list[np.ndarray]:
    """So many of them, evenly."""
    rows = np.linspace(0, len(images) - 1, min(count, len(images))).round().astype(int)
    return [images[row] for row in rows]


def believed(content: bytes, images: list[np.ndarray]) -> list[np.ndarray]:
    """Inputs to fit to: those that hold a hand or a person, if the model can tell."""
    images = spread(images, 4 * FIT_INPUTS)
    session = opened(content)
    if "presence" in [output.name for output in session.get_outputs()]:
        chances = answers(session, ["presence"], images)
        images = [image for image, (chance,) in zip(images, chances, strict=True) if chance > LOST]
    return spread(images, FIT_INPUTS)


def opened(content: bytes, *more_outputs: str) -> onnxruntime.InferenceSession:
    """A session of one thread that gives inner values as well."""
    model = onnx.load_from_string(content)
    model.graph.output.extend(
        helper.make_tensor_value_info(name, TensorProto.FLOAT, None) for name in more_outputs
    )
    options = onnxruntime.SessionOptions()
    options.intra_op_num_threads, options.log_severity_level = 1, 3
    return onnxruntime.InferenceSession(model.SerializeToString(), options)


def answers(
    session: onnxruntime.InferenceSession, names: list[str], images: list[np.ndarray]
) -> Iterator[list[np.ndarray]]:
    for image in images:
        yield session.run(names, {"image": image.astype(np.float32)})


def means(content: bytes, names: list[str], images: list[np.ndarray]) -> dict[str, np.ndarray]:
    """Of values of shape (1, C, height, width), by channel."""
    parts: dict[str, list[np.ndarray]] = {name: [] for name in names}
    for values in answers(opened(content, *names), names, images):
        for name, value in zip(names, values, strict=True):
            parts[name].append(value.mean(axis=(0, 2, 3), dtype=np.float64))
    return {name: np.mean(parts[name], axis=0) for name in names}


def reaches(content: bytes, names: list[str], images: list[np.ndarray]) -> dict[str, np.ndarray]:
    """Up to which value each channel of the values of these names counts."""
    highest = dict.fromkeys(names, np.float32(-np.inf))
    for values in answers(opened(content, *names), names, images):
        for name, value in zip(names, values, strict=True):
            highest[name] = np.maximum(highest[name], value.max(axis=(0, 2, 3)))
    return {
        name: np.clip(MARGIN * value, REACH_MIN, CLIPPED_AT).astype(np.float16)
        for name, value in highest.items()
    }


def fit(content: bytes, left_float: int, images: list[np.ndarray]) -> dict[str, BlockRange]:
    """Ranges, reaches and shifts of the blocks of one model."""
    blocks: list[Block] = list(find_blocks(onnx.load_from_string(content).graph))[left_float:]
    read = sorted({block.widen.input[0] for block in blocks})
    low, high = dict.fromkeys(read, 0.0), dict.fromkeys(read, 0.0)
    for values in answers(opened(content, *read), read, images):
        for name, value in zip(read, values, strict=True):
            low[name] = min(low[name], float(value.min()))
            high[name] = max(high[name], float(value.max()))
    wanted = means(content, [block.name for block in blocks], images)
    reach = reaches(content, [block.widen.output[0] for block in blocks], images)
    ranges: dict[str, BlockRange] = {}
    for block in blocks:
        source, wide = block.widen.input[0], reach[block.widen.output[0]]
        nothing = np.zeros(len(wanted[block.name]), np.float32)
        ranges[block.name] = BlockRange(low[source], high[source], wide, nothing)
        found = means(quantize(content, ranges), [block.name], images)[block.name]
        shift = (wanted[block.name] - found).astype(np.float32)
        ranges[block.name] = ranges[block.name]._replace(shift=shift)
    return ranges


def check(name: str, plain: bytes, quantized: bytes, images: list[np.ndarray]) -> list[str]:
    """How far results move where the model in single precision is sure, and what is lost."""
    names = ["boxes", "scores"] if name == "pose_detection" else ["landmarks", "presence"]
    before, after = (
        [np.concatenate(parts) for parts in zip(*answers(session, names, images), strict=True)]
        for session in (opened(plain), opened(quantized))
    )
    side = images[0].shape[1]
    if name == "pose_detection":
        best = before[1][:, :, 0].argmax(axis=1)
        rows = np.arange(len(best))
        score = [1.0 / (1.0 + np.exp(-found[1][:, :, 0].max(axis=1))) for found in (before, after)]
        points = [found[0][rows, best, 4:].reshape(len(best), -1, 2) for found in (before, after)]
    else:
        score = [found[1].reshape(len(images)) for found in (before, after)]
        points = [found[0].reshape(len(images), 21, 3)[:, :, :2] for found in (before, after)]
    sure = score[0] >= SURE
    # A hand is half as long as its region.
    moved = np.linalg.norm(points[0] - points[1], axis=-1)[sure].mean(axis=1) / (side / 2)
    median, p95 = np.percentile(moved, (50, 95)) if sure.any() else (np.nan, np.nan)
    return [
        *(name, str(sure.sum()), f"{median:.2%}", f"{p95:.2%}"),
        *(str((score[1][sure] < SURE).sum()), str((score[1][sure] < LOST).sum())),
        str((score[1][score[0] < LOST] >= SURE).sum()),
    ]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--scenes", type=int, default=SCENES)
    parser.add_argument("--write", action="store_true", help="into the package; checks nothing")
    parser.add_argument("--check", nargs="*", type=Path, default=[], help="folders of photos")
    words = parser.parse_args()
    store = ModelStore()
    plain = {name: store.path(name).read_bytes() for name in INT8_MODELS}
    if words.write:
        inputs = record(drawn(FIT_SEED, words.scenes))
        save_ranges(
            {
                name: fit(plain[name], LEFT_FLOAT[name], believed(plain[name], inputs[name]))
                for name in INT8_MODELS
            }
        )
        return
    quantized = {name: quantize(plain[name], load_ranges(name)) for name in INT8_MODELS}
    sources = {"drawn": drawn(CHECK_SEED, words.scenes)}
    if words.check:
        sources["photos"] = photos(words.check)
    for title, images in sources.items():
        inputs = record(images)
        columns = (
            "model",
            "sure",
            "moved, median",
            "95 %",
            f"below {SURE}",
            f"below {LOST}",
            "new",
        )
        table = Table(*columns, title=title)
        for name in INT8_MODELS:
            shown = spread(inputs[name], CHECK_INPUTS)
            table.add_row(*check(name, plain[name], quantized[name], shown))
        Console().print(table)


if __name__ == "__main__":
    main()
