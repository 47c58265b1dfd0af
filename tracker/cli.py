"""The command `raised-hand`: everything a person types.

Results go to standard output, progress and complaints to standard error. Exit status: 0 done,
1 something failed or the input was broken, 2 the words on the command line were wrong.
"""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import Annotated, Any, NoReturn

import typer
from rich.console import Console

from tracker.cli_progress import bar, fetch_models_if_needed
from tracker.config import Config
from tracker.errors import ConfigError, RecordingError, SceneError, TrackerError

app = typer.Typer(
    name="raised-hand",
    help="Who raises a hand, where each of them stands in the map, who is served next.",
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
    rich_markup_mode="rich",
    context_settings={"help_option_names": ["-h", "--help"]},
)
models_app = typer.Typer(help="Fetch the hand models, or show which are there.")
app.add_typer(models_app, name="models", no_args_is_help=True)

#: The demo's pictures go as JPEG: raw they would fill a gigabyte of the reader's disk.
_DEMO_JPEG_QUALITY = 92

_console = Console()
_errors = Console(stderr=True)

ConfigOption = Annotated[
    Path | None,
    typer.Option("--config", "-c", help="ROS parameter file, as config/hand_detector.yaml."),
]
ParameterOption = Annotated[
    list[str] | None,
    typer.Option("--param", "-p", help="One parameter, as in -p ranging:=spec; may be repeated."),
]
JsonOption = Annotated[bool, typer.Option("--json", help="Print the summary as JSON.")]


def main() -> NoReturn:
    """Run the command line; every foreseen failure is one line and a status."""
    try:
        app()
    except (ConfigError, SceneError) as error:
        _fail(error, 2)
    except TrackerError as error:
        _fail(error, 1)
    except KeyboardInterrupt:
        _errors.print("\nraised-hand: stopped; what was written until now can be read.")
        sys.exit(130)
    sys.exit(0)


@app.command()
def demo(
    scene: Annotated[
        str, typer.Argument(help="Scene to play: a name of config/scenes or a YAML file.")
    ] = "restaurant",
    out: Annotated[Path, typer.Option("--out", "-o", help="Folder for the files.")] = Path("demo"),
    seed: Annotated[int, typer.Option(help="Of the simulated noise.", min=0)] = 1,
    config: ConfigOption = None,
    param: ParameterOption = None,
    as_json: JsonOption = False,
) -> None:
    """Simulate a restaurant, replay it through the tracker, compare with the truth.

    The simulation writes an ordinary recording of camera, laser and transforms; the replay sees
    nothing else. Ends with status 1 if a raised hand was missed or invented.
    """
    from tracker.replay import replay
    from tracker.report.episode_table import episode_table

    parameters = _parameters(config, param)
    fetch_models_if_needed(_errors)
    recording = out / "recording.mcap"
    _simulate(scene, recording, seed, _DEMO_JPEG_QUALITY, force=True)
    with bar(_errors, "Replaying") as progress:
        result = replay(recording, out, parameters, progress=progress)
    episodes = result.episodes
    if episodes is None:
        raise RecordingError(f"{recording}: holds no truth to compare with.")
    if as_json:
        _print_json(result.summary)
    else:
        _console.print(episode_table(episodes))
        _print_files((recording, *result.files))
    if episodes.missed or episodes.invented:
        sys.exit(1)


@app.command("replay")
def replay_command(
    source: Annotated[
        Path,
        typer.Argument(
            help="rosbag2 folder, .mcap, .db3, ROS 1 .bag, a video, or a folder of photos "
            "(without LiDAR, bearings only)."
        ),
    ],
    out: Annotated[Path, typer.Option("--out", "-o", help="Folder for the files.")] = Path("out"),
    config: ConfigOption = None,
    param: ParameterOption = None,
    image_topic: Annotated[str, typer.Option(help="Camera images.")] = "/image_raw",
    scan_topic: Annotated[str, typer.Option(help="LiDAR scans.")] = "/scan",
    camera_info_topic: Annotated[str, typer.Option(help="Intrinsics.")] = "/camera_info",
    stamps: Annotated[
        str,
        typer.Option(help="Which time counts: `header` (the sensor's) or `log` (the recorder's)."),
    ] = "header",
    as_json: JsonOption = False,
) -> None:
    """Run a recording through the tracker, as the robot would have seen it.

    Writes output.mcap (for Foxglove, RViz, ros2 bag play), tracks.csv, summary.json, overview.png
    and debug.mp4. A recording that breaks off is replayed as far as it goes, and the status is 1.
    """
    from tracker.recording import Topics
    from tracker.replay import replay
    from tracker.report.summary import summary_table

    if stamps not in ("header", "log"):
        raise ConfigError(f"--stamps is {stamps!r}; allowed is header or log.")
    parameters = _parameters(config, param)
    if not source.exists():
        raise ConfigError(f"{source}: there is no such file or folder.")
    fetch_models_if_needed(_errors)
    topics = Topics(image=image_topic, scan=scan_topic, camera_info=camera_info_topic)
    with bar(_errors, "Replaying") as progress:
        result = replay(source, out, parameters, topics=topics, stamps=stamps, progress=progress)
    if as_json:
        _print_json(result.summary)
    else:
        _console.print(summary_table(result.history))
        _print_files(result.files)
    for remark in result.summary["remarks"]:  # type: ignore[attr-defined]
        _errors.print(f"note: {remark}", highlight=False, markup=False, soft_wrap=True)
    for problem in result.problems:
        _complain(problem)
    if result.problems:
        sys.exit(1)


@app.command()
def simulate(
    scene: Annotated[str, typer.Argument(help="A name of config/scenes, or a YAML file.")],
    out: Annotated[Path, typer.Option("--out", "-o", help=".mcap file, or rosbag2 folder.")],
    seed: Annotated[int, typer.Option(help="Of all noise; same seed, same bytes.", min=0)] = 1,
    jpeg: Annotated[
        int | None,
        typer.Option(help="Images as JPEG of this quality; a twentieth the size.", min=1, max=100),
    ] = None,
    force: Annotated[bool, typer.Option("--force", help="Replace what is there.")] = False,
) -> None:
    """Play a scene of people, tables and a robot into a recording.

    Rendered camera images, ray-cast scans, transforms, CameraInfo, and the truth on a topic of its
    own. Scenes are YAML; those in config/scenes are examples.
    """
    _simulate(scene, out, seed, jpeg, force=force)
    _print_files((out,))


@models_app.command("fetch")
def models_fetch(
    source: Annotated[
        Path | None,
        typer.Option("--from", help="The mediapipe wheel, fetched elsewhere; else pip is asked."),
    ] = None,
    to: Annotated[
        Path | None,
        typer.Option(
            "--to", help="Folder for the ONNX files; else RAISED_HAND_MODELS or the cache."
        ),
    ] = None,
) -> None:
    """Take the hand and pose models from their PyPI wheel and convert them to ONNX.

    For a robot without a network: fetch with --to on another machine, copy the folder, and set the
    environment variable RAISED_HAND_MODELS to it.
    """
    from tracker.cli_progress import fetch_progress
    from tracker.perception.models import ModelStore, fetch_models

    store = ModelStore(to)
    with fetch_progress(_errors) as progress:
        fetch_models(store, source, progress)
    _console.print(f"models are in {store.directory}", highlight=False, soft_wrap=True)


@models_app.command("list")
def models_list(as_json: JsonOption = False) -> None:
    """Show which models are there, and where."""
    from rich.table import Table

    from tracker.perception.models import ModelStore

    rows = ModelStore().status()
    if as_json:
        _print_json(
            [
                {"name": row.name, "state": row.state.value, "path": str(row.path)}
                | {"size_bytes": row.size_bytes, "source_sha256": row.source_sha256}
                for row in rows
            ]
        )
        return
    table = Table("model", "state", "size", "file")
    for row in rows:
        size = f"{row.size_bytes / 1e6:.1f} MB" if row.size_bytes else ""
        table.add_row(row.name, row.state.value, size, str(row.path))
    _console.print(table)


def _parameters(config: Path | None, assignments: list[str] | None) -> Config:
    import yaml

    parameters = Config.from_yaml(config) if config is not None else Config()
    changes: dict[str, Any] = {}
    for assignment in assignments or []:
        name, separator, text = assignment.partition(":=")
        if not separator:
            raise ConfigError(f"--param is {assignment!r}; needed is NAME:=VALUE.")
        changes[name] = yaml.safe_load(text)
    return parameters.replace(**changes) if changes else parameters


def _simulate(scene: str, out: Path, seed: int, jpeg: int | None, *, force: bool) -> None:
    from tracker.simulation import load_scene, write_simulation

    loaded = load_scene(scene)
    with bar(_errors, f"Simulating {Path(scene).stem}") as progress:
        write_simulation(
            loaded,
            out,
            seed,
            progress=lambda share: progress(share, 0),
            jpeg_quality=jpeg,
            overwrite=force,
        )


def _print_json(document: Any) -> None:
    sys.stdout.write(json.dumps(document, indent=2) + "\n")


def _print_files(files: tuple[Path, ...]) -> None:
    for path in files:
        _console.print(f"wrote {path}", highlight=False, soft_wrap=True)


def _complain(text: object) -> None:
    _errors.print(f"raised-hand: {text}", highlight=False, markup=False, soft_wrap=True)


def _fail(error: TrackerError, status: int) -> NoReturn:
    _complain(error)
    sys.exit(status)


if __name__ == "__main__":
    main()
