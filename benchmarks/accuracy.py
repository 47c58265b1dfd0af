"""Who follows people better, and how fast? The product and Stone Soup's JPDA on the same scenes.

    python benchmarks/accuracy.py [--scenes 100] [--seconds 30] [--seed 1000]

Three to eight people who walk and stop, seen with probability .95 and .6; both trackers get the
same measurements, and Stone Soup is told the true detection probability and clutter. Differences
are paired, their intervals are bootstrapped over the scenes. By default a small sample.
"""

from __future__ import annotations

import argparse
import time
from dataclasses import replace

import numpy as np
from _stone_soup import StoneSoup
from rich.console import Console
from rich.table import Table

from tracker import PersonTracker
from tracker.evaluation.metrics.scores import TrialScores
from tracker.evaluation.trials.people_trial import draw_people_trial
from tracker.evaluation.trials.scenario import SCENARIOS, PeopleScenario, default_config

FIGURES = ("gospa_m", "identity_switches_per_min", "missed_share", "false_tracks", "rmse_m")


def measurement_space(scenario: PeopleScenario) -> float:
    """Radians times meters over which clutter spreads."""
    x_from, x_to, _, y_to = scenario.area_m
    return 2 * float(np.arctan2(y_to, x_from)) * float(np.hypot(x_to, y_to) - x_from)


def compare(name: str, scenes: int, seconds: float, seed: int) -> tuple[dict, dict]:
    """Figures of each scene and tracker, shape (scenes,), and seconds per frame."""
    scenario = SCENARIOS[name]
    assert isinstance(scenario, PeopleScenario)
    scenario = replace(scenario, duration_s=seconds)
    config = default_config(scenario)
    rows: dict[str, list[dict[str, float]]] = {"product": [], "Stone Soup": []}
    spent = dict.fromkeys(rows, 0.0)
    frames = 0
    for scene in range(scenes):
        drawn = draw_people_trial(scenario, seed, scene)
        frames += len(drawn)
        trackers = {
            "product": PersonTracker(config),
            "Stone Soup": StoneSoup(
                (float(np.deg2rad(scenario.bearing_std_deg)), scenario.range_std_m),
                detection_probability=scenario.detection_probability,
                clutter_density=scenario.clutter_per_frame / measurement_space(scenario),
            ),
        }
        scores = {tracker: TrialScores(config) for tracker in trackers}
        for truth, sensed in drawn:  # frame by frame, so that other work slows both alike
            for who, tracker in trackers.items():
                begin = time.perf_counter()
                if isinstance(tracker, PersonTracker):
                    tracks = tracker.step(
                        truth.stamp_ns,
                        sensed.measurements,
                        view=sensed.view,
                        scan_view=sensed.scan_view,
                    )
                else:
                    tracks = tracker.step(truth.stamp_ns, sensed.measurements)
                spent[who] += time.perf_counter() - begin
                scores[who].add(truth, tracks)
        for who in rows:
            rows[who].append(scores[who].row())
    figures = {
        who: {key: np.array([row[key] for row in rows[who]]) for key in FIGURES} for who in rows
    }
    return figures, {who: value / frames for who, value in spent.items()}


def paired_interval(difference: np.ndarray, rng: np.random.Generator) -> tuple[float, float]:
    """95 % bootstrap interval of the mean."""
    means = rng.choice(difference, (4000, len(difference))).mean(axis=1)
    low, high = np.quantile(means, [0.025, 0.975])
    return float(low), float(high)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--scenes", type=int, default=10)
    parser.add_argument("--seconds", type=float, default=10.0)
    parser.add_argument("--seed", type=int, default=1000)
    words = parser.parse_args()
    console = Console()
    for name in ("people", "people-missed"):
        figures, seconds = compare(name, words.scenes, words.seconds, words.seed)
        table = Table(
            title=f"{name}: {words.scenes} scenes of {words.seconds:g} s, seed {words.seed}",
            title_justify="left",
        )
        for column in ("", "product", "Stone Soup JPDA", "difference", "95 % interval"):
            table.add_column(column, justify="right" if column else "left")
        rng = np.random.default_rng(0)
        for key in FIGURES:
            ours, theirs = figures["product"][key], figures["Stone Soup"][key]
            difference = ours - theirs
            low, high = paired_interval(difference[np.isfinite(difference)], rng)
            table.add_row(
                key,
                f"{np.nanmean(ours):.3f}",
                f"{np.nanmean(theirs):.3f}",
                f"{np.nanmean(difference):+.3f}",
                f"{low:+.3f} to {high:+.3f}",
            )
        ours_ms, theirs_ms = (1e3 * seconds[who] for who in ("product", "Stone Soup"))
        table.add_row("ms a frame", f"{ours_ms:.2f}", f"{theirs_ms:.2f}", "", "")
        table.add_row("times as fast", f"{theirs_ms / ours_ms:.0f}", "1", "", "")
        console.print(table)


if __name__ == "__main__":
    main()
