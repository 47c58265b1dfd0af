"""How many Monte Carlo trials in a second, on one and two workers?

    python benchmarks/scaling.py [--seconds 20] [--rounds 3]

Processes of this machine and, with the extra `cluster`, Dask workers of one thread. Whoever runs
them, the rows are compared with those of the first. Contenders take turns; the best round counts,
for other work on the machine can only slow them down. A unit of nothing tells what it costs to
hand one out.
"""

from __future__ import annotations

import argparse
import os
import time
from collections.abc import Iterator
from concurrent.futures import Executor
from contextlib import ExitStack, contextmanager
from functools import partial
from importlib.util import find_spec

import numpy as np
from rich.console import Console
from rich.table import Table

from tracker.evaluation.cluster import dask_cluster
from tracker.evaluation.monte_carlo import monte_carlo
from tracker.evaluation.workers import Processes, run_in_order

SCENARIOS = ("people", "known-people", "outliers")
EMPTY_TASKS = 2000


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
    least = 4 if scenario == "people" else 500
    monte_carlo(scenario, 2)  # compiles
    begin_s = time.perf_counter()
    monte_carlo(scenario, least)
    return least * max(round(seconds / (time.perf_counter() - begin_s)), 1)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--seconds", type=float, default=20.0, help="of one process's work")
    parser.add_argument("--rounds", type=int, default=3)
    words = parser.parse_args()
    with ExitStack() as stack:
        crews = {f"{n} processes": stack.enter_context(Processes(n)) for n in (1, 2)}
        if find_spec("distributed") is not None:
            crews |= {f"{n} Dask workers": stack.enter_context(dask(n)) for n in (1, 2)}
        table = Table(title="trials a second", title_justify="left")
        for column in ("scenario", "trials", *crews):
            table.add_column(column, justify="right")
        for scenario in SCENARIOS:
            trials = enough_trials(scenario, words.seconds)
            rates: dict[str, float] = dict.fromkeys(crews, 0.0)
            expected = None
            for _ in range(words.rounds):
                for name, crew in crews.items():
                    monte_carlo(scenario, 4, seed=9, executor=crew)  # starts and compiles
                    begin_s = time.perf_counter()
                    study = monte_carlo(scenario, trials, executor=crew)
                    rates[name] = max(rates[name], trials / (time.perf_counter() - begin_s))
                    expected = expected or study.rows
                    for key, values in study.rows.items():
                        assert np.array_equal(values, expected[key], equal_nan=True), (name, key)
            table.add_row(scenario, f"{trials:,}", *(f"{rate:,.1f}" for rate in rates.values()))
        Console().print(table)
        for name, crew in crews.items():
            begin_s = time.perf_counter()
            list(run_in_order((partial(int, i) for i in range(EMPTY_TASKS)), crew))
            cost_us = (time.perf_counter() - begin_s) / EMPTY_TASKS * 1e6
            print(f"{name}: a unit of nothing takes {cost_us:.0f} us")
    print(f"{os.cpu_count()} cores, load {os.getloadavg()[0]:.1f}")


if __name__ == "__main__":
    main()
