"""Do our landmarks agree with MediaPipe's own?

Each photo of a folder, as it is and mirrored, goes through mediapipe.solutions.hands (static mode,
several hands) and through the product, from a clean memory. For each hand of MediaPipe's the
nearest of ours counts; it agrees when their landmarks differ by less than a fiftieth of the hand,
on average. For comparison MediaPipe looks a second time, at photos whose gray values are off by
one at most: small hands move by more than that. mediapipe wants numpy below 2, so a venv of its
own:

    python -m venv .venv-mediapipe && .venv-mediapipe/bin/pip install -e ".[mediapipe]"
    .venv-mediapipe/bin/python benchmarks/parity.py ../shared/data/photos
"""

from __future__ import annotations

import argparse
import json
from importlib.util import find_spec
from pathlib import Path

import cv2
import numpy as np
from rich.console import Console
from rich.table import Table

from tracker.config import Config
from tracker.containers import CameraImage
from tracker.perception import HandFinder

AGREES_BELOW = 0.02  # of the hand's size
NAMES = ("lite", "full")  # by complexity
PHOTOS = Path(__file__).parents[1] / "../shared/data/photos"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("photos", type=Path, nargs="?", default=PHOTOS, help="a folder of them")
    parser.add_argument("--numbers", choices=("fp32", "int8"), default="fp32", help="ours")
    parser.add_argument("--json", action="store_true", help="for machines")
    words = parser.parse_args()
    pictures = [cv2.imread(str(path)) for path in sorted(words.photos.glob("*.[jp][pn]g"))]
    if not pictures or find_spec("mediapipe") is None:
        missing = "mediapipe" if pictures else f"photo in {words.photos}"
        print(f"left out: there is no {missing}")
        return
    pictures += [np.ascontiguousarray(picture[:, ::-1]) for picture in pictures]
    looks = [compare(pictures, complexity, words.numbers) for complexity in range(len(NAMES))]
    ours, own = zip(*looks, strict=True)
    compared = dict(zip(NAMES, ours, strict=True))
    compared |= {"both": np.concatenate(ours), "mediapipe itself": np.concatenate(own)}
    rows = {name: sum_up(off) for name, off in compared.items()}
    if words.json:
        print(json.dumps(rows))
        return
    table = Table(title=f"{len(pictures)} photos, half of them mirrored")
    for column in ("models", "hands", "agree", "apart, of the hand", "95 %"):
        table.add_column(column, justify="right")
    for name, row in rows.items():
        shares = (f"{row[key]:.3%}" for key in ("median", "p95"))
        table.add_row(name, str(row["hands"]), f"{row['agree']:.1%}", *shares)
    Console().print(table)


def sum_up(off: np.ndarray) -> dict[str, float]:
    """Share of MediaPipe's hands that agree, and how far those that were found are apart."""
    found = off[np.isfinite(off)]
    median, p95 = np.percentile(found, (50, 95)) if len(found) else (np.nan, np.nan)
    agree = float(np.mean(off < AGREES_BELOW)) if len(off) else np.nan
    return {"hands": len(off), "agree": agree, "median": float(median), "p95": float(p95)}


def compare(
    pictures: list[np.ndarray], complexity: int, numbers: str
) -> tuple[np.ndarray, np.ndarray]:
    """How far each hand of MediaPipe's is from the nearest of ours, and of its own second look."""
    from mediapipe.python.solutions.hands import Hands

    # As MediaPipe: the whole picture alone, and hands that point anywhere.
    config = Config(
        model_complexity=complexity,
        downscale_factor=1,
        search_regions_per_frame=1,
        search_lean_max_deg=180.0,
        model_numbers=numbers,
    )
    finder, rng = HandFinder(config), np.random.default_rng(1)
    ours: list[float] = []
    own: list[float] = []
    with Hands(
        static_image_mode=True,
        model_complexity=complexity,
        max_num_hands=config.max_hands,
        min_detection_confidence=config.detection_confidence,
        min_tracking_confidence=config.tracking_confidence,
    ) as mediapipe:

        def look(picture: np.ndarray) -> np.ndarray:
            """Landmarks of every hand, in pixels."""
            hands = mediapipe.process(cv2.cvtColor(picture, cv2.COLOR_BGR2RGB))
            size = (picture.shape[1], picture.shape[0])
            points = [
                [(point.x, point.y) for point in hand.landmark]
                for hand in hands.multi_hand_landmarks or ()
            ]
            return np.reshape(points, (-1, 21, 2)) * size

        for picture in pictures:
            finder.reset()
            found = finder.find(CameraImage(0, "", picture)).landmarks_px
            off = rng.integers(-1, 2, picture.shape)
            again = look(np.clip(picture + off, 0, 255).astype(np.uint8))
            for expected in look(picture):
                ours.append(difference(expected, found))
                own.append(difference(expected, again))
    return np.array(ours), np.array(own)


def difference(expected: np.ndarray, found: np.ndarray) -> float:
    """Mean distance of landmarks to the nearest hand found, in sizes of the hand; or infinite."""
    if len(found) == 0:
        return np.inf
    apart = np.linalg.norm(found - expected, axis=-1).mean(axis=-1).min()
    return float(apart / np.ptp(expected, axis=0).max())


if __name__ == "__main__":
    main()
