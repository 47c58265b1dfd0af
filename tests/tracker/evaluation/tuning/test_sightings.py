from dataclasses import fields, replace

import numpy as np
import pytest

from tracker import Config, Scan
from tracker.errors import RecordingError
from tracker.evaluation.recordings.recorded_frames import recorded_frames
from tracker.evaluation.tuning.calibration import calibrate
from tracker.evaluation.tuning.sighting_sources import (
    CALLERS,
    recorded_sightings,
    simulated_sightings,
)
from tracker.evaluation.tuning.sightings import Sightings
from tracker.geometry import RigidTransform
from tracker.pipeline import Pipeline
from tracker.recording import RecordingWriter
from tracker.simulation.scene import Camera
from tracker.transforms import StampedTransform

START_NS, PERIOD_NS = 1_700_000_000_000_000_000, 100_000_000
LASER_FROM_CAMERA = RigidTransform.from_planar(-0.1, 0.05, 0.2, z_m=1.0)


@pytest.fixture
def bag(tmp_path, write_bag):
    """Ten images of a robot with somebody 1.5 m ahead of its laser."""
    links = [
        StampedTransform(0, "map", "laser", RigidTransform.from_planar(3.0, 1.0, 2.0), True),
        StampedTransform(0, "laser", "camera_link", LASER_FROM_CAMERA, True),
    ]
    return write_bag(tmp_path / "ahead.mcap", 1.0, links=links)


def test_a_recordings_hands_come_with_the_bodies_beside_their_rays(bag, hand_ahead):
    mounted = recorded_sightings(bag, detector=hand_ahead)
    sightings = mounted.sightings
    assert len(sightings) == 10
    assert sorted(sightings.hand) == list(range(10))
    assert sightings.bearing_rad == pytest.approx(np.zeros(10), abs=1e-9)
    assert np.all(sightings.side == 1.0)  # the thumb is on the head's side
    body = LASER_FROM_CAMERA.inverse().apply([1.56, 0.0, 0.0])[:2]
    assert sightings.body_xy_m == pytest.approx(np.tile(body, (10, 1)), abs=0.02)
    assert mounted.laser_from_camera.planar == pytest.approx(LASER_FROM_CAMERA.planar)


def test_frames_come_while_the_pipeline_stands_at_them(bag, hand_ahead):
    pipeline = Pipeline(Config(), hand_ahead)
    stamps = [
        result.stamp_ns
        for result in recorded_frames(bag, pipeline)
        if pipeline.transforms.can_lookup("map", "camera_link", result.stamp_ns)
    ]
    assert stamps == list(range(START_NS, START_NS + 10 * PERIOD_NS, PERIOD_NS))


def test_a_recording_without_pictures_says_so(tmp_path, hand_ahead):
    path = tmp_path / "empty.mcap"
    with RecordingWriter(path) as writer:
        writer.write("/scan", START_NS, Scan(START_NS, "laser", 0.0, 0.1, 0.1, 9.0, np.ones(60)))
    with pytest.raises(RecordingError, match="no images"):
        list(recorded_frames(path, Pipeline(Config(), hand_ahead)))


def test_a_mounting_that_is_off_is_found_in_a_simulated_room():
    """Ray-cast scans, legs that walk, hands at the end of arms: all but the pictures."""
    believed = Camera()
    true = believed.model_copy(update={"x_m": 0.16, "y_m": -0.08, "yaw_deg": 4.0})
    scenario = replace(CALLERS, duration_s=60.0)
    mounted = simulated_sightings(true, believed, 1, scenario)
    found = calibrate(mounted.sightings)
    error = found.correction - [0.06, -0.08, np.deg2rad(4.0)]
    assert np.all(np.abs(error) < 2.5 * found.std)
    assert found.std[2] < np.deg2rad(2.0)


def test_hands_are_numbered_anew_when_frames_are_joined():
    names = [item.name for item in fields(Sightings)]
    one = Sightings(*(np.zeros((1, 2) if n == "body_xy_m" else 1) for n in names))
    two = replace(one, hand=np.array([1]))
    assert Sightings.concatenate(one, two, one).hand.tolist() == [0, 2, 3]
    assert len(Sightings.concatenate()) == 0
