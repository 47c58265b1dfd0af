"""What the commands share: common options, how messages and results are printed."""

from __future__ import annotations

import json
import shlex
import sys
from pathlib import Path
from typing import Annotated, Any

import typer
from rich.console import Console

from tracker.config import Config
from tracker.errors import ConfigError
from tracker.parameters.ros_file import read_assignment
from tracker.wording import one_line

console = Console()
errors = Console(stderr=True)

ConfigOption = Annotated[
    Path | None,
    typer.Option("--config", "-c", help="ROS parameter file, such as config/hand_detector.yaml."),
]
ParameterOption = Annotated[
    list[str] | None,
    typer.Option(
        "--param", "-p", help="Set one parameter, such as -p ranging:=spec. May be repeated."
    ),
]
ReportOption = Annotated[
    Path | None,
    typer.Option(
        help="Write a page with plots and tables: one .html file that needs no other file."
    ),
]
JsonOption = Annotated[bool, typer.Option("--json", help="Print the summary as JSON.")]
JobsOption = Annotated[
    int, typer.Option("--jobs", "-j", help="Number of processes; 0 means one per core.", min=0)
]
ExecutorOption = Annotated[
    str,
    typer.Option(
        "--executor",
        help="What runs the trials: processes (on this machine), or a Dask cluster, given as the "
        "address of its scheduler, dask://host:port.",
    ),
]


def parameters_from(
    config: Path | None, assignments: list[str] | None, default: Config | None = None
) -> Config:
    """The configuration that the command line asks for.

    Args:
        config: A parameter file.
        assignments: NAME:=VALUE, on top of the file.
        default: What holds without a file; every parameter's own default where None.

    Raises:
        ConfigError: The file or an assignment is off.
    """
    chosen = default or Config()
    if config is not None:
        chosen = Config.from_yaml(config, remark=note)
    changes = dict(read_assignment(text) for text in assignments or [])
    return chosen.replace(**changes) if changes else chosen


def parameter_files(config: Path | None, parameters: Config) -> list[Path | None]:
    """The files that parameters come from: their own, and a pose model that they name."""
    return [config, Path(parameters.pose_model) if parameters.pose_model else None]


def command_line() -> str:
    """The command line as the user typed it, quoted for the shell."""
    return shlex.join(["raised-hand", *sys.argv[1:]])


def check_is_no_folder(option: str, path: Path | None) -> None:
    """Refuse a folder where a file is to be written, before the work and not after it.

    Raises:
        ConfigError: It is a folder.
    """
    if path is not None and path.is_dir():
        raise ConfigError(f"{option} is {path}, a folder; expected the name of a file.")


def check_is_no_file(option: str, path: Path) -> None:
    """Refuse a file where a folder is to be written, before the work and not after it.

    Raises:
        ConfigError: It is a file.
    """
    if path.exists() and not path.is_dir():
        raise ConfigError(f"{option} is {path}, a file; expected the name of a folder.")


def print_json(document: Any) -> None:
    """Results for machines, on standard output."""
    sys.stdout.write(json.dumps(document, indent=2) + "\n")


def print_files(files: tuple[Path, ...]) -> None:
    """One line per file that was written."""
    for path in files:
        console.print(f"wrote {path}", highlight=False, soft_wrap=True)


def complain(text: object) -> None:
    """One line on standard error."""
    words = f"raised-hand: {one_line(str(text))}"
    errors.print(words, highlight=False, markup=False, soft_wrap=True)


def note(text: str) -> None:
    """One line on standard error that is not a failure."""
    errors.print(f"note: {one_line(text)}", highlight=False, markup=False, soft_wrap=True)
