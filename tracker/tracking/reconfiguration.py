"""How are tracks kept when parameters change?"""

from __future__ import annotations

import numpy as np

from tracker.config import Config
from tracker.tracking.life_cycle.renewal import Frame
from tracker.tracking.prediction.motion import modes_of


def under(frame: Frame, config: Config) -> Frame:
    """The same people under other parameters: `motion` and `confirm_window` change their arrays.

    Where people have modes from now on they are as likely to walk as to stand; where they had
    them, one Gaussian stands for both.
    """
    people, window, modes = frame.people, config.confirm_window, modes_of(config)
    if window != people.recent.shape[1]:
        held = people.recent[:, :window]
        recent = np.zeros((len(held), window), dtype=bool)
        recent[:, : held.shape[1]] = held
        people = people._replace(recent=recent)
    if modes != len(people.weight):
        mean = np.repeat(frame.mean, modes, axis=0)
        covariance = np.repeat(frame.covariance, modes, axis=0)
        if modes == 2:
            # Who stands has a speed of their own, which says nothing of the place.
            covariance[1, :, 2:] = covariance[1, :, :, 2:] = 0.0
            covariance[1, :, [2, 3], [2, 3]] = config.stand_speed_std_mps**2
        weight = np.full(mean.shape[:2], 1.0 / modes)
        people = people._replace(weight=weight, mean=mean, covariance=covariance)
    return frame._replace(people=people)
