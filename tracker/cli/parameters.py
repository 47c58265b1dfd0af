"""`raised-hand parameters`: all parameters, their meaning and allowed values."""

from __future__ import annotations

import json
from textwrap import fill
from typing import Annotated, Any

import typer

from tracker.cli.options import JsonOption, console, note, print_json
from tracker.config import Config, allowed_values, parameter_extra
from tracker.config_file import GROUP_TITLES, grouped_parameters

#: Wider lines are hard to read.
_COLUMNS_MAX = 99


def _begins_with(incomplete: str) -> list[str]:
    """What the shell offers to complete."""
    return [name for name in Config.model_fields if name.startswith(incomplete)]


def parameters_command(
    names: Annotated[
        list[str] | None,
        typer.Argument(
            metavar="[NAME]...",
            help="Show only these, basic or expert.",
            autocompletion=_begins_with,
        ),
    ] = None,
    every: Annotated[
        bool, typer.Option("--all", "-a", help="Show the expert parameters as well.")
    ] = False,
    as_json: JsonOption = False,
) -> None:
    """Show the parameters with default, range and meaning: the basic ones, or all.

    They are set with -p NAME:=VALUE, or in a file for --config; config/hand_detector.yaml has all.
    """
    unknown = [name for name in names or [] if name not in Config.model_fields]
    Config.from_mapping(dict.fromkeys(unknown), "raised-hand parameters")  # names those meant
    shown = [
        (level, group, name)
        for level, group, members in grouped_parameters()
        for name in members
        if (name in names if names else every or level == "basic")
    ]
    if as_json:
        print_json([_as_document(name) for _, _, name in shown])
        return
    title = ""
    for level, group, name in shown:
        if title != (title := f"{GROUP_TITLES[group]} ({level})"):
            console.print(f"\n[bold]{title}[/bold]", highlight=False)
        console.print(_as_text(name), highlight=False, markup=False, soft_wrap=True)
    hidden = len(Config.model_fields) - len(shown)
    if hidden and not names:
        note(f"{hidden} expert parameters are not shown; add --all.")


def _as_text(name: str) -> str:
    info = Config.model_fields[name]
    live = "; may change while the node runs" if parameter_extra(name)["live"] else ""
    meaning = fill(
        f"{info.description} ({allowed_values(name)}{live})",
        min(console.width, _COLUMNS_MAX),
        initial_indent="    ",
        subsequent_indent="    ",
        break_on_hyphens=False,
    )
    return f"  {name}: {json.dumps(info.default)}\n{meaning}"


def _as_document(name: str) -> dict[str, Any]:
    info, extra = Config.model_fields[name], parameter_extra(name)
    return {
        "name": name,
        "level": extra["level"],
        "group": extra["group"],
        "default": info.default,
        "allowed": allowed_values(name),
        "unit": extra["unit"],
        "live": extra["live"],
        "description": info.description,
    }
