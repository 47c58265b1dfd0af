"""`raised-hand simulate`: a scene of people, tables and a robot becomes a recording."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from tracker.cli.options import errors, print_files
from tracker.outputs import check_inputs_stay
from tracker.terminal.progress import bar


def simulate_command(
    scene: Annotated[str, typer.Argument(help="A name from config/scenes, or a YAML file.")],
    out: Annotated[
        Path, typer.Option("--out", "-o", help="Output: an .mcap file, or a rosbag2 folder.")
    ],
    seed: Annotated[
        int, typer.Option(help="Seed of all noise. The same seed gives the same file.", min=0)
    ] = 1,
    jpeg: Annotated[
        int | None,
        typer.Option(
            help="Write images as JPEG of this quality; the file is then about a "
            "twentieth of the size.",
            min=1,
            max=100,
        ),
    ] = None,
    depth: Annotated[
        bool, typer.Option("--depth", help="Add a depth camera, even if the scene has none.")
    ] = False,
    force: Annotated[bool, typer.Option("--force", help="Replace an existing file.")] = False,
) -> None:
    """Simulate a scene of people, tables and a robot, and write it as a recording.

    The recording has rendered camera images, ray-cast scans, transforms, CameraInfo, and the truth
    on a topic of its own. Scenes are YAML files; see config/scenes for examples.
    """
    simulate(scene, out, seed, jpeg, force=force, with_depth=depth)
    print_files((out,))


def simulate(
    scene: str, out: Path, seed: int, jpeg: int | None, *, force: bool, with_depth: bool = False
) -> None:
    """Write a scene as a recording, with a progress bar."""
    from tracker.recording import recording_files
    from tracker.simulation import load_scene, with_depth_camera, write_simulation

    if Path(scene).is_file():
        check_inputs_stay([Path(scene)], {out, *recording_files(out)})
    loaded = load_scene(scene)
    loaded = with_depth_camera(loaded) if with_depth else loaded
    with bar(errors, f"Simulating {Path(scene).stem}") as progress:
        write_simulation(
            loaded,
            out,
            seed,
            progress=lambda share: progress(share, 0),
            jpeg_quality=jpeg,
            overwrite=force,
        )
