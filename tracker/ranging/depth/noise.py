"""How large is the range error of a depth camera?"""

from __future__ import annotations

import numpy as np

from tracker.config import Config
from tracker.containers import FloatArray


def depth_noise_m(range_m: FloatArray, config: Config) -> FloatArray:
    """Standard deviation of the range, which grows with its square, as with stereo cameras.

    The disparity in pixels is f b / z. So an error of it changes the depth z by z^2 / (f b) times
    that error: Gallup et al., "Variable baseline/resolution stereo", CVPR 2008, equation 2.

    Args:
        range_m: Shape (N,).
        config: `depth_std_m`.
    """
    return np.asarray(config.depth_std_m * range_m**2)
