"""Is a person who has just appeared the one who was lost there?"""

from __future__ import annotations

import numpy as np
from scipy.optimize import linear_sum_assignment

from tracker.containers import FloatArray

#: Chi-square quantile of 0.99 for two degrees of freedom.
_GATE = 9.21


def found_again(
    lost_xy_m: FloatArray,
    lost_covariance_m2: FloatArray,
    new_xy_m: FloatArray,
    new_covariance_m2: FloatArray,
    place_std_m: float,
) -> list[tuple[int, int]]:
    """Pair the lost with the new, by place alone, so that the sum of distances is smallest.

    A pair is allowed where the squared Mahalanobis distance, d' inv(S) d, is within its 0.99
    quantile; S is the covariance of both places and of what people move in their seats.

    Args:
        lost_xy_m: Shape (L, 2): where the lost were seen last.
        lost_covariance_m2: Shape (L, 2, 2).
        new_xy_m: Shape (N, 2): where the new ones are.
        new_covariance_m2: Shape (N, 2, 2).
        place_std_m: How far people move while out of sight, as standard deviation per axis.

    Returns:
        Rows of `lost_xy_m` and `new_xy_m` that belong together.
    """
    if not len(lost_xy_m) or not len(new_xy_m):
        return []
    offset = new_xy_m[None] - lost_xy_m[:, None]
    spread = lost_covariance_m2[:, None] + new_covariance_m2[None] + place_std_m**2 * np.eye(2)
    squared = np.einsum("lni,lni->ln", offset, np.linalg.solve(spread, offset[..., None])[..., 0])
    # Beyond the gate all pairs cost the same, more than any within: as many as possible are found.
    cost = np.where(squared <= _GATE, squared, 1e3 * _GATE)
    pairs = zip(*linear_sum_assignment(cost), strict=True)
    return [(int(lost), int(new)) for lost, new in pairs if squared[lost, new] <= _GATE]
