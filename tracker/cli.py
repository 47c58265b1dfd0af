"""The command `raised-hand`: everything a person types.

Results go to standard output, progress and complaints to standard error. Exit status: 0 done,
1 something failed or the input was broken, 2 the words on the command line were wrong.
"""

from __future__ import annotations

import os
import sys
from pathlib import Path
from typing import Annotated, NoReturn

import typer

from tracker.cli_evaluate import evaluate_command
from tracker.cli_models import models_app
from tracker.cli_monte_carlo import monte_carlo_command
from tracker.cli_options import (
    ConfigOption,
    JsonOption,
    ParameterOption,
    complain,
    console,
    errors,
    parameters_from,
    print_files,
    print_json,
)
from tracker.cli_progress import bar, fetch_models_if_needed
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
app.command("evaluate")(evaluate_command)
app.command("monte-carlo")(monte_carlo_command)
app.add_typer(models_app, name="models", no_args_is_help=True)

#: The demo's pictures go as JPEG: raw they would fill a gigabyte of the reader's disk.
_DEMO_JPEG_QUALITY = 92


def main() -> NoReturn:
    """Run the command line; every foreseen failure is one line and a status."""
    # What OpenCV's video reader has to say (8 is its "fatal"), our own line says better.
    os.environ.setdefault("OPENCV_FFMPEG_LOGLEVEL", "8")
    try:
        app()
    except (ConfigError, SceneError) as error:
        _fail(error, 2)
    except TrackerError as error:
        _fail(error, 1)
    except KeyboardInterrupt:
        errors.print("\nraised-hand: stopped; what was written until now can be read.")
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

    parameters = parameters_from(config, param)
    fetch_models_if_needed(errors)
    recording = out / "recording.mcap"
    _simulate(scene, recording, seed, _DEMO_JPEG_QUALITY, force=True)
    with bar(errors, "Replaying") as progress:
        result = replay(recording, out, parameters, progress=progress)
    episodes = result.episodes
    if episodes is None:
        raise RecordingError(f"{recording}: holds no truth to compare with.")
    if as_json:
        print_json(result.summary)
    else:
        console.print(episode_table(episodes))
        print_files((recording, *result.files))
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
    parameters = parameters_from(config, param)
    if not source.exists():
        raise ConfigError(f"{source}: there is no such file or folder.")
    fetch_models_if_needed(errors)
    topics = Topics(image=image_topic, scan=scan_topic, camera_info=camera_info_topic)
    with bar(errors, "Replaying") as progress:
        result = replay(source, out, parameters, topics=topics, stamps=stamps, progress=progress)
    if as_json:
        print_json(result.summary)
    else:
        table = summary_table(result.history)
        images = f"{result.history.frames_processed} images"
        console.print(table if table.row_count else f"Nobody raised a hand in {images}.")
        print_files(result.files)
    for remark in result.summary["remarks"]:  # type: ignore[attr-defined]
        errors.print(f"note: {remark}", highlight=False, markup=False, soft_wrap=True)
    for problem in result.problems:
        complain(problem)
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
    print_files((out,))


@app.command("play")
def play_command(
    source: Annotated[Path, typer.Argument(help="rosbag2 folder, .mcap, .db3, .bag, video.")],
    rate: Annotated[float, typer.Option("--rate", "-r", help="Times as fast.")] = 1.0,
    loop: Annotated[bool, typer.Option("--loop", "-l", help="Begin anew at the end.")] = False,
    start_offset: Annotated[float, typer.Option(help="Begin so many seconds in.", min=0.0)] = 0.0,
    clock: Annotated[bool, typer.Option("--clock", help="Publish /clock as well.")] = False,
    best_effort: Annotated[
        bool, typer.Option("--best-effort", help="Offer sensors' data as their drivers do.")
    ] = False,
    topic: Annotated[list[str] | None, typer.Option(help="Only this; may be repeated.")] = None,
    remap: Annotated[list[str] | None, typer.Option(help="FROM:=TO; may be repeated.")] = None,
    delay: Annotated[float, typer.Option(help="Seconds before the first message.", min=0.0)] = 1.0,
) -> None:
    """Publish a recording in real time to ROS 2 nodes, without ROS (needs the extra `dds`).

    Nodes are met as ROS 2 does: by ROS_DOMAIN_ID and ROS_AUTOMATIC_DISCOVERY_RANGE.
    """
    from nodes.play import play

    if not source.exists():
        raise ConfigError(f"{source}: there is no such file or folder.")
    with bar(errors, "Playing") as progress:
        played = play(
            source,
            rate=rate,
            loop=loop,
            start_offset_s=start_offset,
            clock=clock,
            best_effort=best_effort,
            topics=topic,
            remaps=remap or (),
            delay_s=delay,
            progress=progress,
        )
    for sentence in played.skipped:
        complain(sentence)
    for name, count in played.counts.items():
        console.print(f"{name}: {count}", highlight=False, soft_wrap=True)


@app.command("echo")
def echo_command(
    topic: Annotated[str, typer.Argument(help="As /hand_raised.")],
    once: Annotated[bool, typer.Option("--once", help="Print one message.")] = False,
    count: Annotated[int | None, typer.Option(help="Print so many messages.", min=1)] = None,
    timeout: Annotated[float | None, typer.Option(help="Seconds without a message.")] = None,
) -> None:
    """Print what ROS 2 nodes publish on a topic, without ROS (needs the extra `dds`)."""
    from nodes.echo import echo

    try:
        echo(
            topic,
            count=1 if once else count,
            timeout_s=timeout,
            write=lambda text: print(text, flush=True),
        )
    except BrokenPipeError:  # `| head` has seen enough
        sys.stdout = None  # nothing is left to be flushed


def _simulate(scene: str, out: Path, seed: int, jpeg: int | None, *, force: bool) -> None:
    from tracker.simulation import load_scene, write_simulation

    loaded = load_scene(scene)
    with bar(errors, f"Simulating {Path(scene).stem}") as progress:
        write_simulation(
            loaded,
            out,
            seed,
            progress=lambda share: progress(share, 0),
            jpeg_quality=jpeg,
            overwrite=force,
        )


def _fail(error: TrackerError, status: int) -> NoReturn:
    complain(error)
    sys.exit(status)


if __name__ == "__main__":
    main()
