"""Does each person keep one identity, and does each identity stay with one person?

Both questions are asked of the pairs of a whole run: row i of `person` and `track` is one pair of
one frame (from `matching.Matcher`), rows in order of time.
"""

from __future__ import annotations

import numpy as np

from tracker.containers import IntArray


def identity_switches(person: IntArray, track: IntArray) -> int:
    """How often a person was another track than when last paired, gaps or no gaps.

    Args:
        person: Shape (K,), identities of people, in order of time.
        track: Shape (K,), identities of their tracks.
    """
    order = np.argsort(person, kind="stable")
    person, track = person[order], track[order]
    return int(np.count_nonzero((person[1:] == person[:-1]) & (track[1:] != track[:-1])))


def track_purity(person: IntArray, track: IntArray) -> float:
    """Share of all pairs in which a track stood for the person it stood for most; NaN for none.

    Args:
        person: Shape (K,), identities of people.
        track: Shape (K,), identities of their tracks.
    """
    if len(track) == 0:
        return float("nan")
    _, row = np.unique(track, return_inverse=True)
    _, column = np.unique(person, return_inverse=True)
    counts = np.zeros((row.max() + 1, column.max() + 1), dtype=np.int64)
    np.add.at(counts, (row, column), 1)
    return float(counts.max(axis=1).sum() / len(track))
