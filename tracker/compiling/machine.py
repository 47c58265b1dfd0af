"""Compiled code: numba compiles it once on a machine, in the background.

Until it is there, functions run as the Python that they are: nothing waits for the compiler but
`Machine.finish`. The compiler is a process of its own, so that it takes no time from what
runs in this one; what it leaves on disk is loaded.
"""

from __future__ import annotations

import atexit
import logging
import os
import subprocess
import sys
import tempfile
from collections.abc import Callable
from contextlib import ExitStack
from pathlib import Path
from threading import Event, Thread
from typing import Any

from tracker.compiling import files

LOG = logging.getLogger(__name__)
#: How often one looks whether the compiler is done.
_LOOK_S = 0.1
#: What the compiler's process does, once whoever compiles into the same folder is done; whatever
#: else runs goes first. Ctrl-C is meant for the program, which ends its compiler.
_COMPILE = """
import contextlib, importlib, os, pathlib, signal, sys
signal.signal(signal.SIGINT, signal.SIG_IGN)
os.nice(10)
module, name, place = sys.argv[1:]
with open(os.path.join(place, "lock"), "w") as lock:
    with contextlib.suppress(ImportError, OSError):  # some systems have no locks
        import fcntl
        fcntl.flock(lock, fcntl.LOCK_EX)
    getattr(importlib.import_module(module), name)(pathlib.Path(place))
"""


class Machine:
    """Where the machine code of a function is, in this process.

    Args:
        build: Gives the compiled function, of a folder and `may_compile`, as `compiler.compiled`
            has them; it can be imported by its name.

    Attributes:
        code: The compiled function; None as long as it is not here.
    """

    def __init__(self, build: Callable[..., Callable[..., Any]]) -> None:
        self.code: Callable[..., Any] | None = None
        self._build = build
        self._thread: Thread | None = None
        self._process = 0
        self._leaves = Event()

    def start(
        self, say: Callable[[str], None] = LOG.info, warn: Callable[[str], None] = LOG.warning
    ) -> None:
        """Load what is compiled already, or let it be compiled in the background.

        Args:
            say: Gets a sentence before the compiler runs.
            warn: Gets one where its work cannot be kept, or numba not be loaded.
        """
        if self.code is not None or self._process == os.getpid():
            return
        try:
            folder = files.folder()
            if folder is not None and files.are_in(folder):
                self.code = self._build(folder, may_compile=False)
                return
        except FileNotFoundError:
            pass  # cut off, or for another processor
        except ImportError as error:
            warn(
                f"numba is installed but cannot be loaded ({error}); the tracker runs as "
                "Python, which is slow."
            )
            return
        say("Compiling the tracker, once on this machine, for about 15 s ...")
        trouble = files.trouble_with(folder)
        if trouble:
            warn(
                f"The compiled tracker cannot be stored ({trouble}), so every start compiles it "
                "again; set NUMBA_CACHE_DIR to a writable folder."
            )
            folder = None
        self._process = os.getpid()  # one that is forked off has no such thread
        self._leaves = Event()
        self._thread = Thread(target=self._compile, args=(folder,), name="compiler", daemon=True)
        self._thread.start()
        atexit.register(self._leave)

    def finish(self, say: Callable[[str], None]) -> None:
        """Load what is compiled already, or compile it now.

        Args:
            say: Gets a sentence before the compiler runs, and one where its work cannot be kept.
        """
        self.start(say, say)
        if self._thread is not None:
            self._thread.join()

    def _compile(self, folder: Path | None) -> None:
        """Let a process of its own compile, then load what it left."""
        build = self._build
        command = [sys.executable, "-c", _COMPILE, build.__module__, build.__name__]
        # More optimization costs time and gains none: nearly all is scalar arithmetic.
        around = {"PYTHONPATH": os.pathsep.join(filter(None, sys.path)), "NUMBA_OPT": "1"}
        with ExitStack() as until_done:
            try:
                place = folder or Path(
                    until_done.enter_context(tempfile.TemporaryDirectory(prefix="raised-hand-"))
                )
                compiler = subprocess.Popen(
                    [*command, str(place)], stdout=subprocess.DEVNULL, env={**os.environ, **around}
                )
            except OSError as error:
                LOG.warning(
                    "The compiler cannot be started (%s); the tracker runs as Python, "
                    "which is slow.",
                    error,
                )
                return
            while compiler.poll() is None:
                if self._leaves.wait(_LOOK_S):
                    compiler.terminate()
                    return
            if compiler.returncode == 0:
                self.code = self._build(place)
                LOG.info("The tracker is compiled.")
            else:
                LOG.warning(
                    "The compiler failed (its output is above); the tracker runs as "
                    "Python, which is slow."
                )

    def _leave(self) -> None:
        """The process ends: so does the compiler, and what is half loaded is loaded first."""
        self._leaves.set()
        if self._thread is not None:
            self._thread.join()
