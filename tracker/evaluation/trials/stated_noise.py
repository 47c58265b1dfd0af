"""What would measurements claim of their noise under another configuration?

A robot does not know how noisy its sensors are: ranging states what the configuration says. So a
tuned `range_std_m` or `hand_offset_std_m` has to be put into measurements taken under another one.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from tracker.config import Config
from tracker.containers import Measurements, SensorKind
from tracker.ranging.bias import bias_covariance
from tracker.ranging.measuring import body_bearing_std_rad, is_told_by_size

#: The parameters that ranging states noise by.
STATED = ("range_std_m", "hand_offset_std_m")

#: What is left of a bearing's noise where all of it was said to be the hand's offset.
_PIXEL_VARIANCE_MIN = 1e-8


def restate(
    measurements: Measurements, config: Config, told_hand_offset_std_m: float | None
) -> Measurements:
    """The same measurements with the noise that ranging would state under `config`.

    As `ranging: person` does: a person in the scan has the same noise in both
    directions, and a hand without a range stands somewhere beside its body. What a hand's size
    has told stays as it is; what lasts is restated too where it is known what was told.

    Args:
        measurements: Bearings and ranges; positions are left alone.
        config: `range_std_m`, `hand_offset_std_m`, `unknown_range_m`.
        told_hand_offset_std_m: The offset that is in the bearings alone now; None leaves these
            alone.
    """
    range_m, noise = measurements.values[:, 1], np.array(measurements.covariance)
    ranged = measurements.kind == SensorKind.BEARING_RANGE
    ranged &= ~is_told_by_size(measurements)
    alone = measurements.kind == SensorKind.BEARING
    noise[ranged] = 0.0
    noise[ranged, 0, 0] = body_bearing_std_rad(range_m[ranged], config.range_std_m) ** 2
    noise[ranged, 1, 1] = config.range_std_m**2
    if told_hand_offset_std_m is None:
        return replace(measurements, covariance=noise)
    told, stated = (
        np.arctan2(offset_m, config.unknown_range_m) ** 2
        for offset_m in (told_hand_offset_std_m, config.hand_offset_std_m)
    )
    noise[alone, 0, 0] = np.maximum(noise[alone, 0, 0] - told, _PIXEL_VARIANCE_MIN) + stated
    body_m = config.torso_offset_std_m
    bias = bias_covariance(
        measurements.values[:, 0] + measurements.sensor_pose[:, 2],
        np.where(alone, config.unknown_range_m, range_m),
        config,
        along_m=body_m,
        across_m=np.where(alone, config.hand_offset_std_m, body_m),
        motion=np.zeros(3),
    )
    return replace(measurements, covariance=noise, bias_covariance=bias)
