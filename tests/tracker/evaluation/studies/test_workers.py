"""The same table whoever runs the units, and whoever of them dies: in real processes."""

import dataclasses
import multiprocessing
import os
import signal
import subprocess
import sys
import time
from concurrent.futures import BrokenExecutor, Executor, Future, ThreadPoolExecutor
from functools import partial
from pathlib import Path

import numpy as np
import pytest

from tracker.errors import ConfigError, WorkerError
from tracker.evaluation.studies.cluster import dask_cluster
from tracker.evaluation.studies.monte_carlo import monte_carlo
from tracker.evaluation.studies.workers import Processes, run_in_order
from tracker.evaluation.trials.scenario import SCENARIOS

SHORT = dataclasses.replace(SCENARIOS["people"], duration_s=1.0)
TRIALS = 400  # of 8 units


class Mortal(Executor):
    """Breaks at the calls it is told, as a pool does: whatever is not done breaks with them."""

    def __init__(self, *deaths):
        self.deaths, self.calls, self.waiting = list(deaths), 0, []

    def submit(self, call, *words):
        self.calls += 1
        future = Future()
        if self.calls in self.deaths:
            future.set_exception(BrokenExecutor("somebody died"))
        else:
            future.set_result(call(*words))
        return future


def test_results_come_in_the_order_of_the_calls():
    def wait(seconds):
        time.sleep(seconds)
        return seconds

    calls = [partial(wait, seconds) for seconds in (0.05, 0.0, 0.02)]
    with ThreadPoolExecutor(3) as executor:
        assert list(run_in_order(calls, executor)) == [0.05, 0.0, 0.02]


def test_a_million_calls_are_not_on_their_way_at_once():
    drawn = 0

    def calls():
        nonlocal drawn
        for number in range(1_000_000):
            drawn += 1
            yield partial(int, number)

    with ThreadPoolExecutor(1) as executor:
        results = run_in_order(calls(), executor)
        assert [next(results) for _ in range(3)] == [0, 1, 2]
        assert drawn < 10_000
        results.close()


def test_calls_that_broke_are_made_again_and_no_others():
    executor = Mortal(2, 3)
    calls = [partial(int, number) for number in range(5)]
    assert list(run_in_order(calls, executor)) == [0, 1, 2, 3, 4]
    assert executor.calls == 7


def test_a_call_that_always_kills_its_worker_is_given_up():
    with pytest.raises(WorkerError, match="Workers died 4 times"):
        list(run_in_order([partial(int, 1)], Mortal(*range(1, 100))))


@pytest.mark.parametrize("address", ["dask://nowhere", "banana://x:1"])
def test_an_address_that_is_none_is_refused(address):
    pytest.importorskip("distributed", reason="distributed is not installed")
    with pytest.raises(ConfigError, match="is not an address of a Dask scheduler"):
        dask_cluster(address).__enter__()


@pytest.fixture(scope="module")
def alone():
    """The study, run by nobody else."""
    return monte_carlo(SHORT, TRIALS, seed=2)


def assert_same_rows(study, expected):
    for name, values in expected.rows.items():
        assert np.array_equal(study.rows[name], values, equal_nan=True), name


def once_at(share, act):
    """Progress that does something once, on the way."""
    todo = [act]

    def progress(done):
        if done >= share and todo:
            todo.pop()()

    return progress


def runs(pid):
    return Path(f"/proc/{pid}/exe").exists()


@pytest.mark.slow
def test_processes_are_left_in_time_though_an_idle_one_was_killed():
    """It may die with the lock of the pool's queue, for which the others wait."""
    for number in range(4):
        with Processes(2) as executor:
            list(executor.map(time.sleep, [0.1, 0.1]))
            workers = multiprocessing.active_children()
            os.kill(workers[number % 2].pid, signal.SIGKILL)
        assert not any(runs(worker.pid) for worker in workers)


@pytest.mark.slow
def test_a_killed_process_changes_no_row(alone):
    def kill_one():
        os.kill(multiprocessing.active_children()[0].pid, signal.SIGKILL)

    with Processes(2) as executor:
        study = monte_carlo(
            SHORT, TRIALS, seed=2, executor=executor, progress=once_at(0.3, kill_one)
        )
    assert_same_rows(study, alone)


#: Tells the numbers of its processes whenever a unit has been written.
STUDY = f"""
import dataclasses
import multiprocessing
from tracker.evaluation.studies.monte_carlo import monte_carlo
from tracker.evaluation.trials.scenario import SCENARIOS
from tracker.evaluation.studies.workers import Processes

def tell(share):
    if share > 0:
        print(*(child.pid for child in multiprocessing.active_children()), flush=True)

if __name__ == "__main__":
    short = dataclasses.replace(SCENARIOS["people"], duration_s={SHORT.duration_s})
    with Processes(2) as pool:
        monte_carlo(short, {2 * TRIALS}, 2, executor=pool, progress=tell, folder="study")
"""


@pytest.mark.slow
def test_a_study_killed_with_kill_9_leaves_nobody_behind_and_goes_on(tmp_path):
    (tmp_path / "study.py").write_text(STUDY)
    environment = {**os.environ, "PYTHONPATH": str(Path(__file__).parents[4])}
    study = subprocess.Popen(
        [sys.executable, "study.py"], cwd=tmp_path, env=environment, stdout=subprocess.PIPE
    )
    with study.stdout:
        workers = study.stdout.readline().decode().split()
        study.kill()
    study.wait()
    rows = tmp_path / "study" / "trials.csv"
    written = rows.read_bytes()
    monte_carlo(SHORT, 2 * TRIALS, seed=2, folder=tmp_path / "study")
    monte_carlo(SHORT, 2 * TRIALS, seed=2, folder=tmp_path / "whole")
    assert rows.read_bytes() == (tmp_path / "whole" / "trials.csv").read_bytes()
    assert rows.read_bytes().startswith(written)
    assert len(workers) == 2
    assert not any(runs(pid) for pid in workers)


@pytest.fixture(scope="module")
def cluster():
    """Two Dask workers of one thread each."""
    distributed = pytest.importorskip("distributed", reason="distributed is not installed")
    with distributed.LocalCluster(
        n_workers=2, threads_per_worker=1, dashboard_address=":0"
    ) as cluster:
        yield cluster


@pytest.mark.slow
def test_two_dask_workers_give_the_same_rows_also_when_one_is_killed(alone, cluster):
    address = cluster.scheduler_address.replace("tcp://", "dask://")
    with dask_cluster(address) as executor:
        assert_same_rows(monte_carlo(SHORT, TRIALS, seed=2, executor=executor), alone)

        def kill_one():
            os.kill(cluster.workers[0].pid, signal.SIGKILL)

        study = monte_carlo(
            SHORT, TRIALS, seed=2, executor=executor, progress=once_at(0.3, kill_one)
        )
    assert_same_rows(study, alone)


@pytest.mark.slow
def test_a_scheduler_that_is_not_there_is_named():
    pytest.importorskip("distributed", reason="distributed is not installed")
    with pytest.raises(WorkerError, match="no Dask scheduler answers"):
        dask_cluster("dask://127.0.0.1:1", patience_s=0.5).__enter__()
