"""Which weights tell the signs of hands apart? Fitted on drawn hands, and checked on others.

    python benchmarks/fit_gestures.py --write
    python benchmarks/fit_gestures.py --check ../shared/data/photos ../shared/data/people

Hands of all kinds are drawn (`tracker.simulation.hand_signs`), far more varied than people's are,
and a small network is fitted to them by gradient descent (Adam, Kingma and Ba, 2015). `--write`
puts it into `tracker/perception/gestures/signs.npz`. Drawn hands of another seed, and real ones
whose sign is known by their file's name or by attributes.csv, as they are and mirrored, say how
well it does. No real picture takes part in the fit.
"""

from __future__ import annotations

import argparse
import csv
import time
from collections import Counter, defaultdict
from collections.abc import Iterator
from itertools import pairwise
from pathlib import Path
from typing import Any

import cv2
import numpy as np
from rich.console import Console
from rich.table import Table

from tracker.config import Config
from tracker.containers import CameraImage, FloatArray, Hands, IntArray
from tracker.gesture import Gesture
from tracker.perception.gestures import model
from tracker.perception.gestures.model import SIGNS, SignNetwork, sign_probabilities
from tracker.perception.gestures.over_time import SURE
from tracker.perception.gestures.reading import GestureReader
from tracker.perception.gestures.shape import hand_shape
from tracker.perception.hands.hand_finder import HandFinder
from tracker.simulation.hand_signs import ANYHOW, HOLDS, draw_hands

FIT_SEED, CHECK_SEED = 1701, 1702
#: Fitted to turns, sizes and noise beyond those that are asked for.
FIT = {"turn_max_deg": 40.0, "size_px": (25.0, 250.0), "noise": (0.008, 0.035)}
_HIDDEN, _KINDS = (64, 32), 6
_EPOCHS, _BATCH, _RATE, _DECAY, _SMOOTH = 30, 512, 3e-3, 1e-4, 0.02
_NONES = [name for name, hold in HOLDS.items() if hold.gesture == Gesture.NONE]
_SIGNS = [name for name in HOLDS if name not in _NONES]
#: Images of each photo that are shown: the search takes some to see all of it.
_LOOKS = 4
#: What the names of HaGRID's signs mean here; the others mean nothing.
HAGRID = {
    "palm": Gesture.PALM, "stop": Gesture.PALM, "fist": Gesture.FIST, "one": Gesture.POINT,
    "peace": Gesture.VICTORY, "like": Gesture.THUMB_UP, "dislike": Gesture.THUMB_DOWN,
}  # fmt: skip


def drawn(count: int, seed: int, **how: Any) -> tuple[FloatArray, IntArray]:
    """Landmarks and signs of hands: so many of each sign, and four times as many that say nothing.

    The latter are shared among everything that is no sign.
    """
    rng = np.random.default_rng(seed)
    none = max(4 * count // (len(_NONES) + 6), 1)
    parts = [draw_hands(name, count, rng, **how) for name in _SIGNS]
    parts += [draw_hands(name, none, rng, **how) for name in [*_NONES, ANYHOW, ANYHOW]]
    parts += [
        draw_hands(name, none, rng, edge_on=True, **how) for name in _SIGNS if name != "thumb"
    ]
    return (
        np.concatenate([part.landmarks_px for part in parts]),
        np.concatenate([part.gesture for part in parts]),
    )


def fit(shapes: FloatArray, kinds: IntArray, rng: np.random.Generator) -> SignNetwork:
    """The network that tells these kinds, shape (N,), from these shapes, (N, 40)."""
    middle, spread = shapes.mean(axis=0), shapes.std(axis=0) + 1e-6
    sizes = [shapes.shape[1], *_HIDDEN, _KINDS]
    weights = [rng.normal(0.0, a**-0.5, (a, b)) for a, b in pairwise(sizes)]
    parts = [*weights, *(np.zeros(size) for size in sizes[1:])]
    network = SignNetwork(tuple(parts[:3]), tuple(parts[3:]))
    scaled = (shapes - middle) / spread
    wanted = np.eye(_KINDS)[kinds] * (1.0 - _SMOOTH) + _SMOOTH / _KINDS
    mean, square = ([np.zeros_like(part) for part in parts] for _ in range(2))
    steps = _EPOCHS * (len(kinds) // _BATCH)
    for step in range(1, steps + 1):
        rows = rng.integers(len(kinds), size=_BATCH)
        rate = _RATE * (1.0 + np.cos(np.pi * step / steps)) / 2.0
        for number, slope in enumerate(_slopes(network, scaled[rows], wanted[rows])):
            mean[number] += 0.1 * (slope - mean[number])
            square[number] += 0.001 * (slope**2 - square[number])
            ahead = mean[number] / (1.0 - 0.9**step)
            parts[number] -= rate * ahead / (np.sqrt(square[number] / (1 - 0.999**step)) + 1e-8)
    first = parts[0] / spread[:, None]
    return SignNetwork((first, *parts[1:3]), (parts[3] - middle @ first, *parts[4:]))


def _slopes(network: SignNetwork, shapes: FloatArray, wanted: FloatArray) -> list[FloatArray]:
    """Of the cross entropy, and a little of the weights' squares, by weights and then biases."""
    layers = network.hidden(shapes)
    wrong = (network.softmax(layers[-1]) - wanted) / len(shapes)
    by_weight, by_bias = [], []
    for weight, layer in zip(reversed(network.weights), reversed(layers), strict=True):
        by_weight.append(layer.T @ wrong + _DECAY * weight)
        by_bias.append(wrong.sum(axis=0))
        wrong = (wrong @ weight.T) * (1.0 - layer**2)
    return [*reversed(by_weight), *reversed(by_bias)]


def named(chances: FloatArray) -> IntArray:
    """The sign that is sure, shape (N,), of probabilities of shape (N, 7); NONE elsewhere."""
    best = chances.argmax(axis=-1)
    return np.where(chances.max(axis=-1) >= SURE, best, int(Gesture.NONE))


def real(folder: Path) -> Iterator[tuple[str, Path, Gesture]]:
    """Photos whose sign is known: what they are of, the file, and the sign."""
    for path in sorted(folder.glob("hagrid_gesture_*.png")):
        name = path.stem.removeprefix("hagrid_gesture_")
        yield f"HaGRID {name}", path, HAGRID.get(name, Gesture.NONE)
    table = folder / "attributes.csv"
    words = {"open": Gesture.PALM, "fist": Gesture.FIST}
    for row in csv.DictReader(table.open(encoding="utf-8")) if table.is_file() else ():
        if row["hand"] in words:
            yield f"{row['kind']} {row['hand']}", folder / row["file"], words[row["hand"]]


def check_real(folders: list[Path], complexity: int) -> Table:
    """What is told of the highest hand of each photo, as it is and mirrored, after four images."""
    config = Config(model_complexity=complexity, search_lean_max_deg=180.0)
    finder = HandFinder(config)
    told: dict[str, Counter[str]] = defaultdict(Counter)
    for kind, path, sign in (item for folder in folders for item in real(folder)):
        picture = cv2.imread(str(path))
        assert picture is not None, path
        for bgr in (picture, np.ascontiguousarray(picture[:, ::-1])):
            finder.reset()
            reader = GestureReader()
            for number in range(_LOOKS):
                stamp_ns = number * 100_000_000
                hands = finder.find(CameraImage(stamp_ns, "", bgr))
                hands = reader.read(stamp_ns, hands, config)
            told[kind][_told_of_highest(hands, sign)] += 1
    table = Table("photos", "right", "told", title=f"model_complexity {complexity}")
    for kind, words in told.items():
        found = sum(words.values()) - words["no hand"]
        others = ", ".join(f"{word} {n}" for word, n in words.most_common() if word != "right")
        table.add_row(kind, f"{words['right']} of {found}", others)
    return table


def _told_of_highest(hands: Hands, sign: Gesture) -> str:
    if not len(hands):
        return "no hand"
    found = Gesture(int(hands.gesture[hands.wrist_px[:, 1].argmin()]))
    return "right" if found == sign else found.word


def check_drawn(network: SignNetwork, count: int) -> Table:
    """How many hands of another seed are told right, turned by up to 30 degrees, from 40 px on."""
    landmarks, gesture = drawn(count, CHECK_SEED)
    found = named(sign_probabilities(landmarks, network))
    table = Table("drawn", "right", *(sign.word for sign in SIGNS))
    for sign in SIGNS:
        mine = gesture == sign
        counts = np.bincount(found[mine], minlength=len(SIGNS))
        table.add_row(sign.word, f"{(found[mine] == sign).mean():.3f}", *map(str, counts))
    table.add_row("all", f"{(found == gesture).mean():.3f}")
    return table


def check_cost(network: SignNetwork) -> str:
    """How long one image of two hands takes."""
    landmarks, _ = drawn(1, CHECK_SEED)
    began_s = time.process_time()
    for _ in range(1000):
        sign_probabilities(landmarks[:2], network)
    return f"{(time.process_time() - began_s) / 2:.3f} ms of a processor for each of two hands"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--hands", type=int, default=8000, help="of each sign")
    parser.add_argument("--write", action="store_true", help="into the package")
    parser.add_argument("--check", nargs="*", type=Path, default=[], help="folders of photos")
    words = parser.parse_args()
    console = Console()
    network = SignNetwork.load() if words.check else None
    if network is None:
        landmarks, gesture = drawn(words.hands, FIT_SEED, **FIT)
        kinds = np.minimum(gesture, model.THUMB)  # up or down
        network = fit(hand_shape(landmarks), kinds, np.random.default_rng(FIT_SEED))
    if words.write:
        network.save(Path(model.__file__).with_name("signs.npz"))
    console.print(check_drawn(network, 2000))
    console.print(check_cost(network))
    for complexity in (0, 1) if words.check else ():
        console.print(check_real(words.check, complexity))


if __name__ == "__main__":
    main()
