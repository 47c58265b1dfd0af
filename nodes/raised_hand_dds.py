"""The command `raised-hand-dds`, from its first moment, and where its extra is not installed."""

from typing import NoReturn

from tracker.terminal.program import run_program


def main() -> NoReturn:
    """Run the node, or say in one line what it lacks."""
    run_program("raised-hand-dds", _body)


def _body() -> None:
    from nodes.dds_hand_detector import app

    app()


if __name__ == "__main__":
    main()
