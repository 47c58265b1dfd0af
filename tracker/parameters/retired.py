"""Which parameters did earlier versions have, and why did they go?

A file that was copied whole from an earlier version still names them, and must stop no robot.
"""

from __future__ import annotations

import warnings
from collections.abc import Callable, Mapping
from typing import Any

#: Their names, and why they went.
RETIRED = {
    "appearance_weight": "comparing the colors of clothes avoided false raises but caused false "
                         "customers",
    "hand_bias_duration_s": "lasting errors are part of the published covariance",
    "measurement_model": "measurements are always compared as bearing and range (polar)",
    **dict.fromkeys(
        (
            "palm_lowered_threshold", "small_hand_patience_s", "raised_score_min",
            "lowered_lean_min_deg", "pose_search_period", "pose_reads_per_frame",
            "hand_head_clearance", "owner_hand_px", "unowned_patience_s",
            "hand_shoulder_rise_min",
        ),
        "the rule `evidence` decides instead (`raise_rule`)",
    ),
}  # fmt: skip
#: Those that the last version had: programs may still name them in this one, and are warned.
LATELY_RETIRED = frozenset(RETIRED) - {"appearance_weight", "measurement_model"}
#: Values that have another name now, by parameter.
_RENAMED = {"pose_opinion": {"veto": "evidence", "full": "evidence"}}


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
            f"{origin}: parameters of an earlier version are ignored and may be deleted: "
            + "; ".join(gone)
        )
    return {name: value for name, value in values.items() if _parameter(name) not in RETIRED}


def without_lately_retired(values: Mapping[str, Any]) -> dict[str, Any]:
    """Parameters as this version knows them, with a `FutureWarning` for each that is changed."""
    kept = {name: value for name, value in values.items() if name not in LATELY_RETIRED}
    for name in sorted(values.keys() - kept.keys()):
        _warn(f"{name} has no effect any more: {RETIRED[name]}")
    for name, others in _RENAMED.items():
        if isinstance(kept.get(name), str) and kept[name] in others:
            _warn(f"{name}: {kept[name]} is now called {others[kept[name]]}")
            kept[name] = others[kept[name]]
    return kept


def _warn(what: str) -> None:
    warnings.warn(f"{what}. The next version refuses it.", FutureWarning, stacklevel=2)


def _parameter(name: str) -> str:
    """`outer` of `outer.inner`, as nested values are named."""
    return name.partition(".")[0]
