"""`raised-hand demo`: simulate, replay, compare with the truth."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Annotated

import typer

from tracker.cli.options import (
    ConfigOption,
    JsonOption,
    ParameterOption,
    console,
    errors,
    parameter_files,
    parameters_from,
    print_files,
    print_json,
)
from tracker.cli.simulate import simulate
from tracker.errors import RecordingError
from tracker.outputs import check_inputs_stay
from tracker.terminal.progress import bar, compile_tracker_first, fetch_models_if_needed

#: The demo's pictures go as JPEG: raw they would fill a gigabyte of the reader's disk.
_DEMO_JPEG_QUALITY = 92


def demo_command(
    scene: Annotated[
        str, typer.Argument(help="Scene to simulate: a name from config/scenes, or a YAML file.")
    ] = "restaurant",
    out: Annotated[Path, typer.Option("--out", "-o", help="Folder for the output files.")] = Path(
        "demo"
    ),
    seed: Annotated[int, typer.Option(help="Seed of the simulated noise.", min=0)] = 1,
    depth: Annotated[
        bool, typer.Option("--depth", help="Simulate a depth camera instead of the LiDAR.")
    ] = False,
    config: ConfigOption = None,
    param: ParameterOption = None,
    as_json: JsonOption = False,
) -> None:
    """Simulate a restaurant, run the tracker on it, compare the result with the truth.

    The simulation writes an ordinary recording of camera, laser and transforms; the tracker gets
    nothing else. The exit status is 1 if a raised hand was missed or invented.
    """
    from tracker.replay import replay
    from tracker.replay.outputs import replay_files
    from tracker.report.replay.episode_table import episode_table

    parameters = parameters_from(config, param)
    if depth:
        parameters = parameters.replace(depth_source="depth")
    recording = out / "recording.mcap"
    given = Path(scene) if Path(scene).is_file() else None
    check_inputs_stay(
        [given, *parameter_files(config, parameters)], [recording, *replay_files(out)]
    )
    fetch_models_if_needed(errors)
    compile_tracker_first(errors)
    simulate(scene, recording, seed, _DEMO_JPEG_QUALITY, force=True, with_depth=depth)
    with bar(errors, "Replaying") as progress:
        result = replay(recording, out, parameters, progress=progress)
    episodes = result.episodes
    if episodes is None:
        raise RecordingError(f"{recording}: contains no truth to compare with.")
    if as_json:
        print_json(result.summary)
    else:
        console.print(episode_table(episodes))
        print_files((recording, *result.files))
    if episodes.missed or episodes.invented:
        sys.exit(1)
