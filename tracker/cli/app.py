"""The program `raised-hand`, from its first moment."""

from typing import NoReturn

from tracker.terminal.program import run_program


def main() -> NoReturn:
    """Run the command line; every foreseen failure is one line and a status."""
    run_program("raised-hand", _body)


def _body() -> None:
    from tracker.cli.commands import app  # takes a second, in which somebody may press Ctrl-C

    app()
