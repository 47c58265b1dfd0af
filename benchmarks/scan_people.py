"""Are people found in real scans? Recall and precision where somebody has marked the legs.

    python benchmarks/scan_people.py [RECORDING.bag]

The recording holds scans and, for each, a PoseArray of marked legs; by default it is the one of
person-following beside the checkout. Not everybody there is marked, so precision is a lower bound.
Beside it, what finding costs a scan.
"""

from __future__ import annotations

import argparse
import time
from pathlib import Path

import numpy as np
from _annotated_scans import read_annotated_scans, score_clusters
from rich.console import Console
from rich.table import Table

from tracker import Config
from tracker.geometry import RigidTransform
from tracker.ranging import Background, locate_scan, scan_people

RECORDING = (
    Path(__file__).parents[1] / "../shared/data/scans/leg_tracker__positive_1_extracted.bag"
)
WITHIN_M = (0.1, 0.2, 0.3)


def milliseconds_per_scan(path: Path, config: Config) -> tuple[float, float]:
    """Median time of finding people, and of learning the background."""
    background, finding, learning = Background(), [], []
    for scan, _ in read_annotated_scans(path):
        begin = time.perf_counter()
        located = locate_scan(scan, RigidTransform())
        people = scan_people(located, config)
        middle = time.perf_counter()
        background.observe(located, people, config.background_after_s)
        background.holds(people.xy_m)
        finding.append(middle - begin)
        learning.append(time.perf_counter() - middle)
    return 1e3 * float(np.median(finding)), 1e3 * float(np.median(learning))


def main() -> None:
    """Score and time, and print."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("recording", nargs="?", type=Path, default=RECORDING)
    path = parser.parse_args().recording
    console = Console()
    if not path.exists():
        console.print(f"{path}: there is no such recording; nothing was measured.")
        return
    config = Config()
    table = Table(title=path.name)
    for name in ("within", "recall", "precision", "median distance"):
        table.add_column(name, justify="right")
    for within_m in WITHIN_M:
        score = score_clusters(path, config, within_m)
        table.add_row(
            f"{within_m} m",
            f"{score.recall:.3f} ({score.found} of {score.people})",
            f"{score.precision:.3f} ({score.right} of {score.clusters})",
            f"{score.distance_m:.3f} m",
        )
    console.print(table)
    finding_ms, learning_ms = milliseconds_per_scan(path, config)
    console.print(f"a scan: find people {finding_ms:.2f} ms, background {learning_ms:.2f} ms")


if __name__ == "__main__":
    main()
