"""Does the whole chain keep up with 10 Hz? Median and tail of every stage, on the demo's scene.

    python benchmarks/chain.py [--scene restaurant] [--seconds 20] [--numbers auto]

Per processed image: find hands as configured, the second opinion included, range and track, draw
and write the outputs; then the median's share of one period at the configured rate. Run it on an
idle machine; other work shows in the tail first.
"""

from __future__ import annotations

import argparse
import tempfile
import time
from pathlib import Path

import numpy as np
from rich.console import Console
from rich.table import Table

from tracker import Config, Pipeline
from tracker.containers import CameraImage, Hands
from tracker.perception import HandDetector, open_detector
from tracker.perception.detector import NO_HINTS, Hints
from tracker.perception.models import ModelStore, ensure_models, processor_kind
from tracker.replay.outputs import ReplayOutputs
from tracker.simulation import load_scene, simulate
from tracker.tracking.machine_frame import compile_tracker


def timed(detector: HandDetector) -> list[float]:
    """Let a detector note the seconds that each image takes it; gives the list it writes to."""
    find, seconds = detector.find, []

    def find_and_note(image: CameraImage, hints: Hints = NO_HINTS) -> Hands:
        begin = time.perf_counter()
        hands = find(image, hints)
        seconds.append(time.perf_counter() - begin)
        return hands

    detector.find = find_and_note
    return seconds


def run(config: Config, scene_name: str, seconds: float) -> dict[str, np.ndarray]:
    """Milliseconds of each stage for each processed image."""
    detector = open_detector(config)
    find_s = timed(detector)
    pipeline = Pipeline(config, detector)
    whole, outputs_s = [], []
    with tempfile.TemporaryDirectory() as folder:
        with ReplayOutputs(Path(folder), config) as outputs:
            first_ns = None
            for log_ns, event in simulate(load_scene(scene_name), seed=1):
                first_ns = first_ns or log_ns
                if log_ns - first_ns > seconds * 1e9:
                    break
                pipeline.add(event, log_ns)
                begin = time.perf_counter()
                for image, result in pipeline.advance(log_ns):
                    whole.append(time.perf_counter() - begin)
                    begin = time.perf_counter()
                    outputs.write(image, result)
                    outputs_s.append(time.perf_counter() - begin)
                    begin = time.perf_counter()
    find_ms, whole_ms = 1e3 * np.array(find_s), 1e3 * np.array(whole)
    return {
        "find hands": find_ms,
        "range and track": whole_ms - find_ms,
        "draw and write": 1e3 * np.array(outputs_s),
        "whole chain": whole_ms + 1e3 * np.array(outputs_s),
    }


def main() -> None:
    """Print a table for each model complexity."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--scene", default="restaurant")
    parser.add_argument("--seconds", type=float, default=20.0)
    parser.add_argument("--numbers", choices=("auto", "fp32", "int8"), default="auto")
    words = parser.parse_args()
    ensure_models(ModelStore())
    compile_tracker(print)
    print(processor_kind())
    for complexity in (0, 1):
        config = Config(model_complexity=complexity, model_numbers=words.numbers)
        period_ms = 1e3 / config.processing_rate
        stages = run(config, words.scene, words.seconds)
        count = len(stages["whole chain"])
        title = (
            f"{words.scene}, 640x480, complexity {complexity}, models {words.numbers}, "
            f"{count} images"
        )
        table = Table("stage", "median", "p99", f"share of {period_ms:.0f} ms", title=title)
        for name, times_ms in stages.items():
            median = np.median(times_ms)
            tail = np.percentile(times_ms, 99)
            share = f"{100 * median / period_ms:.0f} %"
            table.add_row(name, f"{median:.1f} ms", f"{tail:.1f} ms", share)
        Console().print(table)


if __name__ == "__main__":
    main()
