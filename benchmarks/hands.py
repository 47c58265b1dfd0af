"""How long do hands take, beside mediapipe.solutions.hands? Both in one run, a frame each in turn.

    python benchmarks/hands.py [--frames 150] [--busy] [--mediapipe-python PYTHON]

The same drawn hands drift through 640 x 480 pixels; both use the same weights (complexity 1),
video mode, and as many hands as there are. Each does its frame while the other rests, so
that other work on the machine slows both alike. mediapipe 0.10 wants numpy 1: name a Python that
has it (`pip install mediapipe==0.10.21` in a venv of its own), which answers from a process of
its own; its frames come as RGB, which ours have to be turned into. With `--busy` a process beside
keeps one core at work all the time.

  followed    as many hands allowed as there are: landmarks alone, as mediapipe does then
  searching   more are allowed, so that one place a frame is searched beside them
  fp32        as followed, with models in single precision where they run in 8 bits otherwise
"""

from __future__ import annotations

import argparse
import json
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, nullcontext

import numpy as np

WIDTH, HEIGHT = 640, 480
WARM_UP = 10
Step = Callable[[int, np.ndarray], tuple[float, int]]


def serve_mediapipe(hands: int) -> None:
    """The other process: pictures come in, seconds and the number of hands go out."""
    import mediapipe

    detector = mediapipe.solutions.hands.Hands(
        static_image_mode=False, max_num_hands=hands, model_complexity=1
    )
    size = WIDTH * HEIGHT * 3
    while len(data := sys.stdin.buffer.read(size)) == size:
        rgb = np.frombuffer(data, np.uint8).reshape(HEIGHT, WIDTH, 3)[..., ::-1].copy()
        start = time.perf_counter()
        found = detector.process(rgb).multi_hand_landmarks
        print(json.dumps([time.perf_counter() - start, len(found or [])]), flush=True)


class MediaPipe:
    """mediapipe in a process of its own."""

    def __init__(self, python: str, hands: int) -> None:
        self._process = subprocess.Popen(
            [python, __file__, "--serve", str(hands)],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
        )

    def step(self, frame: int, bgr: np.ndarray) -> tuple[float, int]:
        """Seconds that it took, and how many hands it found."""
        self._process.stdin.write(bgr.tobytes())
        self._process.stdin.flush()
        answer = self._process.stdout.readline()
        if not answer:
            raise SystemExit("mediapipe has ended; does the Python of --mediapipe-python have it?")
        seconds, found = json.loads(answer)
        return seconds, found

    def close(self) -> None:
        """End the process."""
        self._process.stdin.close()
        self._process.wait()


def product(**parameters: object) -> Step:
    """The product's hand finder."""
    from tracker import CameraImage, Config
    from tracker.perception import HandFinder

    config = Config(model_complexity=1, search_regions_per_frame=1).replace(**parameters)
    finder = HandFinder(config)

    def step(frame: int, bgr: np.ndarray) -> tuple[float, int]:
        image = CameraImage(frame * 100_000_000, "camera", bgr)
        start = time.perf_counter()
        found = finder.find(image)
        return time.perf_counter() - start, len(found)

    return step


def drawn_hands(count: int) -> Callable[[int], np.ndarray]:
    """Pictures of raised hands that drift to and fro, each over a noisy wall."""
    import cv2

    from tracker.simulation.rendering.canvas import Canvas
    from tracker.simulation.rendering.hand_shape import paint_hand

    canvas = Canvas(0.11, 0.32, 700.0)
    canvas.paint([[(0.0, -0.04, 0.03), (0.0, 0.08, 0.025)]], (120, 160, 214), 0.02)
    paint_hand(canvas, (0.0, 0.08), 0.0, (120, 160, 214), thumb_right=True, palm_visible=True)
    hand = canvas.sprite().bgra
    wall = np.random.default_rng(1).normal(150.0, 6.0, (HEIGHT, WIDTH, 3))
    wall = cv2.GaussianBlur(wall.clip(0, 255).astype(np.uint8), (0, 0), 1.0)

    def picture(frame: int) -> np.ndarray:
        bgr = wall.copy()
        for number in range(count):
            left = round(
                (number + 0.5) * WIDTH / count - hand.shape[1] / 2 + 6 * np.sin(frame / 9)
            )
            top = round(120 + 8 * np.cos(frame / 7 + number))
            under = bgr[top : top + hand.shape[0], left : left + hand.shape[1]]
            clear = 1.0 - hand[..., 3:] / 255.0
            under[:] = under * clear + hand[..., :3]
        return bgr

    return picture


@contextmanager
def busy_core() -> Iterator[None]:
    """A process that never rests, wherever the system puts it."""
    process = subprocess.Popen([sys.executable, "-c", "while True: pass"])
    try:
        yield
    finally:
        process.kill()
        process.wait()


def measure(hands: int, frames: int, python: str) -> dict[str, np.ndarray]:
    """Seconds of each frame of each contender, in turn; ends where they find other hands."""
    from tracker.perception.models import ModelStore, runs_here

    picture, peer = drawn_hands(hands), None
    steps: dict[str, Step] = {
        "followed": product(max_hands=hands),
        "searching": product(max_hands=hands + 4),
    }
    if runs_here(ModelStore(), "auto") != runs_here(ModelStore(), "fp32"):
        steps["fp32"] = product(max_hands=hands, model_numbers="fp32")
    if subprocess.run([python, "-c", "import mediapipe"], capture_output=True).returncode == 0:
        peer = MediaPipe(python, hands)
        steps = {"mediapipe": peer.step, **steps}
    spent: dict[str, list[float]] = {name: [] for name in steps}
    counts: dict[str, set[int]] = {name: set() for name in steps}
    for frame in range(-WARM_UP, frames):
        bgr = picture(frame)
        for name, step in steps.items():
            seconds, found = step(frame + WARM_UP, bgr)
            if frame >= 0:
                spent[name].append(seconds)
                counts[name].add(found)
    if peer is not None:
        peer.close()
    for name, found in counts.items():
        if found != {hands}:
            raise SystemExit(f"{name} found {sorted(found)} of {hands} hands: nothing to compare")
    return {name: np.array(times) for name, times in spent.items()}


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--frames", type=int, default=150)
    parser.add_argument("--mediapipe-python", default=sys.executable, metavar="PYTHON")
    parser.add_argument("--serve", type=int, help=argparse.SUPPRESS)
    parser.add_argument("--busy", action="store_true", help="keep one core at work beside")
    words = parser.parse_args()
    if words.serve:
        serve_mediapipe(words.serve)
        return
    from rich.console import Console
    from rich.table import Table

    from tracker.perception.models import processor_kind

    beside = "one of them busy" if words.busy else "nothing started beside"
    title = f"milliseconds of a frame; all found every hand; {beside}\n{processor_kind()}"
    table = Table(title=title, title_justify="left")
    for column in ("hands", "", "median", "p99", "of mediapipe's median"):
        table.add_column(column, justify="right")
    for hands in (1, 4):
        with busy_core() if words.busy else nullcontext():
            spent = measure(hands, words.frames, words.mediapipe_python)
        peer = np.median(spent["mediapipe"]) if "mediapipe" in spent else np.nan
        for name, times in spent.items():
            table.add_row(
                str(hands),
                name,
                f"{1e3 * np.median(times):.1f}",
                f"{1e3 * np.percentile(times, 99):.1f}",
                "-" if np.isnan(peer) else f"{np.median(times) / peer:.2f}",
            )
    Console().print(table)


if __name__ == "__main__":
    main()
