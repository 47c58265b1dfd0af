"""Progress bars on standard error; few lines if it is not a terminal."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from math import isnan
from time import monotonic

from rich.console import Console
from rich.progress import (
    BarColumn,
    MofNCompleteColumn,
    Progress,
    ProgressColumn,
    Task,
    TaskProgressColumn,
    TextColumn,
    TimeRemainingColumn,
)
from rich.text import Text

from tracker.wording import counted

#: Without a terminal, a line is printed at this interval, in seconds.
_SILENCE_S = 10.0


def rate(per_s: float) -> str:
    """`7,290/s`, `42/s`, `0.031/s`."""
    return f"{per_s:,.0f}/s" if per_s >= 100.0 else f"{per_s:.2g}/s"


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
        say = _now_and_then(console)
        yield lambda share, images: say(f"{what} ... {share:.0%}")
        return
    with Progress(*columns, console=console) as progress:
        task = progress.add_task(what, total=1.0, images="")

        def report(share: float, images: int) -> None:
            text = counted(images, "image") if images else ""
            progress.update(task, completed=share, images=text)

        yield report


@contextmanager
def counting_bar(console: Console, what: str, total: int) -> Iterator[Callable[[int], None]]:
    """Show how many are done, how many per second, and the time left.

    Args:
        console: Where to.
        what: The thing counted, as `trial`.
        total: How many there will be.

    Yields:
        A function of how many are done; the first call says how many were done before.
    """
    if not console.is_terminal:
        console.print(f"Running {counted(total, what)} ...", highlight=False)
        say = _now_and_then(console)
        yield lambda done: say(f"{done} of {counted(total, what)} ...")
        return
    columns = (BarColumn(), MofNCompleteColumn(), _RateColumn(f"{what}s"), TimeRemainingColumn())
    with Progress(*columns, console=console, speed_estimate_period=60.0) as progress:
        task = None

        def report(done: int) -> None:
            nonlocal task
            if task is None:
                task = progress.add_task(what, total=total, completed=done)
            progress.update(task, completed=done)

        yield report


@contextmanager
def trials_bar(
    console: Console, trials: int, unseen: int | None
) -> Iterator[tuple[Callable[[int, float], None], Callable[[int], None]]]:
    """Show how many trials of a search are done, and the best so far; then the final test.

    Args:
        console: Where to.
        trials: In all.
        unseen: Scenes of the final test; None if they are not counted.

    Yields:
        A function of the number of trials and the figure (NaN before there is one), and one of the
        number of scenes that were judged.
    """
    columns = (
        TextColumn("{task.description:<22}"),
        BarColumn(),
        TextColumn("{task.completed}/{task.total}"),
        TextColumn("{task.fields[best]}"),
        TimeRemainingColumn(),
    )
    if not console.is_terminal:
        console.print(f"Trying {counted(trials, 'configuration')} ...", highlight=False)

        def announce(scenes: int) -> None:
            if scenes == 0:
                console.print("Testing the best on data that no trial used ...", highlight=False)

        say = _now_and_then(console)
        yield lambda done, best: say(f"{done} of {trials} ... best {best:.4g}"), announce
        return
    with Progress(*columns, console=console) as progress:
        task = progress.add_task("Trying", total=trials, best="")
        verdict = progress.add_task("Final test", total=unseen, best="", one_line=False)

        def report(done: int, best: float) -> None:
            text = "" if isnan(best) else f"best {best:.4g}"
            progress.update(task, completed=done, best=text)

        def judge(scenes: int) -> None:
            progress.update(verdict, completed=scenes, one_line=True)

        yield report, judge


def _now_and_then(console: Console) -> Callable[[str], None]:
    """Prints a line where nothing was printed for a while: in a file, bars would be many lines."""
    last_s = monotonic()

    def say(text: str) -> None:
        nonlocal last_s
        if monotonic() - last_s >= _SILENCE_S:
            last_s = monotonic()
            console.print(text, highlight=False)

    return say


class _RateColumn(ProgressColumn):
    def __init__(self, what: str) -> None:
        super().__init__()
        self._what = what

    def render(self, task: Task) -> Text:
        return Text(f"{self._what}, {rate(task.speed)}" if task.speed else self._what)


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
    from tracker.perception.models import ModelState, ModelStore, ensure_models

    store = ModelStore()
    if store.has_all():
        return
    found = {row.state for row in store.status()} - {ModelState.PRESENT}
    states = " or ".join(sorted(state.value for state in found))
    console.print(
        f"The hand models are {states}; they are fetched once, to {store.directory}",
        highlight=False,
        soft_wrap=True,
    )
    with fetch_progress(console) as progress:
        ensure_models(store, progress)


def compile_tracker_first(console: Console) -> None:
    """Compile the tracker before the work, and say so where that takes a while."""
    from tracker.tracking.machine_frame import compile_tracker

    with console.status("Loading the tracker"):
        compile_tracker(telling(console))


def telling(console: Console) -> Callable[[str], None]:
    """Sentences on a console, as they are."""

    def say(text: str) -> None:
        console.print(text, highlight=False, markup=False, soft_wrap=True)

    return say
