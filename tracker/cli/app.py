"""The command `raised-hand`: everything a person types.

Results go to standard output, progress and complaints to standard error. Exit status: 0 done,
1 something failed or the input was broken, 2 the words on the command line were wrong.
"""

from __future__ import annotations

import os
import sys
from typing import NoReturn

import typer

from tracker.cli.demo import demo_command
from tracker.cli.evaluate import evaluate_command
from tracker.cli.live import echo_command, play_command
from tracker.cli.models import models_app
from tracker.cli.monte_carlo import monte_carlo_command
from tracker.cli.options import complain, errors
from tracker.cli.replay import replay_command
from tracker.cli.simulate import simulate_command
from tracker.cli.tune import tune_command
from tracker.errors import ConfigError, SceneError, TrackerError

app = typer.Typer(
    name="raised-hand",
    help="Who raises a hand, where each of them stands in the map, who is served next.",
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
    rich_markup_mode="rich",
    context_settings={"help_option_names": ["-h", "--help"]},
)
app.command("demo")(demo_command)
app.command("replay")(replay_command)
app.command("simulate")(simulate_command)
app.command("play")(play_command)
app.command("echo")(echo_command)
app.command("evaluate")(evaluate_command)
app.command("monte-carlo")(monte_carlo_command)
app.command("tune")(tune_command)
app.add_typer(models_app, name="models", no_args_is_help=True)


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


def _fail(error: TrackerError, status: int) -> NoReturn:
    complain(error)
    sys.exit(status)
