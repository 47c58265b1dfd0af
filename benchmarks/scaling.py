"""How many Monte Carlo trials in a second, on one and two workers?

    python benchmarks/scaling.py [--seconds 20] [--rounds 3]

Processes of this machine and Dask workers of one thread each. Whoever runs them, the rows are
compared with those of the first. Contenders take turns, and the best round
counts: other work on the machine can only slow them down. Where it does, look at the processor's
time, of all processes together, that a trial takes: where it is the same on one and on two
workers, nothing is lost between them. A unit of nothing tells what it costs to hand one out.
"""

from __future__ import annotations

import argparse
import os
import time
from collections.abc import Callable, Iterator
from concurrent.futures import Executor
from contextlib import ExitStack, contextmanager
from functools import partial

import numpy as np
import psutil
from rich.console import Console
from rich.table import Table

from tracker.evaluation.studies.cluster import dask_cluster
from tracker.evaluation.studies.monte_carlo import monte_carlo
from tracker.evaluation.studies.study import Study
from tracker.evaluation.studies.workers import Processes, run_in_order

SCENARIOS = ("people", "known-people", "outliers")
EMPTY_UNITS = 1000


@contextmanager
def dask(count: int) -> Iterator[Executor]:
    from distributed import LocalCluster

    words = {"threads_per_worker": 1, "dashboard_address": ":0"}
    with (
        LocalCluster(n_workers=count, **words) as cluster,
        dask_cluster(cluster.scheduler_address) as executor,
    ):
        yield executor


def enough_trials(scenario: str, seconds: float) -> int:
    """As many as one process runs in about that time, and two can share."""
    least = 40 if scenario == "people" else 500
    monte_carlo(scenario, 2)  # compiles
    begin_s = time.perf_counter()
    monte_carlo(scenario, least)
    return least * max(round(seconds / (time.perf_counter() - begin_s)), 1)


def processor_s() -> float:
    """What this process and those it began have used so far."""
    me = psutil.Process()
    times = [process.cpu_times() for process in (me, *me.children(recursive=True))]
    return sum(item.user + item.system for item in times)


def measure(trials: int, run: Callable[[], object]) -> tuple[float, float]:
    """Seconds by the clock, and of the processor, for each of so many trials."""
    begin_s, begin_processor_s = time.perf_counter(), processor_s()
    run()
    spent_s, spent_processor_s = time.perf_counter() - begin_s, processor_s() - begin_processor_s
    return spent_s / trials, spent_processor_s / trials


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--seconds", type=float, default=20.0, help="of one process's work")
    parser.add_argument("--rounds", type=int, default=3)
    words = parser.parse_args()
    table = Table(title=f"{os.cpu_count()} cores", title_justify="left")
    for column in ("work", "trials", "who", "trials/s", "processor, ms/trial"):
        table.add_column(column, justify="right")
    with ExitStack() as stack:
        crews = {
            "1 process": stack.enter_context(Processes(1)),
            "2 processes": stack.enter_context(Processes(2)),
            "1 Dask worker": stack.enter_context(dask(1)),
            "2 Dask workers": stack.enter_context(dask(2)),
        }
        for scenario in SCENARIOS:
            trials = enough_trials(scenario, words.seconds)
            best: dict[str, tuple[float, float]] = {}
            expected = None
            for _ in range(words.rounds):
                for name, crew in crews.items():
                    monte_carlo(scenario, 4, seed=9, executor=crew)  # starts and compiles
                    studies: list[Study] = []
                    run = partial(monte_carlo, scenario, trials, executor=crew)
                    costs = measure(trials, lambda run=run, to=studies: to.append(run()))
                    best[name] = tuple(map(min, best.get(name, costs), costs))
                    expected = expected or studies[0].rows
                    for key, values in studies[0].rows.items():
                        assert np.array_equal(values, expected[key], equal_nan=True), (name, key)
            add_rows(table, scenario, trials, best)
        nothing = [partial(int, number) for number in range(EMPTY_UNITS)]
        empty = {
            name: measure(EMPTY_UNITS, lambda crew=crew: list(run_in_order(nothing, crew)))
            for name, crew in crews.items()
        }
        add_rows(table, "empty units", EMPTY_UNITS, empty)
    Console().print(table)


def add_rows(table: Table, work: str, count: int, costs: dict[str, tuple[float, float]]) -> None:
    for name, (clock_s, used_s) in costs.items():
        table.add_row(work, f"{count:,}", name, f"{1 / clock_s:,.1f}", f"{1e3 * used_s:,.3f}")


if __name__ == "__main__":
    main()
