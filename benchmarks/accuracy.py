"""Who follows people better, and how fast? The product and Stone Soup's JPDA on the same scenes.

    python benchmarks/accuracy.py [--scenes 100] [--seconds 30] [--seed 1000] [--jobs 2] [NAME ...]

Three to eight people who walk and stop, seen with probability .95 and .6; all trackers get the
same measurements, and Stone Soup is told the true detection probability and clutter. Differences
from it are paired by scene, their intervals bootstrapped over the scenes. A name is an association
of the product, or `reference`, the textbook's tracker; without names all take part. By default a
small sample.
"""

from __future__ import annotations

import argparse
import time
from contextlib import nullcontext
from dataclasses import replace
from functools import partial

import numpy as np
from _contestants import begin, contestants
from _paired import Rows, comparison
from _stone_soup import StoneSoup
from rich.console import Console
from rich.progress import track

from tracker.evaluation.metrics.scores import TrialScores
from tracker.evaluation.studies.workers import Processes, run_in_order
from tracker.evaluation.trials.people_trial import draw_people_trial
from tracker.evaluation.trials.scenario import SCENARIOS, PeopleScenario, default_config

STONE_SOUP = "Stone Soup"
FIGURES = {
    "gospa_m": "GOSPA, m",
    "identity_switches_per_min": "identity switches/min",
    "missed_share": "missed share",
    "false_tracks": "false tracks/frame",
    "rmse_m": "RMSE, m",
    "ms_per_frame": "ms a frame",
}


def measurement_space(scenario: PeopleScenario) -> float:
    """Radians times meters over which clutter spreads."""
    x_from, x_to, _, y_to = scenario.area_m
    return 2 * float(np.arctan2(y_to, x_from)) * float(np.hypot(x_to, y_to) - x_from)


def stone_soup(scenario: PeopleScenario) -> StoneSoup:
    return StoneSoup(
        (float(np.deg2rad(scenario.bearing_std_deg)), scenario.range_std_m),
        detection_probability=scenario.detection_probability,
        clutter_density=scenario.clutter_per_frame / measurement_space(scenario),
    )


def score_scene(
    scenario: PeopleScenario, names: tuple[str, ...], seed: int, scene: int
) -> dict[str, dict[str, float]]:
    """Figures of each tracker, Stone Soup first."""
    config, theirs = default_config(scenario), stone_soup(scenario)
    trackers = {STONE_SOUP: lambda stamp_ns, sensed: theirs.step(stamp_ns, sensed.measurements)}
    trackers |= {name: begin(name, config) for name in names}
    scores = {name: TrialScores(config) for name in trackers}
    spent_s = dict.fromkeys(trackers, 0.0)
    drawn = draw_people_trial(scenario, seed, scene)
    for truth, sensed in drawn:  # frame by frame, so that other work slows all alike
        for name, follow in trackers.items():
            begin_s = time.perf_counter()
            tracks = follow(truth.stamp_ns, sensed)
            spent_s[name] += time.perf_counter() - begin_s
            scores[name].add(truth, tracks)
    return {
        name: scores[name].row() | {"ms_per_frame": 1e3 * spent_s[name] / len(drawn)}
        for name in trackers
    }


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("names", nargs="*", metavar="NAME", help=", ".join(contestants()))
    parser.add_argument("--scenes", type=int, default=10)
    parser.add_argument("--seconds", type=float, default=10.0)
    parser.add_argument("--seed", type=int, default=1000)
    parser.add_argument("--jobs", type=int, default=1, help="processes")
    words = parser.parse_args()
    names = tuple(dict.fromkeys(words.names)) or contestants()
    if unknown := [name for name in names if name not in contestants()]:
        parser.error(f"unknown: {', '.join(unknown)}; there are {', '.join(contestants())}.")
    to_stderr = Console(stderr=True)
    with Processes(words.jobs) if words.jobs > 1 else nullcontext() as crew:
        for name in ("people", "people-missed"):
            scenario = SCENARIOS[name]
            assert isinstance(scenario, PeopleScenario)
            scenario = replace(scenario, duration_s=words.seconds)
            units = [
                partial(score_scene, scenario, names, words.seed, scene)
                for scene in range(words.scenes)
            ]
            results = run_in_order(units, crew)
            scenes: list[Rows] = list(track(results, name, len(units), console=to_stderr))
            title = f"{name}: {len(scenes)} scenes of {words.seconds:g} s, seed {words.seed}"
            Console().print(comparison(title, FIGURES, scenes))


if __name__ == "__main__":
    main()
