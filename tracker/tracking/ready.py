"""Is the tracker's frame compiled? The first time on a machine this takes a minute."""

from collections.abc import Callable
from importlib.util import find_spec


def compile_tracker(say: Callable[[str], None]) -> None:
    """Load the compiled frame, or compile it now where numba (the extra `fast`) is installed.

    Args:
        say: Gets a sentence before the compiler runs, and one where its work cannot be kept.
    """
    if find_spec("numba") is None:
        return
    from tracker.tracking.compiled.kept import folder, trouble_of

    place = folder()
    if place is None or not any(place.glob("kernel.track_frame*.nbc")):
        say("Compiling the tracker, once on this machine: about a minute ...")
    from tracker.tracking.compiled.kernel import track_frame

    trouble = trouble_of(track_frame)
    if trouble:
        say(
            f"The compiled tracker cannot be kept ({trouble}), so that every start compiles it; "
            "set NUMBA_CACHE_DIR to a folder that may be written."
        )
