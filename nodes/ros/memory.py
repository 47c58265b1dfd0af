"""How does memory that is not needed any more go back to the system?"""

from __future__ import annotations

import ctypes
import gc


def give_back() -> None:
    """Collect what only circles hold, and let the allocator return what is free.

    glibc keeps what the threads of the models have freed for threads that never come again: some
    20 MB each time that models are loaded again. Other libraries have no such function.
    """
    gc.collect()
    trim = getattr(ctypes.CDLL(None), "malloc_trim", None)
    if trim is not None:
        trim(0)
