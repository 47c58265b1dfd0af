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
    with np.load(_FILE) as stored:
        return {
            block: BlockRange(float(values[0]), float(values[1]), values[2:])
            for model, block, values in ((*key.split("/"), stored[key]) for key in stored.files)
            if model == name
        }


def save_ranges(ranges: dict[str, dict[str, BlockRange]]) -> None:
    """Replace the file that comes with the package."""
    arrays: dict[str, Any] = {
        f"{model}/{block}": np.array([found.low, found.high, *found.shift], np.float32)
        for model, blocks in ranges.items()
        for block, found in blocks.items()
    }
    np.savez_compressed(_FILE, **arrays)
