"""`python -m tracker.cli` is `raised-hand`."""

from tracker.cli.app import main

if __name__ == "__main__":
    main()
