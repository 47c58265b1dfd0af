"""What does the camera see of people's clothes? Histograms that look alike from raise to raise."""

from __future__ import annotations

import numpy as np

from tracker.containers import BoolArray, FloatArray

_BINS = 12
#: Few colors for each person: two people are 0.74 apart on average (Hellinger), as in pictures.
_CONCENTRATION = 0.1


def draw_clothes(rng: np.random.Generator, count: int) -> FloatArray:
    """Histograms of as many people, or of anything else a camera may look at.

    Args:
        rng: All randomness.
        count: C.

    Returns:
        Shape (C, D), rows adding up to 1.
    """
    return rng.dirichlet(np.full(_BINS, _CONCENTRATION), count)


def look_at_clothes(hand_up: BoolArray, noise: float, rng: np.random.Generator) -> FloatArray:
    """What is seen of each person in each frame.

    Arm, chair and wall get into the picture of the clothes, a share of it drawn evenly from 0 to
    `noise`; as pose and place stay what they are while a hand is up, so does what is seen.

    Args:
        hand_up: Shape (T, P).
        noise: In [0, 1].
        rng: All randomness.

    Returns:
        Shape (T, P, D).
    """
    frames, people = hand_up.shape
    clothes = draw_clothes(rng, people)
    looks = np.empty((frames, people, _BINS))
    for person in range(people):
        rises = np.diff(hand_up[:, person], prepend=False) & hand_up[:, person]
        raise_of = np.cumsum(rises)  # 0 before the first
        share = rng.uniform(0.0, noise, (raise_of[-1] + 1, 1))
        beside = draw_clothes(rng, len(share))
        looks[:, person] = ((1.0 - share) * clothes[person] + share * beside)[raise_of]
    return looks
