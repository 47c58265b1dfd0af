"""What both command lines, `raised-hand` and `raised-hand-dds`, say about themselves."""

from __future__ import annotations

from collections.abc import Callable
from inspect import cleandoc
from typing import Annotated

import typer

from tracker.terminal.program import print_version

VersionOption = Annotated[
    bool,
    typer.Option(
        "--version", help="Print the version and exit.", is_eager=True, callback=print_version
    ),
]


def help_of(command: Callable[..., None]) -> str:
    """The docstring of a command with each paragraph on one line, for the terminal to wrap.

    Lines that are indented, as examples are, stay as they are.
    """
    paragraphs = cleandoc(command.__doc__ or "").split("\n\n")
    return "\n\n".join(
        text if text.startswith(" ") else " ".join(text.split("\n")) for text in paragraphs
    )
