"""How is unused memory returned to the system?"""

from __future__ import annotations

import ctypes
import gc


def give_back() -> None:
    """Run the garbage collector, and let the allocator return free memory.

    glibc keeps what the threads of the models have freed for threads that never come again: some
    20 MB each time that models are loaded again. Other libraries have no such function.
    """
    gc.collect()
    trim = getattr(ctypes.CDLL(None), "malloc_trim", None)
    if trim is not None:
        trim(0)
