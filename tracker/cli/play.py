"""`raised-hand play` and `echo`: meet ROS 2 nodes without ROS."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Annotated

import typer

from tracker.cli.options import complain, console, errors
from tracker.errors import ConfigError
from tracker.terminal.progress import bar
from tracker.wording import one_line


def play_command(
    source: Annotated[Path, typer.Argument(help="A rosbag2 folder, .mcap, .db3, .bag or video.")],
    rate: Annotated[float, typer.Option("--rate", "-r", help="2 plays twice as fast.")] = 1.0,
    loop: Annotated[bool, typer.Option("--loop", "-l", help="Start again at the end.")] = False,
    start_offset: Annotated[
        float, typer.Option(help="Start this many seconds after the beginning.", min=0.0)
    ] = 0.0,
    clock: Annotated[bool, typer.Option("--clock", help="Publish /clock as well.")] = False,
    best_effort: Annotated[
        bool,
        typer.Option(
            "--best-effort", help="Publish sensor data as best effort, as most drivers do."
        ),
    ] = False,
    topic: Annotated[
        list[str] | None, typer.Option(help="Publish only this topic. May be repeated.")
    ] = None,
    remap: Annotated[
        list[str] | None, typer.Option(help="Rename a topic, FROM:=TO. May be repeated.")
    ] = None,
    delay: Annotated[
        float, typer.Option(help="Wait this many seconds before the first message.", min=0.0)
    ] = 1.0,
) -> None:
    """Publish a recording in real time to ROS 2 nodes, without ROS (needs the extra `dds`).

    Nodes are met as ROS 2 does: by ROS_DOMAIN_ID and ROS_AUTOMATIC_DISCOVERY_RANGE.
    """
    from nodes.dds.play import play

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
    for sentence in played.skipped + played.doubts:
        complain(sentence)
    for name, count in played.counts.items():
        console.print(f"{one_line(name)}: {count}", highlight=False, soft_wrap=True)


def echo_command(
    topic: Annotated[str, typer.Argument(help="Name of the topic, such as /hand_raised.")],
    once: Annotated[bool, typer.Option("--once", help="Print one message.")] = False,
    count: Annotated[
        int | None, typer.Option(help="Stop after this many messages.", min=1)
    ] = None,
    timeout: Annotated[
        float | None, typer.Option(help="Stop after this many seconds without a message.")
    ] = None,
) -> None:
    """Print what ROS 2 nodes publish on a topic, without ROS (needs the extra `dds`)."""
    from nodes.dds.echo import echo

    try:
        echo(
            topic,
            count=1 if once else count,
            timeout_s=timeout,
            write=lambda text: print(text, flush=True),
        )
    except BrokenPipeError:  # `| head` has seen enough
        sys.stdout = None  # nothing is left to be flushed
