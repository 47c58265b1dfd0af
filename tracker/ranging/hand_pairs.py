"""Which raised hands could be two of one person? By the bodies seen, or by the picture alone."""

from __future__ import annotations

import numpy as np

from tracker.containers import Hands, IntArray

#: Hands of one person are at most so many hand lengths apart: two arms spread beside the head.
_DISTANCE_LENGTHS = 6.0
#: ... and about equally far away.
_LENGTH_RATIO = 1.5


def pair_hands(hands: Hands) -> IntArray:
    """Number the pairs of one person's raised hands, the closest first.

    Hands whose torso is known for both are a pair if that is the same; others if they are a left
    and a right one of like size.

    Returns:
        Shape (H,): hands that share a number are probably one person's; -1 for a hand alone.
    """
    length = np.maximum(hands.length_px, 1.0)
    right = hands.right > 0.5
    candidates = []
    raised = np.flatnonzero(hands.raised)
    for position, a in enumerate(raised):
        for b in raised[position + 1 :]:
            apart_px = np.linalg.norm(hands.wrist_px[a] - hands.wrist_px[b])
            apart = float(apart_px / (length[a] + length[b]) * 2)
            ratio = max(length[a], length[b]) / min(length[a], length[b])
            is_pair = right[a] != right[b] and ratio < _LENGTH_RATIO and apart < _DISTANCE_LENGTHS
            if hands.is_owned[a] and hands.is_owned[b]:
                is_pair = bool((hands.torso_px[a] == hands.torso_px[b]).all())
            if is_pair:
                candidates.append((apart, a, b))
    pair = np.full(len(hands), -1, dtype=np.int64)
    for number, (_, a, b) in enumerate(sorted(candidates)):
        if pair[a] < 0 and pair[b] < 0:
            pair[a] = pair[b] = number
    return pair
