"""The frame of `tracker.tracking.frame` as loops, compiled by numba (the extra `fast`).

Where NumPy pays for each small call, a loop pays for what it computes: a frame of twenty people
costs a tenth. File by file the stages are those of `tracker.tracking`, whose docstrings hold the
equations and their sources; the tests hold both to the same numbers.

The machine code is kept on disk, so that only the first run on a machine waits for the compiler.
"""
