"""How far is it? Progress bars on standard error, quiet where nobody watches."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager

from rich.console import Console
from rich.progress import BarColumn, Progress, TaskProgressColumn, TextColumn, TimeRemainingColumn


@contextmanager
def bar(console: Console, what: str) -> Iterator[Callable[[float, int], None]]:
    """Show the share that is done, and how many images were processed.

    Args:
        console: Where to.
        what: The work, in one or two words.

    Yields:
        A function of the share (0 to 1) and the number of images.
    """
    columns = (
        TextColumn("{task.description:<22}"),
        BarColumn(),
        TaskProgressColumn(),
        TextColumn("{task.fields[images]}"),
        TimeRemainingColumn(),
    )
    if not console.is_terminal:
        console.print(f"{what} ...", highlight=False)
        yield lambda share, images: None
        return
    with Progress(*columns, console=console) as progress:
        task = progress.add_task(what, total=1.0, images="")

        def report(share: float, images: int) -> None:
            text = f"{images} images" if images else ""
            progress.update(task, completed=share, images=text)

        yield report


@contextmanager
def fetch_progress(console: Console) -> Iterator[Callable[[str, int, int], None]]:
    """Show the stages of a fetch, each with a bar of its own.

    Yields:
        A function of the stage's name, what is done and the total (0 where unknown).
    """
    columns = (TextColumn("{task.description:<22}"), BarColumn(), TaskProgressColumn())
    with Progress(*columns, console=console, disable=not console.is_terminal) as progress:
        tasks: dict[str, int] = {}

        def report(stage: str, done: int, total: int) -> None:
            if stage not in tasks:
                tasks[stage] = progress.add_task(stage, total=None)
            progress.update(tasks[stage], completed=done, total=total or None)  # type: ignore[arg-type]

        yield report


def fetch_models_if_needed(console: Console) -> None:
    """Fetch the hand models where they are not there yet, and say so.

    Raises:
        ModelFileError: They cannot be fetched.
    """
    from tracker.perception.models import ModelStore, ensure_models

    store = ModelStore()
    if store.has_all():
        return
    console.print(
        f"The hand models are not here yet; fetching them once, to {store.directory}",
        highlight=False,
        soft_wrap=True,
    )
    with fetch_progress(console) as progress:
        ensure_models(store, progress)
