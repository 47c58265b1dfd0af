"""Do our landmarks agree with MediaPipe's own?

Each photo of a folder goes through mediapipe.solutions.hands (static mode, several hands) and
through the product, from a clean memory. For each hand of MediaPipe's the nearest of ours counts;
it agrees when their landmarks differ by less than a fiftieth of the hand, on average.

    python -m venv .venv-mediapipe
    .venv-mediapipe/bin/pip install "mediapipe==0.10.21" "numpy<2" -e .
    .venv-mediapipe/bin/python benchmarks/parity.py ../shared/data/photos
"""

from __future__ import annotations

import argparse
import json
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import cv2
import numpy as np
from rich.console import Console
from rich.table import Table

from tracker.config import Config
from tracker.containers import CameraImage
from tracker.perception import HandFinder

AGREES_BELOW = 0.02  # of the hand's size
PHOTOS = Path(__file__).parents[1] / "../shared/data/photos"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("photos", type=Path, nargs="?", default=PHOTOS)
    parser.add_argument("--complexity", type=int, choices=(0, 1), nargs="+", default=[0, 1])
    parser.add_argument("--json", action="store_true", help="for machines")
    words = parser.parse_args()
    pictures = [cv2.imread(str(path)) for path in sorted(words.photos.glob("*.[jp][pn]g"))]
    if not pictures or find_spec("mediapipe") is None:
        what = "mediapipe" if pictures else f"photos in {words.photos}"
        print(f"left out: there is no {what}")
        return
    rows = {complexity: compare(pictures, complexity) for complexity in words.complexity}
    if words.json:
        print(json.dumps(rows))
        return
    table = Table(title="landmarks against mediapipe.solutions.hands", title_justify="left")
    for column in ("complexity", "photos", "its hands", "ours", "agree", "median", "p95"):
        table.add_column(column, justify="right")
    for complexity, row in rows.items():
        table.add_row(
            str(complexity),
            str(len(pictures)),
            str(row["hands"]),
            str(row["ours"]),
            f"{row['agreeing']:.1%}",
            f"{row['median']:.3%}",
            f"{row['p95']:.3%}",
        )
    Console().print(table)


def compare(pictures: list[np.ndarray], complexity: int) -> dict[str, Any]:
    """Share of MediaPipe's hands that agree, and how far all found hands are apart."""
    from mediapipe.python.solutions.hands import Hands

    config = Config(model_complexity=complexity, downscale_factor=1)
    finder = HandFinder(config)
    differences: list[float] = []
    ours = 0
    with Hands(
        static_image_mode=True,
        model_complexity=complexity,
        max_num_hands=config.max_hands,
        min_detection_confidence=config.detection_confidence,
        min_tracking_confidence=config.tracking_confidence,
    ) as mediapipe:
        for picture in pictures:
            answer = mediapipe.process(cv2.cvtColor(picture, cv2.COLOR_BGR2RGB))
            finder.reset()
            found = finder.find(CameraImage(0, "", picture)).landmarks_px
            ours += len(found)
            size = (picture.shape[1], picture.shape[0])
            for hand in answer.multi_hand_landmarks or ():
                expected = np.array([(point.x, point.y) for point in hand.landmark]) * size
                differences.append(difference(expected, found))
    off = np.array(differences)
    seen = off[np.isfinite(off)]
    return {
        "hands": len(off),
        "ours": ours,
        "agreeing": float((off < AGREES_BELOW).mean()),
        "median": float(np.median(seen)),
        "p95": float(np.percentile(seen, 95)),
    }


def difference(expected: np.ndarray, found: np.ndarray) -> float:
    """Mean distance of landmarks to the nearest hand found, in sizes of the hand."""
    if len(found) == 0:
        return np.inf
    apart = np.linalg.norm(found - expected, axis=-1).mean(axis=-1).min()
    return float(apart / np.ptp(expected, axis=0).max())


if __name__ == "__main__":
    main()
