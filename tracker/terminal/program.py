"""How do our programs end? With one line and an exit status.

Exit status: 0 done, 1 something failed or the input was broken, 2 the words on the command line
were wrong, 130 stopped by Ctrl-C.
"""

from __future__ import annotations

import errno
import io
import os
import signal
import sys
from collections.abc import Callable
from typing import NoReturn

from tracker.errors import ConfigError, SceneError, TrackerError
from tracker.wording import one_line

INTERRUPTED = 130

#: With half a gigabyte the libraries of linear algebra crash as they are imported (tried).
_ADDRESSES_MIN = 700_000_000


def run_program(name: str, body: Callable[[], None]) -> NoReturn:
    """Run a program, and leave.

    Args:
        name: The command, first word of what is said.
        body: All of it, with its imports, in which Ctrl-C may come too.
    """
    if os.environ.get("COLUMNS") == "0":  # a terminal of unknown width; Rich would print nothing
        del os.environ["COLUMNS"]
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):  # none of them where it is closed
            stream.reconfigure(errors="backslashreplace")
    status, words = _outcome(body)
    if words:
        _print_last(f"{name}: {one_line(words)}")
    sys.exit(status)


def print_version(wanted: bool) -> None:
    """Print the version of the project, and leave; the callback of an option `--version`."""
    if wanted:
        from tracker import __version__

        print(f"raised-hand-tracker {__version__}")
        sys.exit(0)


def _outcome(body: Callable[[], None]) -> tuple[int, str]:
    try:
        _check_words()
        _check_memory()
        body()
        if sys.stdout is not None:
            sys.stdout.flush()
    except (ConfigError, SceneError) as error:
        return 2, str(error)
    except TrackerError as error:
        return 1, str(error)
    except KeyboardInterrupt:
        return _interrupted()
    except SystemExit as leaving:
        if leaving.code == INTERRUPTED:  # what typer makes of Ctrl-C
            return _interrupted()
        return leaving.code if isinstance(leaving.code, int) else int(leaving.code is not None), ""
    except MemoryError:
        return 1, "there is not enough memory; give the process more memory, or less work."
    except ImportError as error:
        if not str(error.path).endswith((".so", ".pyd")):
            raise
        return 1, f"a library cannot be loaded ({error}); often there is too little memory."
    except BrokenPipeError:  # `| head` has seen enough
        return 1, ""
    except OSError as error:
        if error.errno is None:  # of a library that cannot be loaded, for one
            return 1, str(error)
        place = error.filename if error.filename is not None else "standard output or a file"
        return 2 if error.errno == errno.ENAMETOOLONG else 1, f"{place}: {error.strerror}."
    return 0, ""


def _check_words() -> None:
    """Refuse names that no table, page or database can hold, before the work.

    Raises:
        ConfigError: An argument is no UTF-8 text.
    """
    for word in sys.argv[1:]:
        if not word.isascii() and any("\ud800" <= letter <= "\udfff" for letter in word):
            raise ConfigError(f"{word}: is not UTF-8 text; rename the file.")


def _check_memory() -> None:
    """Refuse to start with so little memory that libraries crash while loading.

    Raises:
        ConfigError: The address space is limited to less.
    """
    if sys.platform == "win32":
        return
    from resource import RLIM_INFINITY, RLIMIT_AS, getrlimit

    limit, _ = getrlimit(RLIMIT_AS)
    if limit != RLIM_INFINITY and limit < _ADDRESSES_MIN:
        raise ConfigError(
            f"The address space is limited to {limit / 1e9:.2f} GB (ulimit -v); expected "
            f"{_ADDRESSES_MIN / 1e9:g} GB, and 3 GB for images."
        )


def _interrupted() -> tuple[int, str]:
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # a second Ctrl-C comes to the same
    return INTERRUPTED, "stopped; the files written so far can be read."


def _print_last(text: str) -> None:
    """Print the last line, and avoid errors while the interpreter ends."""
    for stream, words in ((sys.stdout, ""), (sys.stderr, f"{text}\n")):
        if stream is None:
            continue
        try:
            stream.write(words)
            stream.flush()
        except (OSError, ValueError):  # full, or closed
            if isinstance(stream, io.TextIOWrapper) and not stream.closed:
                os.dup2(os.open(os.devnull, os.O_WRONLY), stream.fileno())
