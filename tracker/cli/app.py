"""The program `raised-hand`: where it starts."""

from typing import NoReturn

from tracker.terminal.program import run_program


def main() -> NoReturn:
    """Run the command line; an expected failure prints one line and sets the exit status."""
    run_program("raised-hand", _body)


def _body() -> None:
    from tracker.cli.commands import app  # takes a second, in which somebody may press Ctrl-C

    app()
