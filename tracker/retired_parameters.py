"""Which parameters did earlier versions have, and why did they go?

A file that was copied whole from an earlier version still names them, and must stop no robot.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

#: Their names, and why they went.
RETIRED = {
    "appearance_weight": "the colors of clothes saved false raises and cost false customers",
    "measurement_model": "bearing and range are always compared where they were taken (polar)",
}


def without_retired(
    values: Mapping[str, Any], origin: str, remark: Callable[[str], object]
) -> dict[str, Any]:
    """Parameters without those that are retired, whatever their values.

    Args:
        values: Values by name, as `read_parameters` gives them.
        origin: Where they came from, for the remark.
        remark: Takes one line that names those left out; not called where there are none.
    """
    named = {_parameter(name) for name in values}
    gone = [f"`{name}` ({why})" for name, why in RETIRED.items() if name in named]
    if gone:
        remark(
            f"{origin}: parameters of an earlier version are left out and may be deleted: "
            + "; ".join(gone)
        )
    return {name: value for name, value in values.items() if _parameter(name) not in RETIRED}


def _parameter(name: str) -> str:
    """`outer` of `outer.inner`, as nested values are named."""
    return name.partition(".")[0]
