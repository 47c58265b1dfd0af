"""How large is the range error of a depth camera?"""

from __future__ import annotations

import numpy as np

from tracker.config import Config
from tracker.containers import FloatArray


def depth_noise_m(range_m: FloatArray, config: Config) -> FloatArray:
    """Standard deviation, which grows with the square of the range, as of stereo cameras.

    A pixel of disparity is f b / z, so that an error of it moves the depth z by z^2 / (f b) times
    as much: Gallup et al., "Variable baseline/resolution stereo", CVPR 2008, equation 2.

    Args:
        range_m: Shape (N,).
        config: `depth_std_m`.
    """
    return np.asarray(config.depth_std_m * range_m**2)
