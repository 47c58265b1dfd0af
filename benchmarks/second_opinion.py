"""What does the second opinion of body poses cost beside the hand models?

One drawn scene of several people, some with a hand up, goes through the detectors in turn, picture
by picture, so that other work on the machine slows all alike: read the ratios. The costs of an
image differ: an owner is looked for twice a second, a strip where something moved in every third.
"""

from __future__ import annotations

import argparse
import time

import numpy as np
from rich.console import Console
from rich.table import Table

from tracker.config import Config
from tracker.containers import CameraImage
from tracker.perception import HandDetector, open_detector
from tracker.simulation import scene_from_mapping
from tracker.simulation.motion import people_at
from tracker.simulation.projection import Viewpoint
from tracker.simulation.rendering.camera_view import CameraView
from tracker.simulation.stream import map_from_camera

CONTENDERS = {
    "hands alone": {"pose_opinion": "none"},
    "evidence": {},
    "pose alone": {"detector": "pose"},
}
PLACES = [(1.2, 0.4, True), (2.2, -0.6, True), (3.0, 0.7, False), (3.6, 0.0, False)]
WARM_UP = 10  # images; everybody is found by then


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--images", type=int, default=40)
    words = parser.parse_args()
    detectors = {
        name: open_detector(Config(model_complexity=1).replace(**parameters))
        for name, parameters in CONTENDERS.items()
    }
    spent_ms = {name: np.zeros(words.images) for name in detectors}
    raised = dict.fromkeys(detectors, 0)
    for number, image in enumerate(draw_images(words.images + WARM_UP), start=-WARM_UP):
        for name, detector in detectors.items():
            milliseconds, hands_up = timed(detector, image)
            if number >= 0:
                spent_ms[name][number] = milliseconds
                raised[name] += hands_up
    table = Table(title=f"{len(PLACES)} people, two of them with a hand up", title_justify="left")
    for column in ("detector", "mean ms", "ratio", "p99 ms", "hands up seen"):
        table.add_column(column, justify="right")
    base = spent_ms["hands alone"].mean()
    for name, milliseconds in spent_ms.items():
        mean, p99 = milliseconds.mean(), np.percentile(milliseconds, 99)
        seen = f"{raised[name] / words.images:.2f}"
        table.add_row(name, f"{mean:.0f}", f"{mean / base:.2f}", f"{p99:.0f}", seen)
    Console().print(table)


def timed(detector: HandDetector, image: CameraImage) -> tuple[float, int]:
    """Milliseconds of one image, and how many hands are up in it."""
    start = time.perf_counter()
    hands = detector.find(image)
    return 1e3 * (time.perf_counter() - start), int(hands.raised.sum())


def draw_images(count: int) -> list[CameraImage]:
    """The same scene again and again, under fresh pixel noise."""
    scene = scene_from_mapping(
        {
            "duration_s": 60.0,
            "camera": {"z_m": 1.2},
            "people": [
                {
                    "id": row + 1,
                    "path": [{"x_m": x, "y_m": y}],
                    "raises": [{"from_s": 0.0, "until_s": 60.0}] if is_up else [],
                }
                for row, (x, y, is_up) in enumerate(PLACES)
            ],
        }
    )
    view = Viewpoint.of(scene.camera, map_from_camera(scene, 1.0))
    painter, people = CameraView(scene, np.random.default_rng(0)), people_at(scene, 1.0)
    return [
        CameraImage(number * 100_000_000, "", painter.render(view, people))
        for number in range(count)
    ]


if __name__ == "__main__":
    main()
