"""`raised-hand models`: fetch the hand models, or show which are there."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from tracker.cli.options import JsonOption, console, errors, print_json
from tracker.outputs import check_inputs_stay
from tracker.terminal.command_help import help_of

#: What `model_complexity` has to be for a file to run.
_USED_WITH = {
    f"{name}_{size}": f"complexity {number}"
    for name in ("palm_detection", "hand_landmark")
    for number, size in enumerate(("lite", "full"))
}

models_app = typer.Typer(help="Fetch the hand models, or show which are there.")


def models_fetch(
    source: Annotated[
        Path | None,
        typer.Option(
            "--from",
            help="The mediapipe wheel, if it was downloaded before. Without it, pip downloads it.",
        ),
    ] = None,
    to: Annotated[
        Path | None,
        typer.Option(
            "--to",
            help="Folder for the ONNX files. Without it, RAISED_HAND_MODELS or the user's cache.",
        ),
    ] = None,
) -> None:
    """Take the hand and pose models from their PyPI wheel and convert them to ONNX.

    Then the tracker is compiled, so that the first start on this machine need not.

    For a robot without a network: fetch with --to on another machine, copy the folder, and set the
    environment variable RAISED_HAND_MODELS to it.
    """
    from tracker.perception.models import ModelStore, fetch_models
    from tracker.terminal.progress import compile_tracker_first, fetch_progress

    store = ModelStore(to)
    check_inputs_stay([source], [row.path for row in store.status()])
    with fetch_progress(errors) as progress:
        fetch_models(store, source, progress)
    console.print(f"models are in {store.directory}", highlight=False, soft_wrap=True)
    compile_tracker_first(errors)


def models_list(as_json: JsonOption = False) -> None:
    """Show which models are there, where, and which of them run on this processor.

    Of models that come in single precision and partly in 8 bits (int8), one runs: which one says
    the parameter `model_numbers`; its default is shown.
    """
    from rich.table import Table

    from tracker.config import Config
    from tracker.perception.models import ModelState, ModelStore, processor_kind, runs_here
    from tracker.perception.models.catalog import INT8_SUFFIX

    store = ModelStore()
    rows = store.status()
    running = runs_here(store, Config().model_numbers)
    if as_json:
        print_json(
            [
                {"name": row.name, "state": row.state.value, "path": str(row.path)}
                | {"size_bytes": row.size_bytes, "source_sha256": row.source_sha256}
                | {"runs": row.name in running}
                for row in rows
            ]
        )
        return
    table = Table("model", "state", "used here", "size")
    for row in rows:
        size = f"{row.size_bytes / 1e6:.1f} MB" if row.size_bytes else ""
        used = _USED_WITH.get(row.name.removesuffix(INT8_SUFFIX), "yes")
        table.add_row(row.name, row.state.value, used if row.name in running else "no", size)
    console.print(table)
    console.print(f"each as MODEL.onnx in {store.directory}", highlight=False, soft_wrap=True)
    console.print(f"this processor is {processor_kind()}", highlight=False)
    if any(row.state is not ModelState.PRESENT for row in rows):
        console.print("what is not present is not used; run 'raised-hand models fetch'")


models_app.command("fetch", help=help_of(models_fetch))(models_fetch)
models_app.command("list", help=help_of(models_list))(models_list)
