"""A depth camera in the whole chain: drawn rooms, hands that are told, no models."""

import numpy as np
import pytest

from tracker import CameraImage, Config, Hands, Pipeline
from tracker.camera import CameraModel, DepthCamera
from tracker.containers import DepthImage, Truth
from tracker.errors import TrackerError
from tracker.notes import NoteKind
from tracker.simulation import load_scene, simulate
from tracker.simulation.motion import people_at
from tracker.simulation.projection import Viewpoint
from tracker.simulation.rendering.camera_view import hands_in_view, raised_hand_pixels
from tracker.simulation.scene import Depth
from tracker.simulation.stream import map_from_camera

UNTIL_S = 4.5
FLAT = np.ones((480, 640), np.float32)


class TrueHands:
    """Finds the hands that a scene has up, and their owners' torsos, as a perfect eye would."""

    work = None

    def __init__(self, scene):
        self.scene, self.stamp_ns = scene, 0

    def find(self, image, hints=None):
        time_s = image.stamp_ns / 1e9 - self.scene.start_s
        view = Viewpoint.of(self.scene.camera, map_from_camera(self.scene, time_s))
        people = people_at(self.scene, time_s)
        rows = np.flatnonzero(people.hand_up & hands_in_view(self.scene, view, people))
        if not len(rows):
            return Hands.none()
        landmarks = np.array([raised_hand_pixels(self.scene, view, people, row) for row in rows])
        torso = np.array([self._torso(view, people, row) for row in rows])
        one = np.ones(len(rows))
        return Hands(landmarks, one, one, one.astype(bool), one, torso)

    def _torso(self, view, people, row):
        sunk_m = 0.0 if self.scene.people[row].seat_m is None else 0.4
        return view.pixels(view.forward_left(people.xy_m[row]), 1.15 - sunk_m)

    def reset(self):
        pass

    def configure(self, config):
        pass


@pytest.fixture(scope="module")
def stream():
    """What the restaurant's sensors say in the first seconds, by the kind of depth camera."""
    known = {}

    def of(**depth):
        key = tuple(sorted(depth.items()))
        if key not in known:
            scene = load_scene("restaurant").model_copy(
                update={"depth": Depth(rate_hz=10.0, **depth), "duration_s": UNTIL_S}
            )
            scene = scene.model_copy(
                update={"camera": scene.camera.model_copy(update={"rate_hz": 10.0})}
            )
            known[key] = scene, list(simulate(scene, 1))
        return known[key]

    return of


def play(stream, config, **depth):
    scene, events = stream(**depth)
    pipeline = Pipeline(config, TrueHands(scene))
    results, truth = [], {}
    for log_ns, event in events:
        if isinstance(event, Truth):
            truth[event.stamp_ns] = event
            continue
        pipeline.add(event, log_ns)
        results += [result for _, result in pipeline.advance(log_ns)]
    return results + [result for _, result in pipeline.advance()], truth


def places(results):
    return np.array([r.tracks.mean[r.tracks.raised, :2][0] for r in results if r.hand_raised])


def errors_m(results, truth):
    told = [r for r in results if r.hand_raised]
    return [
        np.linalg.norm(truth[r.stamp_ns].xy_m - place, axis=1).min()
        for r, place in zip(told, places(results), strict=True)
    ]


def test_without_a_lidar_callers_stand_where_they_are(stream):
    results, truth = play(stream, Config(depth_source="depth"))
    assert len(errors_m(results, truth)) > 15
    assert np.median(errors_m(results, truth)) < 0.10
    assert results[-1].customer_pose is not None
    assert results[-1].approach_pose is not None
    assert {len(result.tracks) for result in results if result.hand_raised} == {1}


@pytest.mark.parametrize(
    "depth",
    [{"unit": "m"}, {"registered": False}, {"registered": False, "unit": "m"}],
    ids=["meters", "beside", "beside, meters"],
)
def test_every_kind_of_depth_camera_gives_the_same_places(stream, depth):
    usual, _ = play(stream, Config(depth_source="depth"))
    other, _ = play(stream, Config(depth_source="depth"), **depth)
    apart_m = np.linalg.norm(places(usual)[-10:] - places(other)[-10:], axis=1)
    assert np.median(apart_m) < 0.02


def test_both_sensors_are_no_worse_than_the_better_one(stream):
    medians = {
        source: np.median(errors_m(*play(stream, Config(depth_source=source))))
        for source in ("scan", "depth", "both")
    }
    assert medians["both"] <= min(medians["scan"], medians["depth"]) + 0.02


def test_depth_source_scan_leaves_depth_alone(stream):
    results, _ = play(stream, Config(depth_source="scan"))
    scene, events = stream()
    pipeline = Pipeline(Config(), TrueHands(scene))
    without = []
    for log_ns, event in events:
        if isinstance(event, DepthImage | Truth):
            continue
        pipeline.add(event, log_ns)
        without += [result for _, result in pipeline.advance(log_ns)]
    without += [result for _, result in pipeline.advance()]
    np.testing.assert_array_equal(places(results), places(without))
    assert not any(note.kind.leaves_depth_unused for r in without for note in r.notes)


def dark(stamp_ns, frame="camera_link"):
    return CameraImage(stamp_ns, frame, np.zeros((480, 640, 3), np.uint8))


class NoHands:
    work = None

    def find(self, image, hints=None):
        return Hands.none()

    def reset(self):
        pass

    def configure(self, config):
        pass


def kinds(pipeline, stamp_ns=1_000_000_000):
    (result,) = [pipeline.process(dark(stamp_ns))]
    return {note.kind for note in result.notes}


@pytest.mark.parametrize(
    ("image", "kind"),
    [
        (None, NoteKind.NO_DEPTH),
        (DepthImage.of(9_000_000_000, "", FLAT), NoteKind.DEPTH_TOO_OLD),
        (DepthImage.of(10**9, "", FLAT[:48]), NoteKind.DEPTH_UNREADABLE),
        (DepthImage.of(10**9, "eye", FLAT), NoteKind.DEPTH_NOT_LOCATED),
    ],
    ids=["none", "old", "another shape", "a frame of no transform"],
)  # fmt: skip
def test_depth_that_cannot_be_used_is_told_with_the_reason(image, kind):
    pipeline = Pipeline(Config(depth_source="depth"), NoHands())
    if image is not None:
        pipeline.add(image)
    assert kind in kinds(pipeline)


def test_a_damaged_depth_image_costs_no_image():
    def broken():
        raise TrackerError("the PNG is cut off")

    pipeline = Pipeline(Config(depth_source="depth"), NoHands())
    pipeline.add(DepthImage(10**9, "", broken))
    assert NoteKind.DEPTH_UNREADABLE in kinds(pipeline)


def test_without_transforms_the_depth_camera_is_the_color_camera_s_neighbor():
    pipeline = Pipeline(Config(depth_source="depth"), NoHands())
    pipeline.add(DepthCamera(CameraModel(400.0, 400.0, 320.0, 240.0, width=640, height=480)))
    depth = np.full((480, 640), 5.0, np.float32)
    depth[:, 280:360] = 2.0
    pipeline.add(DepthImage.of(10**9, "camera_link", depth))
    result = pipeline.process(dark(10**9))
    assert len(result.measurements) == 1
    assert result.measurements.values[0, 1] == pytest.approx(2.09, abs=0.05)
    assert result.scan is not None
