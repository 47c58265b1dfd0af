"""Which numbers do models compute with on this processor: single precision, or partly 8 bits?"""

from __future__ import annotations

import os
import platform
from functools import cache
from pathlib import Path

from tracker.errors import ConfigError
from tracker.perception.models.catalog import INT8_SUFFIX, MODELS
from tracker.perception.models.store import ModelStore

_CPUINFO = Path("/proc/cpuinfo")
#: Linux' names of instructions for products of bytes, added up four at a time. `auto` relies on
#: the first alone, on which 8 bits were measured: 0.55 of the time. ARM's have not been.
_FAST = frozenset({"avx512_vnni"})
_EXACT = _FAST | {"avx_vnni", "asimddp"}
#: What says how fast a processor multiplies, in Linux' names.
_INSTRUCTION_SETS = (
    "avx2", "fma", "avx512f", "avx_vnni", "avx512_vnni", "avx512_bf16", "asimd", "asimddp", "i8mm",
)  # fmt: skip


def model_to_run(name: str, numbers: str, provider: str = "cpu") -> str:
    """The name in the catalog of the file that runs for a model.

    Args:
        name: Of the model in single precision.
        numbers: `Config.model_numbers`.
        provider: ONNX Runtime's; all but the processor's run single precision.

    Raises:
        ConfigError: 8 bits are asked for where they would go wrong.
    """
    in_bytes = name + INT8_SUFFIX
    is_offered = any(entry.name == in_bytes for entry in MODELS)
    if numbers == "fp32" or not is_offered or provider != "cpu":
        return name
    features = processor_features()
    if numbers == "auto":
        return in_bytes if features & _FAST else name
    # x86 before VNNI adds two products in 16 bits, which overflow.
    if not features & _EXACT and platform.machine().lower() in ("x86_64", "amd64"):
        raise ConfigError(
            "`model_numbers` is 'int8', but this processor has no VNNI instructions, without "
            "which the sums overflow; choose `auto` or `fp32`."
        )
    return in_bytes


def file_to_run(store: ModelStore, name: str, numbers: str, provider: str = "cpu") -> str:
    """As `model_to_run`, by the files of a store: `auto` needs none in 8 bits.

    A folder of models from before there were 8 bits does as well.

    Raises:
        ConfigError: As `model_to_run`.
        ModelFileError: The folder or a file in it must not be read.
    """
    file = model_to_run(name, numbers, provider)
    return name if numbers == "auto" and not store.has(file) else file


def runs_here(store: ModelStore, numbers: str, provider: str = "cpu") -> frozenset[str]:
    """The names in the catalog of all files of a store that run; the rest is there in vain.

    Raises:
        ConfigError: As `model_to_run`.
        ModelFileError: As `file_to_run`.
    """
    plain = [entry.name for entry in MODELS if not entry.in_bytes]
    names = (file_to_run(store, name, numbers, provider) for name in plain)
    return frozenset(name for name in names if store.has(name))


@cache
def processor_features() -> frozenset[str]:
    """The instruction sets that Linux names; none elsewhere."""
    try:
        lines = _CPUINFO.read_text(encoding="utf-8", errors="replace").splitlines()
    except OSError:
        return frozenset()
    for line in lines:
        key, _, words = line.partition(":")
        if key.strip() in ("flags", "Features"):
            return frozenset(words.split())
    return frozenset()


def processor_kind() -> str:
    """On what a figure was measured, such as "x86_64, 2 processors: avx2, fma"."""
    named = ", ".join(name for name in _INSTRUCTION_SETS if name in processor_features())
    sets = named or "instruction sets unknown"
    return f"{platform.machine()}, {os.cpu_count()} processors: {sets}"
