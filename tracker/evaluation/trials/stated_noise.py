"""What would measurements claim of their noise under another configuration?

A robot does not know how noisy its sensors are: ranging states what the configuration says. So a
tuned `range_std_m` or `hand_offset_std_m` has to be put into measurements taken under another one.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from tracker.config import Config
from tracker.containers import MeasurementModel, Measurements

#: The parameters that ranging states noise by.
STATED = ("range_std_m", "hand_offset_std_m")

_RANGE_MIN_M = 0.05


def restate(
    measurements: Measurements, config: Config, told_hand_offset_std_m: float | None
) -> Measurements:
    """The same measurements with the noise that ranging would state under `config`.

    As `ranging: person` does: a person in the scan has the same noise in both
    directions, and a hand without a range stands somewhere beside its body.

    Args:
        measurements: Bearings and ranges; positions are left alone.
        config: `range_std_m`, `hand_offset_std_m`, `unknown_range_m`.
        told_hand_offset_std_m: The offset that is in the bearings alone now; None leaves these
            alone.
    """
    polar = measurements.model == MeasurementModel.POLAR
    range_m, noise = measurements.values[:, 1], np.array(measurements.covariance)
    ranged, alone = polar & ~np.isnan(range_m), polar & np.isnan(range_m)
    far_m = np.maximum(range_m[ranged], _RANGE_MIN_M)
    noise[ranged] = 0.0
    noise[ranged, 0, 0] = (config.range_std_m / far_m) ** 2
    noise[ranged, 1, 1] = config.range_std_m**2
    if told_hand_offset_std_m is None:
        return replace(measurements, covariance=noise)
    told, stated = (
        np.arctan2(offset_m, config.unknown_range_m) ** 2
        for offset_m in (told_hand_offset_std_m, config.hand_offset_std_m)
    )
    noise[alone, 0, 0] = np.maximum(noise[alone, 0, 0] - told, 0.0) + stated
    return replace(measurements, covariance=noise)
