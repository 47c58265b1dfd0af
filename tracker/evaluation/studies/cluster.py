"""How does a Dask cluster run the units of a study?"""

from __future__ import annotations

from collections.abc import Iterator
from concurrent.futures import CancelledError, Executor
from contextlib import contextmanager
from importlib.metadata import version
from typing import TYPE_CHECKING

from tracker.errors import ConfigError, WorkerError

if TYPE_CHECKING:
    from distributed import Client

_PACKAGE = "raised-hand-tracker"


@contextmanager
def dask_cluster(address: str, *, patience_s: float = 30.0) -> Iterator[Executor]:
    """The workers of a Dask cluster, which sends the units of those that die to others.

    Args:
        address: Of the scheduler: `dask://host:port`, or as Dask writes it (`tcp://`, `tls://`).
        patience_s: How long the scheduler may take to answer, and the first worker to come.

    Yields:
        Its executor.

    Raises:
        ConfigError: The address is none, or Dask is not installed here.
        WorkerError: Nobody is there, other versions of this package are, or all of it goes away.
    """
    try:
        from distributed import Client, KilledWorker
        from distributed.comm import get_address_host_port
    except ModuleNotFoundError as error:
        raise ConfigError(
            f"{address} needs Dask: pip install '.[cluster]' in the project's folder, here and "
            "on its workers."
        ) from error
    place = address.replace("dask://", "tcp://", 1)
    try:  # before there is a client, whose remains may block the next one
        get_address_host_port(place, strict=True)
    except ValueError as error:
        raise ConfigError(f"{address} is not an address of a Dask scheduler ({error}).") from error
    try:
        client = Client(place, timeout=patience_s)
    except (OSError, TimeoutError) as error:
        raise WorkerError(
            f"{address}: no Dask scheduler answers; start `dask scheduler`."
        ) from error
    with client:
        _check_workers(client, address, patience_s)
        try:
            yield client.get_executor(pure=False)
        except KilledWorker as error:
            raise WorkerError(f"{address}: workers die again and again ({error}).") from error
        except CancelledError as error:
            raise WorkerError(
                f"{address}: the scheduler stopped; with --out, give the same command again to "
                "continue."
            ) from error


def _check_workers(client: Client, address: str, patience_s: float) -> None:
    """Rows of different versions must not get into one table."""
    try:
        client.wait_for_workers(1, timeout=patience_s)
        found = set(client.run(version, _PACKAGE).values())
    except TimeoutError as error:
        raise WorkerError(f"{address}: has no workers; start some with `dask worker`.") from error
    except ModuleNotFoundError as error:
        raise WorkerError(f"{address}: its workers have no {_PACKAGE}; install it.") from error
    if found != {version(_PACKAGE)}:
        raise WorkerError(
            f"{address}: its workers have {_PACKAGE} {', '.join(sorted(found))}; "
            f"expected {version(_PACKAGE)}, as here."
        )
