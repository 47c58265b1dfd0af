"""Plain functions that numba turns into machine code in the background; where that is kept."""
