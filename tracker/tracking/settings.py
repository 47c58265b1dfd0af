"""Which numbers of the configuration does a frame need?"""

from __future__ import annotations

from functools import lru_cache
from typing import NamedTuple

import numpy as np
from scipy.stats import chi2

from tracker.config import Config


class Settings(NamedTuple):
    """Parameters by the names that `Config` gives them, and what follows from others; all floats.

    Attributes:
        bearing_limit: The gate's, of squared distances of one number.
        ranged_limit: The gate's, of squared distances of two numbers.
        is_hard: `association: hungarian`.
        is_joint: `association: jpda`.
        confirms_by_existence: `confirmation: existence`.
    """

    unknown_range_m: float
    unknown_range_std_m: float
    person_range_max_m: float
    same_person_distance_m: float
    detection_probability: float
    newcomer_density: float
    bystander_density: float
    innovation_floor_m: float
    outlier_dof: float
    delete_after_s: float
    forget_after_s: float
    raise_streak: float
    lower_streak: float
    confirm_existence: float
    confirm_detections: float
    mature_detections: float
    initial_speed_std_mps: float
    stand_speed_std_mps: float
    acceleration_density: float
    stand_duration_s: float
    walk_duration_s: float
    bearing_limit: float
    ranged_limit: float
    is_hard: float
    is_joint: float
    confirms_by_existence: float


#: Settings as machine code takes them over fastest: the same names, in one piece.
RECORD = np.dtype([(name, np.float64) for name in Settings._fields])


@lru_cache(maxsize=32)
def record_of(settings: Settings) -> np.void:
    """The same numbers, for machine code."""
    record: np.void = np.array([settings], dtype=RECORD)[0]
    return record


@lru_cache(maxsize=32)
def settings_of(config: Config) -> Settings:
    """The numbers of a configuration."""
    same = {
        name: float(getattr(config, name)) for name in Settings._fields if hasattr(config, name)
    }
    return Settings(
        **same,
        bearing_limit=gate_limit(1, config.gate_probability),
        ranged_limit=gate_limit(2, config.gate_probability),
        is_hard=float(config.association == "hungarian"),
        is_joint=float(config.association == "jpda"),
        confirms_by_existence=float(config.confirmation == "existence"),
    )


def gate_limit(numbers: int, gate_probability: float) -> float:
    """The largest squared distance inside the gate, of one or two numbers."""
    return float(chi2.ppf(gate_probability, numbers))
