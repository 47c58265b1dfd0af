"""What tests of the tracking share: people and pairs from plain arrays, both kinds of trackers.

What is made here are functions, so that hypothesis can call them as often as it likes.
"""

from functools import partial

import numpy as np
import pytest

from tracker import PersonTracker
from tracker.tracking.association.gating import find_pairs
from tracker.tracking.machine_frame import compile_tracker, machine
from tracker.tracking.people import EXISTENCE, HAND, ID, RAISED_SINCE_NS, TAG, room_for
from tracker.tracking.person_tracker import NO_LIKENESS
from tracker.tracking.prediction.modes import merge_modes
from tracker.tracking.sensing.claims import claims_of
from tracker.tracking.settings import settings_of
from tracker.tracking.update.correction import correct


def _people(mean, covariance, weight=None, *, ids=None, window=5):
    mean = np.asarray(mean, dtype=float)
    mean = mean[None] if mean.ndim == 2 else mean
    people = room_for(*mean.shape[:2], window)
    people.weight[:] = 1.0 / len(mean) if weight is None else weight
    people.mean[:], people.covariance[:] = mean, covariance
    people.spans[:], people.spans[EXISTENCE] = 0.0, 0.5
    people.counts[:] = people.flags[:] = people.recent[:] = 0
    people.counts[[RAISED_SINCE_NS, HAND, TAG]] = -1
    people.counts[ID] = np.arange(1, mean.shape[1] + 1) if ids is None else ids
    return people


def _merged(people):
    count = people.weight.shape[1]
    mean, covariance = np.empty((count, 4)), np.empty((count, 4, 4))
    merge_modes(*people[:3], mean, covariance)
    return mean, covariance


def _pairs(people, measured, config, *, chance=0.9, density=None, likeness=NO_LIKENESS, rows=None):
    claims, settings = claims_of(measured), settings_of(config)
    mean, covariance = _merged(people)
    return find_pairs(
        people,
        mean[None],
        covariance[None],
        claims,
        np.argsort(claims.kind, kind="stable") if rows is None else rows,
        np.full(len(mean), chance),
        likeness,
        density or settings.newcomer_density,
        settings,
    )


def _corrected(mean, covariance, measured, dof=0.0):
    mean, covariance = np.asarray(mean)[None], np.asarray(covariance)[None]
    claims = claims_of(measured)
    posterior_mean, posterior = np.empty_like(mean), np.empty_like(covariance)
    for row in range(len(measured)):
        correct(
            *(mean, covariance, 0, row, claims, row, dof),
            *(posterior_mean, posterior, row, np.empty((4, 2))),
        )
    return posterior_mean[0], posterior[0]


@pytest.fixture(scope="module", autouse=True)
def quiet():
    """Infinities that are meant are no warning, as where a tracker runs these loops."""
    with np.errstate(all="ignore"):
        yield


@pytest.fixture(scope="session")
def matrices_of():
    """F and Q, shape (4, 4), of a `Motion`."""

    def matrices(motion):
        reach_s, rest, position, mixed, velocity = motion
        transition = np.kron([[1.0, reach_s], [0.0, rest]], np.eye(2))
        return transition, np.kron([[position, mixed], [mixed, velocity]], np.eye(2))

    return matrices


@pytest.fixture(scope="session")
def people_of():
    """Customers 1, 2, ... from means (N, 4) or (K, N, 4), covariances and weights."""
    return _people


@pytest.fixture(scope="session")
def merged():
    """Means (N, 4) and covariances (N, 4, 4) of people over their modes of motion."""
    return _merged


@pytest.fixture(scope="session")
def pairs_of():
    """Pairs inside the gates of people and `Measurements`, all or some rows, of one sensor."""
    return _pairs


@pytest.fixture(scope="session")
def corrected():
    """Posterior of each row of means and covariances by the same row of `Measurements`."""
    return _corrected


@pytest.fixture(scope="session")
def machine_code():
    """Lets trackers run as machine code from the first frame on; without numba, as Python."""
    compile_tracker(lambda sentence: None)


@pytest.fixture(scope="session", params=["machine code", "Python"])
def tracker_of(request, machine_code):
    """Makes trackers: once those that run as machine code, once those that run as Python."""
    if request.param == "Python":
        return partial(PersonTracker, compiled=False)
    if machine() is None:
        pytest.skip("numba is not installed, or told not to compile")
    return PersonTracker
