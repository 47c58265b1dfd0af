"""How well is a share or a rate known after this many trials? 95 % intervals."""

from __future__ import annotations

import numpy as np
from scipy.stats import chi2, norm

_TAIL = 0.025


def wilson_interval(count: float, total: float) -> tuple[float, float]:
    """Wilson's interval of a share; valid also if the count is 0 or the total.

    Args:
        count: How many of the trials.
        total: Trials; NaN at both ends where there were none.

    Source: Wilson, "Probable inference, the law of succession, and statistical inference", 1927.
    """
    if total == 0:
        return float("nan"), float("nan")
    share, z = count / total, float(norm.ppf(1.0 - _TAIL))
    middle = (share + z**2 / (2 * total)) / (1 + z**2 / total)
    half = z * np.sqrt(share * (1 - share) / total + z**2 / (4 * total**2)) / (1 + z**2 / total)
    # Exact at the ends, where rounding would put the share itself outside.
    low = 0.0 if count == 0 else float(middle - half)
    high = 1.0 if count == total else float(middle + half)
    return low, high


def poisson_interval(count: int, exposure: float) -> tuple[float, float]:
    """Garwood's exact interval of a rate; with no event, its upper end is still above 0.

    Args:
        count: Events.
        exposure: How long was watched; the rate is in events per its unit. NaN at both ends where
            nothing was watched.

    Source: Garwood, "Fiducial limits for the Poisson distribution", Biometrika 28, 1936.
    """
    if exposure == 0:
        return float("nan"), float("nan")
    low = float(chi2.ppf(_TAIL, 2 * count)) / 2 if count else 0.0
    high = float(chi2.ppf(1.0 - _TAIL, 2 * (count + 1))) / 2
    return low / exposure, high / exposure
