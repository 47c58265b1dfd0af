"""What does a depth camera cost a frame? The chain with it and without, turn by turn.

The first seconds of a simulated restaurant, with hands that are told instead of models, which cost
the same either way. The processor's time counts, not the clock's, so that other work on the
machine does not. Run: python benchmarks/depth_cost.py
"""

from __future__ import annotations

import time

import numpy as np

from tracker import CameraImage, Config, Hands, Pipeline
from tracker.containers import DepthImage
from tracker.messages import Event, decode, encode
from tracker.perception.detector import Hints
from tracker.simulation import load_scene, simulate
from tracker.simulation.scene import Depth

UNTIL_S = 4.0
#: Name, depth camera, whether its images come packed.
CAMERAS = [
    ("registered, mm", Depth(), False),
    ("registered, m", Depth(unit="m"), False),
    ("beside, mm", Depth(registered=False), False),
    ("registered, mm, compressedDepth", Depth(), True),
]


class OneHand:
    """Sees one raised hand and its owner, always in the same place."""

    work = None

    def find(self, image: CameraImage, hints: Hints) -> Hands:
        """As every detector."""
        landmarks = np.tile(np.array([[320.0, 150.0]]), (1, 21, 1))
        landmarks[0, 12, 1] -= 80.0
        one = np.ones(1)
        return Hands(landmarks, one, one, one > 0, one, np.array([[370.0, 300.0]]))

    def reset(self) -> None:
        """There is nothing to forget."""

    def configure(self, config: Config) -> None:
        """Nothing depends on it."""


def sensed(depth: Depth, *, is_packed: bool) -> list[tuple[int, Event]]:
    """What the sensors say; packed images stay packed until they are used."""
    scene = load_scene("restaurant").model_copy(update={"depth": depth, "duration_s": UNTIL_S})
    events: list[tuple[int, Event]] = []
    for log_ns, event in simulate(scene, 1):
        if isinstance(event, DepthImage):
            (event,) = decode(
                *encode(event, jpeg_quality=90 if is_packed else None), is_depth=True
            )
        events.append((log_ns, event))
    return events


def frames_ms(events: list[tuple[int, Event]], config: Config) -> list[float]:
    """Milliseconds of each processed image."""
    pipeline, took = Pipeline(config, OneHand()), []
    for log_ns, event in events:
        pipeline.add(event, log_ns)
        began_s = time.process_time()
        for _ in pipeline.advance(log_ns):
            took.append(1e3 * (time.process_time() - began_s))
            began_s = time.process_time()
    return took


def main() -> None:
    """Print the medians."""
    print(f"{'depth camera':34} {'without':>8} {'with':>8} {'more':>8}   ms a frame, medians")
    for name, depth, is_packed in CAMERAS:
        events = sensed(depth, is_packed=is_packed)
        without, with_depth = [], []
        for _ in range(5):
            without.append(frames_ms(events, Config(depth_source="scan")))
            with_depth.append(frames_ms(events, Config(depth_source="both")))
        few, many = np.min(without, axis=0), np.min(with_depth, axis=0)
        more = np.median(many - few)
        print(f"{name:34} {np.median(few):8.2f} {np.median(many):8.2f} {more:8.2f}")


if __name__ == "__main__":
    main()
