"""Which weights does the verdict need? Fitted on real people's pictures and drawn ones.

    python benchmarks/fit_verdict.py ../shared/data/people ../shared/data/people_more

Each folder holds photos with labels.csv below it (`raised-hand evaluate --help`), and perhaps
clips/ with episodes.csv. Photos are shown as jittered looks; the evidence of every hand is noted,
real and drawn together, and `fit_weights` explains which call. The table for
`tracker/perception/verdict/weights.py` is printed, and how many hands are told when the weights
come from the other groups alone: a group is a `person` of attributes.csv, or what a file's name
begins with. Drawn people are one group; their seed is not that of any study.
"""

from __future__ import annotations

import argparse
import csv
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import cv2
import numpy as np
from _verdict_fit import fit_weights
from rich.console import Console
from rich.table import Table

from tracker.config import Config
from tracker.containers import CameraImage, FloatArray, ImageArray, IntArray
from tracker.evaluation.detection.clip_study import read_clips
from tracker.evaluation.detection.looks import jittered_looks
from tracker.evaluation.detection.scenes import caller_scene, draw_conditions, idlers_scene
from tracker.evaluation.trials.trial_seed import trial_rng
from tracker.perception import open_detector
from tracker.perception.call_finder import CallFinder
from tracker.perception.verdict.weights import NAMES
from tracker.simulation.motion import people_at
from tracker.simulation.projection import Viewpoint
from tracker.simulation.rendering.camera_view import CameraView, raised_hand_pixels
from tracker.simulation.scene import Scene
from tracker.simulation.stream import map_from_camera

LOOKS = 14
#: In place of raised wrists: the highest hand calls, and of the others nobody knows.
HIGHEST = np.full((1, 2), np.nan)
#: Cases that one may judge either way count less, and drawn people; people with few pictures count
#: more.
SHARES = {"sign_at_shoulder": 0.4, "clips": 3.0, "people_more": 2.0, "callers": 0.5, "idlers": 1.5}
#: A hand is the labeled one within so many lengths of it, or pixels.
_NEAR_HANDS, _NEAR_PX = 0.6, 12.0


@dataclass(frozen=True, slots=True, eq=False)
class Seen:
    """The hands of one photo, clip or scene.

    Attributes:
        group: Whoever should not be on both sides.
        share: How much it counts.
        evidence: Shape (N, F).
        calls: Shape (N,): 1, 0, or -1 where nobody knows.
    """

    group: str
    share: float
    evidence: FloatArray
    calls: IntArray


class Watcher:
    """Notes the evidence of hands, image by image."""

    def __init__(self) -> None:
        detector = open_detector(Config())
        assert isinstance(detector, CallFinder)
        self._detector = detector

    def play(
        self, images: Iterator[tuple[ImageArray, FloatArray | None]], group: str, share: float
    ) -> Seen:
        """Look at images ten times a second, each with its raised wrists; None is not known."""
        self._detector.reset()
        evidence, calls = [np.zeros((0, len(NAMES)))], [np.zeros(0, dtype=np.int64)]
        for number, (bgr, wrists_px) in enumerate(images):
            hands = self._detector.find(CameraImage(number * 100_000_000, "", bgr))
            assert self._detector.weighed is not None
            evidence.append(self._detector.weighed.evidence)
            if wrists_px is None:
                calls.append(np.full(len(hands), -1))
                continue
            if wrists_px is HIGHEST:
                rank = hands.wrist_px[:, 1].argsort().argsort()
                calls.append(np.where(rank == 0, 1, -1))
                continue
            apart = np.linalg.norm(hands.wrist_px[:, None] - wrists_px, axis=-1)
            near = np.maximum(_NEAR_HANDS * hands.length_px, _NEAR_PX)
            calls.append((apart < near[:, None]).any(axis=1).astype(np.int64))
        return Seen(group, share, np.concatenate(evidence), np.concatenate(calls))


def photos(watcher: Watcher, root: Path) -> Iterator[Seen]:
    """Every labeled photo below a folder."""
    people = read_people(root)
    for labels in sorted(root.glob("*/labels.csv")):
        wrists: dict[str, list[tuple[float, float]]] = {}
        for row in csv.DictReader(labels.open(encoding="utf-8")):
            hands = wrists.setdefault(row["file"], [])
            if row["raised"] == "1":
                hands.append((float(row["x"]), float(row["y"])))
        share = SHARES.get(labels.parent.name, 1.0) * SHARES.get(root.name, 1.0)
        for seed, (name, places) in enumerate(sorted(wrists.items())):
            bgr = cv2.imread(str(labels.parent / name))
            wrists_px = np.array(places).reshape(-1, 2)
            looks = jittered_looks(bgr, LOOKS, np.random.default_rng(seed))
            shown = ((look, wrists_px) for look in looks)
            yield watcher.play(shown, people.get(name, name.split("_")[0]), share)


def clips(watcher: Watcher, root: Path) -> Iterator[Seen]:
    """Every clip of a folder; while somebody calls, the highest hand does."""
    nobody = np.zeros((0, 2))
    for clip in read_clips(root):
        capture = cv2.VideoCapture(str(clip.path))
        step = max(round((capture.get(cv2.CAP_PROP_FPS) or 30.0) / 10.0), 1)
        frames = []
        while (got := capture.read())[0]:
            frames.append(got[1])
        shown = (
            (bgr, HIGHEST if any(a <= number / 10.0 <= b for a, b in clip.calls_s) else nobody)
            for number, bgr in enumerate(frames[::step])
        )
        yield watcher.play(shown, clip.path.name.split("_")[0], SHARES["clips"])


def drawn(watcher: Watcher, callers: int, idlers: int, seed: int) -> Iterator[Seen]:
    """Drawn people who call in every way, and some who do not."""
    conditions = draw_conditions((1.0, 2.0, 3.0, 4.0, 5.0), callers, np.random.default_rng(seed))
    for number, item in enumerate(conditions):
        rng = trial_rng(seed, number)
        scene = caller_scene(item, 2.0, 10.0, rng)
        yield watcher.play(rendered(scene, rng), "drawn", SHARES["callers"])
    for number in range(idlers):
        rng = trial_rng(seed, 1_000_000 + number)
        scene = idlers_scene(number, 8.0, (1.0, 5.0), 10.0, rng)
        yield watcher.play(rendered(scene, rng), "drawn", SHARES["idlers"])


def rendered(
    scene: Scene, rng: np.random.Generator
) -> Iterator[tuple[ImageArray, FloatArray | None]]:
    """Pictures of a scene; while the first person's arm moves, nobody knows."""
    painter = CameraView(scene, rng, sharp_from_m=min(p.path[0].x_m for p in scene.people) / 1.5)
    for number in range(round(scene.duration_s * scene.camera.rate_hz)):
        time_s = number / scene.camera.rate_hz
        people = people_at(scene, time_s)
        view = Viewpoint.of(scene.camera, map_from_camera(scene, time_s))
        wrists_px: FloatArray | None = np.zeros((0, 2))
        if people.hand_up[0]:
            wrists_px = raised_hand_pixels(scene, view, people, 0)[:1]
        elif people.raised[0] > 0.0:
            wrists_px = None
        yield painter.render(view, people), wrists_px


def read_people(root: Path) -> dict[str, str]:
    """Who is in which file, where attributes.csv tells."""
    path = root / "attributes.csv"
    rows = csv.DictReader(path.open(encoding="utf-8")) if path.is_file() else ()
    return {Path(row["file"]).name: row["person"] for row in rows if row.get("person")}


def stacked(seen: list[Seen]) -> tuple[FloatArray, IntArray, FloatArray]:
    """Evidence, calls and shares; each kind of hand counts once in a photo, clip or scene."""
    known = [item.calls >= 0 for item in seen]
    calls = [item.calls[rows] for item, rows in zip(seen, known, strict=True)]
    share = [
        item.share * np.minimum(1.0, 5.0 / np.maximum(np.bincount(kind, minlength=2)[kind], 5)) / 5
        for item, kind in zip(seen, calls, strict=True)
    ]
    evidence = [item.evidence[rows] for item, rows in zip(seen, known, strict=True)]
    return np.concatenate(evidence), np.concatenate(calls), np.concatenate(share)


def told(seen: list[Seen], bias: float, weights: dict[str, float]) -> list[str]:
    """How many of the hands that call, and of the others, are told right."""
    evidence, calls, _ = stacked(seen)
    is_right = (bias + evidence @ [weights[name] for name in NAMES] > 0.0) == (calls == 1)
    return [f"{is_right[calls == kind].sum()} of {(calls == kind).sum()}" for kind in (1, 0)]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folders", nargs="*", type=Path)
    parser.add_argument("--callers", type=int, default=80)
    parser.add_argument("--idlers", type=int, default=48)
    parser.add_argument("--seed", type=int, default=901)
    words = parser.parse_args()
    watcher, seen = Watcher(), []
    for folder in words.folders:
        seen += [*photos(watcher, folder), *clips(watcher, folder)]
    seen += drawn(watcher, words.callers, words.idlers, words.seed)
    console = Console()
    bias, weights = fit_weights(*stacked(seen))
    console.print(f"BIAS = {bias:.2f}")
    for name, value in weights.items():
        console.print(f"{name} {value:.2f}")
    table = Table("group left out", "hands that call", "others")
    groups = sorted({item.group for item in seen})
    for group in groups if len(groups) > 1 else ():
        others = fit_weights(*stacked([item for item in seen if item.group != group]))
        table.add_row(group, *told([item for item in seen if item.group == group], *others))
    console.print(table)


if __name__ == "__main__":
    main()
