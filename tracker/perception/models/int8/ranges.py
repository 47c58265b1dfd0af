"""Which blocks of which models compute in 8 bits, and with what numbers?

Measured on drawn people by `benchmarks/fit_int8.py`, which also says how little the results move.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from tracker.perception.models.int8.quantize import BlockRange

_FILE = Path(__file__).with_name("ranges.npz")


def load_ranges(name: str) -> dict[str, BlockRange]:
    """What was measured of the blocks of a model, by their names."""
    found: dict[str, BlockRange] = {}
    with np.load(_FILE) as stored:
        for model, block, _ in (key.split("/") for key in stored.files):
            if model == name and block not in found:
                low, high = stored[f"{model}/{block}/ends"].tolist()
                reach, shift = (stored[f"{model}/{block}/{part}"] for part in ("reach", "shift"))
                found[block] = BlockRange(low, high, reach, shift)
    return found


def save_ranges(ranges: dict[str, dict[str, BlockRange]]) -> None:
    """Replace the file that comes with the package."""
    arrays: dict[str, Any] = {}
    for model, blocks in ranges.items():
        for block, found in blocks.items():
            arrays[f"{model}/{block}/ends"] = np.array([found.low, found.high], np.float32)
            arrays[f"{model}/{block}/reach"] = found.reach
            arrays[f"{model}/{block}/shift"] = found.shift
    np.savez_compressed(_FILE, **arrays)
