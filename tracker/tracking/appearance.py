"""Whose hand is up again? What somebody wears, remembered and compared.

Where two people stand close together, or nobody has measured them for a while, their clothes tell
them apart. What a distance between two histograms is worth was measured: see `_LOG_RATIO`.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from tracker.containers import BoolArray, FloatArray, IntArray
from tracker.containers.arrays import constant

#: log p(distance | one person) - log p(distance | two people) = a - b * distance, by logistic
#: regression, pairs of both kinds weighed alike: `python benchmarks/clothes.py --photos FOLDER`,
#: half rendered guests (141 and 67 755 pairs), half 55 photos and changed copies (29 and 247).
#: Guests alone give (5.7, 8.5), photos alone (2.5, 5.6). A distance lies in [0, 1], so that
#: clothes never weigh more than these few nats, either way.
_LOG_RATIO = (3.0, 5.5)
#: Share of the newest look in what is remembered: looks of one raise are alike (guess).
_NEWEST = 0.05
#: A histogram adds up to 1, but for rounding in single precision.
_SUM_ERROR_MAX = 1e-3


@dataclass(frozen=True, slots=True, eq=False)
class Appearance:
    """What N people wear, as far as it was seen.

    Attributes:
        histogram: Shape (N, D): rows that add up to 1, or zeros where it is unknown. D is 0 until
            the first look.
    """

    histogram: FloatArray

    def __getitem__(self, rows: Any) -> Appearance:
        return Appearance(self.histogram[rows])

    @staticmethod
    def unknown(count: int) -> Appearance:
        """Of people who were never looked at."""
        return Appearance(constant(0.0, (count, 0)))

    def append(self, other: Appearance) -> Appearance:
        """Rows of both, in order."""
        bins = max(self.histogram.shape[1], other.histogram.shape[1])
        return Appearance(
            np.concatenate([_of_length(self.histogram, bins), _of_length(other.histogram, bins)])
        )

    def remember(self, looks: FloatArray | None, look_of: IntArray) -> Appearance:
        """The running average, with one more look at some of them.

        Args:
            looks: Shape (M, D): histograms as `recognizable` returns them; None for no look.
            look_of: Shape (N,): row of each one's look, or -1.
        """
        if looks is None:
            return self
        known = _of_length(self.histogram, looks.shape[1])
        newest = np.where(look_of[:, None] >= 0, looks[look_of], 0.0) if len(looks) else 0 * known
        is_seen = newest.any(axis=1)
        share = np.where(is_seen, np.where(known.any(axis=1), _NEWEST, 1.0), 0.0)[:, None]
        return Appearance((1.0 - share) * known + share * newest)

    def log_ratio(self, looks: FloatArray, person: IntArray, look: IntArray) -> FloatArray:
        """How much likelier each look is at this person than at another, logarithm, shape (P,).

        Args:
            looks: Shape (M, D): histograms as `recognizable` returns them.
            person: Shape (P,): rows of people.
            look: Shape (P,): rows of looks. Where one of both is unknown, the answer is 0.
        """
        known = _of_length(self.histogram, looks.shape[1])[person]
        seen = looks[look]
        at_zero, slope = _LOG_RATIO
        ratio = at_zero - slope * hellinger(known, seen)
        return np.where(known.any(axis=1) & seen.any(axis=1), ratio, 0.0)


def recognizable(histograms: FloatArray) -> FloatArray:
    """The same histograms, with zeros where they are none.

    Args:
        histograms: Shape (M, D). Rows with NaN, negative numbers or another sum than 1 are none.
    """
    return np.where(_is_histogram(histograms)[:, None], histograms, 0.0)


def hellinger(one: FloatArray, other: FloatArray) -> FloatArray:
    """Distance between histograms, sqrt(1 - sum(sqrt(p q))), in [0, 1].

    Args:
        one: Shape (..., D).
        other: Shape (..., D).
    """
    overlap = np.sqrt(one * other).sum(axis=-1)
    return np.asarray(np.sqrt(np.clip(1.0 - overlap, 0.0, 1.0)))


def _is_histogram(rows: FloatArray) -> BoolArray:
    within = (rows >= 0.0) & (rows <= 1.0 + _SUM_ERROR_MAX)  # NaN compares as false
    total = np.where(within, rows, 0.0).sum(axis=1)
    return np.asarray(within.all(axis=1) & (np.abs(total - 1.0) <= _SUM_ERROR_MAX))


def _of_length(histograms: FloatArray, bins: int) -> FloatArray:
    """Of another number of bins nothing is known."""
    if histograms.shape[1] == bins:
        return histograms
    return np.zeros((len(histograms), bins))
