"""How late stamps are is found from people who stand still while the robot turns."""

from dataclasses import replace

import numpy as np
import pytest

from tracker.errors import CalibrationError
from tracker.evaluation.tuning.sighting_sources import STANDING, simulated_sightings
from tracker.evaluation.tuning.stamp_offset import Headings, stamp_offset
from tracker.simulation.scene import Camera

PLACES = np.array([[3.0, 1.0], [-4.0, 0.5], [2.0, -2.0]])


def turning(late_s, seed=1, *, amplitude_rad=0.5, noise_rad=0.01, frames=300):
    """A robot that sways on its place before people who stand still, ten images a second."""
    rng = np.random.default_rng(seed)
    at_s = np.arange(frames) / 10
    yaw, before = (amplitude_rad * np.sin(1.8 * each) for each in (at_s, at_s - late_s))
    row = np.repeat(np.arange(frames), len(PLACES))
    person = np.tile(np.arange(len(PLACES)), frames)
    beside = np.array([0.05, -0.04, 0.0])[person]
    true = np.arctan2(PLACES[person, 1], PLACES[person, 0]) + beside
    heading = true - before[row] + yaw[row] + rng.normal(0.0, noise_rad, len(row))
    stamps_ns = np.round(at_s * 1e9).astype(np.int64)
    places_m = PLACES[person] + rng.normal(0.0, 0.05, (len(row), 2))
    return Headings(
        stamps_ns[row], heading, np.zeros((len(row), 2)), places_m, person, stamps_ns, yaw
    )


@pytest.mark.parametrize("late_s", [0.05, -0.02, 0.0])
def test_a_known_offset_is_found_within_its_uncertainty(late_s):
    found = [stamp_offset(turning(late_s, seed)) for seed in range(20)]
    error = np.array([(each.offset_s - late_s) / each.std_s for each in found])
    assert np.abs(error).max() < 4.0
    assert np.sqrt((error**2).mean()) < 1.7
    assert max(each.std_s for each in found) < 0.005


def test_somebody_who_walks_off_hardly_matters():
    good = turning(0.05)
    off = (good.person == 2) & (good.stamp_ns > 28e9)
    found = stamp_offset(replace(good, heading_rad=good.heading_rad + np.where(off, 0.6, 0.0)))
    assert found.offset_s == pytest.approx(0.05, abs=0.005)


def test_a_robot_that_stands_still_tells_nothing_and_says_what_to_record():
    with pytest.raises(CalibrationError, match="while the robot turns"):
        stamp_offset(turning(0.05, amplitude_rad=0.0))


def test_without_headings_nothing_is_told():
    with pytest.raises(CalibrationError, match="0 headings"):
        stamp_offset(turning(0.05)[:0])


def test_offsets_of_camera_and_laser_are_found_in_a_simulated_room():
    mounted = simulated_sightings(
        Camera(), Camera(), 2, replace(STANDING, duration_s=20.0), late_s=(0.06, -0.03), turns=True
    )
    hands, bodies = stamp_offset(mounted.hand_headings), stamp_offset(mounted.body_headings)
    assert hands.offset_s == pytest.approx(0.06, abs=0.008)
    assert bodies.offset_s == pytest.approx(-0.03, abs=0.008)
