"""Where does a long command run? In several processes, on a cluster, or in this process."""

from __future__ import annotations

import os
from collections.abc import Iterator
from concurrent.futures import Executor
from contextlib import contextmanager

from tracker.errors import ConfigError


@contextmanager
def open_executor(executor: str, jobs: int, units: int) -> Iterator[Executor | None]:
    """The executor that the option names.

    Args:
        executor: `processes`, or the address of a Dask scheduler.
        jobs: As for `processes`.
        units: As for `processes`.

    Raises:
        ConfigError: This is neither, or Dask is not installed.
        WorkerError: The cluster cannot be used.
    """
    if executor == "processes":
        with processes(jobs, units) as pool:
            yield pool
    elif "://" in executor:
        from tracker.evaluation.studies.cluster import dask_cluster

        with dask_cluster(executor) as cluster:
            yield cluster
    else:
        raise ConfigError(
            f"--executor is {executor!r}; expected processes, or an address such as "
            "dask://host:8786."
        )


@contextmanager
def processes(jobs: int, units: int) -> Iterator[Executor | None]:
    """That many processes; none where a single one would do.

    Args:
        jobs: How many; 0 is one per core.
        units: Pieces of work; more processes than that are of no use.
    """
    from tracker.evaluation.studies.workers import Processes

    jobs = workers(jobs, units)
    if jobs <= 1:
        yield None
        return
    with Processes(jobs) as executor:
        yield executor


def workers(jobs: int, units: int) -> int:
    """How many processes that are; 1 for this one."""
    return min(jobs or os.cpu_count() or 1, units)
