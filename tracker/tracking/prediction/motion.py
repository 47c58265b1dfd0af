"""How do people move between two stamps? They walk at nearly constant velocity, or they stand.

Walking is white-noise acceleration. Standing is a speed that keeps returning to zero (an
Ornstein-Uhlenbeck process), so that somebody who stands does not drift off while nobody looks.
Both are exact over any interval: two half steps equal a whole one.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from tracker.compiling.loops import loop, step
from tracker.config import Config
from tracker.containers import FloatArray
from tracker.tracking.people import People
from tracker.tracking.prediction.modes import mix
from tracker.tracking.settings import Settings

#: How fast the sway of somebody who stands is forgotten (guess).
STAND_MEMORY_S = 0.5


class Motion(NamedTuple):
    """What an interval does to somebody in one mode, both axes alike.

    Attributes:
        reach_s: A place moves by so many times the speed.
        rest: So much of the speed stays.
        position: Variance that the interval adds to a place ...
        mixed: ... its covariance with the speed ...
        velocity: ... and the variance of the speed.
    """

    reach_s: float
    rest: float
    position: float
    mixed: float
    velocity: float


@step
def walk(dt_s: float, acceleration_density: float) -> Motion:
    """Nearly constant velocity: white-noise acceleration of a density in m^2/s^3."""
    density = acceleration_density
    return Motion(dt_s, 1.0, density * dt_s**3 / 3, density * dt_s**2 / 2, density * dt_s)


@step
def stand(dt_s: float, speed_std_mps: float) -> Motion:
    """Swaying: the speed fades, and its variance stays bounded."""
    memory_s, variance = STAND_MEMORY_S, speed_std_mps**2
    lapse = -np.expm1(-dt_s / memory_s)
    # 2 t - 3 + 4 exp(-t) - exp(-2 t) without its cancellation, where t is short.
    position = 2.0 * (dt_s / memory_s - lapse) - lapse**2
    if dt_s < 1e-3 * memory_s:
        position = 2.0 / 3.0 * (dt_s / memory_s) ** 3
    return Motion(
        memory_s * lapse,
        1.0 - lapse,
        variance * memory_s**2 * position,
        variance * memory_s * lapse**2,
        variance * lapse * (2.0 - lapse),
    )


@step
def switching(dt_s: float, walk_duration_s: float, stand_duration_s: float) -> tuple[float, float]:
    """Probabilities that somebody who walks stands after an interval, and the other way.

    A Markov chain in continuous time, so that this too depends on the interval alone.
    """
    stop, start = 1.0 / walk_duration_s, 1.0 / stand_duration_s
    share = -np.expm1(-(stop + start) * dt_s) / (stop + start)
    return stop * share, start * share


def modes_of(config: Config) -> int:
    """How many modes of motion people have: one, or two where they may stand."""
    return 2 if config.motion == "imm" else 1


@loop
def predict(people: People, dt_s: float, settings: Settings, predicted: People) -> None:
    """Mix the modes by how people change between them, then carry each over the interval.

    Args:
        people: After the last frame.
        dt_s: The interval, from stamps.
        settings: Of the tracker.
        predicted: Its weight, mean and covariance are written.
    """
    walks = walk(dt_s, settings.acceleration_density)
    if len(people.weight) == 1:
        for person in range(people.weight.shape[1]):
            predicted.weight[0, person] = people.weight[0, person]
            carry(
                people.mean, people.covariance, 0, person, walks,
                predicted.mean, predicted.covariance,
            )  # fmt: skip
        return
    stands = stand(dt_s, settings.stand_speed_std_mps)
    stops, starts = switching(dt_s, settings.walk_duration_s, settings.stand_duration_s)
    for to in range(2):
        from_walk, from_stand = (1.0 - stops, starts) if to == 0 else (stops, 1.0 - starts)
        for person in range(people.weight.shape[1]):
            first = from_walk * people.weight[0, person]
            second = from_stand * people.weight[1, person]
            total = max(first + second, 1e-300)
            predicted.weight[to, person] = first + second
            mix(
                first / total, second / total, people.mean, people.covariance, person,
                predicted.mean[to], predicted.covariance[to],
            )  # fmt: skip
            carry(
                predicted.mean, predicted.covariance, to, person, walks if to == 0 else stands,
                predicted.mean, predicted.covariance,
            )  # fmt: skip


@loop
def carry(
    mean: FloatArray,
    covariance: FloatArray,
    mode: int,
    person: int,
    motion: Motion,
    new_mean: FloatArray,
    new: FloatArray,
) -> None:
    """F x and F P F' + Q of one person in one mode of motion.

    Args:
        mean: Shape (K, N, 4).
        covariance: Shape (K, N, 4, 4).
        mode: Row of the mode.
        person: Row of the person.
        motion: In that mode.
        new_mean: Where the mean is written; may be `mean`.
        new: Where the covariance is written; may be `covariance`.
    """
    reach_s, rest, position, mixed, velocity = motion
    for i in range(2):
        speed = mean[mode, person, i + 2]
        new_mean[mode, person, i] = mean[mode, person, i] + reach_s * speed
        new_mean[mode, person, i + 2] = rest * speed
        for j in range(2):
            to, at, is_same = i + 2, j + 2, 1.0 if i == j else 0.0
            place, speed = covariance[mode, person, i, j], covariance[mode, person, to, at]
            right, below = covariance[mode, person, i, at], covariance[mode, person, to, j]
            place += reach_s * (right + below + reach_s * speed)
            new[mode, person, i, j] = place + is_same * position
            new[mode, person, i, at] = rest * (right + reach_s * speed) + is_same * mixed
            new[mode, person, to, j] = rest * (below + reach_s * speed) + is_same * mixed
            new[mode, person, to, at] = rest * rest * speed + is_same * velocity
