"""Trial i of seed s is the same on any worker and among any number of trials."""

from __future__ import annotations

import numpy as np


def trial_rng(seed: int, trial: int) -> np.random.Generator:
    """The randomness of one trial: child number `trial` of `SeedSequence(seed).spawn`.

    Args:
        seed: Of the study.
        trial: From 0.
    """
    return np.random.default_rng(np.random.SeedSequence(seed, spawn_key=(trial,)))
