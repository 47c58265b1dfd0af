"""The command `raised-hand-dds`, as far as it goes where its extra is not installed."""

import sys

from tracker.errors import ConfigError


def main() -> None:
    """Run the node, or say in one line what it lacks."""
    try:
        from nodes.dds_hand_detector import main as run
    except ConfigError as error:
        print(f"raised-hand-dds: {error}", file=sys.stderr)
        sys.exit(2)
    run()
