"""The command `raised-hand`: everything a person types.

Results go to standard output, progress and complaints to standard error.
"""

from __future__ import annotations

import os

import typer

from tracker.cli.demo import demo_command
from tracker.cli.evaluate import evaluate_command
from tracker.cli.live import live_command
from tracker.cli.models import models_app
from tracker.cli.monte_carlo import monte_carlo_command
from tracker.cli.parameters import parameters_command
from tracker.cli.play import echo_command, play_command
from tracker.cli.replay import replay_command
from tracker.cli.simulate import simulate_command
from tracker.cli.tune import tune_command
from tracker.terminal.command_help import VersionOption, help_of

# What OpenCV's readers have to say (8 is the video reader's "fatal"), our own line says better.
os.environ.setdefault("OPENCV_FFMPEG_LOGLEVEL", "8")
os.environ.setdefault("OPENCV_LOG_LEVEL", "SILENT")

app = typer.Typer(
    name="raised-hand",
    help="Find the people around a robot who raise a hand, where they stand, and who is served "
    "next.",
    no_args_is_help=True,
    pretty_exceptions_enable=False,
    rich_markup_mode="rich",
    context_settings={"help_option_names": ["-h", "--help"]},
)


@app.callback()
def _root(version: VersionOption = False) -> None:
    pass


for _name, _command in (
    ("demo", demo_command),
    ("live", live_command),
    ("replay", replay_command),
    ("simulate", simulate_command),
    ("play", play_command),
    ("echo", echo_command),
    ("parameters", parameters_command),
    ("evaluate", evaluate_command),
    ("monte-carlo", monte_carlo_command),
    ("tune", tune_command),
):
    app.command(_name, help=help_of(_command))(_command)
app.add_typer(models_app, name="models", no_args_is_help=True)
