"""Which numbers of the configuration does a compiled frame need?"""

from __future__ import annotations

from functools import lru_cache
from typing import NamedTuple

import numpy as np

from tracker.config import Config
from tracker.containers import FloatArray
from tracker.tracking.compiled.loop import loop
from tracker.tracking.gating import gate_limit


class Settings(NamedTuple):
    """Parameters by their own names; the gate's limits stand for its probability.

    All are one type of number; the last two are 0 or 1.
    """

    unknown_range_m: float
    same_person_distance_m: float
    detection_probability: float
    newcomer_density: float
    bystander_density: float
    person_range_max_m: float
    bearing_limit: float
    ranged_limit: float
    innovation_floor_m: float
    outlier_dof: float
    delete_after_s: float
    forget_after_s: float
    raise_streak: float
    lower_streak: float
    confirm_existence: float
    confirm_detections: float
    mature_detections: float
    unknown_range_std_m: float
    initial_speed_std_mps: float
    stand_speed_std_mps: float
    is_joint: float
    confirms_by_existence: float


@lru_cache(maxsize=32)
def settings_of(config: Config) -> FloatArray:
    """The numbers of a configuration, in the order of `Settings`.

    One array is handed over to compiled code faster than many numbers.
    """
    return np.array(
        Settings(
            unknown_range_m=config.unknown_range_m,
            same_person_distance_m=config.same_person_distance_m,
            detection_probability=config.detection_probability,
            newcomer_density=config.newcomer_density,
            bystander_density=config.bystander_density,
            person_range_max_m=config.person_range_max_m,
            bearing_limit=gate_limit(False, config.gate_probability),
            ranged_limit=gate_limit(True, config.gate_probability),
            innovation_floor_m=config.innovation_floor_m,
            outlier_dof=config.outlier_dof,
            delete_after_s=config.delete_after_s,
            forget_after_s=config.forget_after_s,
            raise_streak=config.raise_streak,
            lower_streak=config.lower_streak,
            confirm_existence=config.confirm_existence,
            confirm_detections=config.confirm_detections,
            mature_detections=config.mature_detections,
            unknown_range_std_m=config.unknown_range_std_m,
            initial_speed_std_mps=config.initial_speed_std_mps,
            stand_speed_std_mps=config.stand_speed_std_mps,
            is_joint=config.association == "jpda",
            confirms_by_existence=config.confirmation == "existence",
        ),
        dtype=np.float64,
    )


@loop
def named(numbers: FloatArray) -> Settings:
    """The same numbers by their names, inside compiled code."""
    return Settings(
        numbers[0], numbers[1], numbers[2], numbers[3], numbers[4], numbers[5], numbers[6],
        numbers[7], numbers[8], numbers[9], numbers[10], numbers[11], numbers[12], numbers[13],
        numbers[14], numbers[15], numbers[16], numbers[17], numbers[18], numbers[19], numbers[20],
        numbers[21],
    )  # fmt: skip
