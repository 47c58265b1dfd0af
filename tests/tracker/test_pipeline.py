from dataclasses import replace
from functools import partial

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from tracker import CameraImage, Config, Hands, Pipeline, Scan
from tracker.camera import CameraModel
from tracker.containers import Caller, CallState, OccupancyGrid, Refusal, WaitingList
from tracker.errors import ModelFileError
from tracker.geometry import RigidTransform, euler_to_quaternion
from tracker.gesture import Gesture
from tracker.notes import Note, NoteKind
from tracker.simulation.hand_signs import draw_hands
from tracker.transforms import StampedTransform

PERIOD_NS = 100_000_000
IDENTITY = RigidTransform()
START_NS = 10_000_000_000


class SeenHands:
    """A detector that finds what it is told: one raised hand at each pixel."""

    work = None

    def __init__(self, *wrists_px):
        self.wrists_px = wrists_px
        self.resets = 0

    def find(self, image, hints=None):
        if not self.wrists_px:
            return Hands.none()
        landmarks = np.tile(np.array(self.wrists_px, float)[:, None], (1, 21, 1))
        landmarks[:, 12, 1] -= 60.0
        one = np.ones(len(self.wrists_px))
        return Hands(landmarks, one, one, one.astype(bool), one)

    def reset(self):
        self.resets += 1

    def configure(self, config):
        pass


def image_at(stamp_ns):
    return CameraImage(stamp_ns, "camera_link", np.zeros((480, 640, 3), np.uint8))


def person_scan(stamp_ns, x=2.0, y=0.0, radius=0.2):
    """A 0..2 pi scan by a laser at the origin: somebody at (x, y), a round wall at 6 m."""
    angles = np.radians(np.arange(720) / 2)
    along = x * np.cos(angles) + y * np.sin(angles)
    across = -x * np.sin(angles) + y * np.cos(angles)
    hit = (np.abs(across) < radius) & (along > 0)
    depth = along - np.sqrt(np.maximum(radius**2 - across**2, 0.0))
    return Scan(stamp_ns, "laser", 0.0, np.radians(0.5), 0.05, 12.0, np.where(hit, depth, 6.0))


def static(parent, child, transform=IDENTITY):
    return StampedTransform(0, parent, child, transform, is_static=True)


@pytest.fixture
def located():
    """A pipeline whose camera and laser stand at the map's origin, with a hand straight ahead."""
    pipeline = Pipeline(Config(), SeenHands((320, 100)))
    pipeline.add_transform(static("map", "camera_link"))
    pipeline.add_transform(static("map", "laser"))
    return pipeline


def play(pipeline, frames, start_ns=START_NS, scan=person_scan):
    results = []
    for number in range(frames):
        stamp_ns = start_ns + number * PERIOD_NS
        if scan is not None:
            pipeline.add_scan(scan(stamp_ns))
        pipeline.add_image(image_at(stamp_ns))
        results += [result for _, result in pipeline.advance(stamp_ns)]
    return results


def test_a_raised_hand_gives_the_person_s_pose_in_the_map(located):
    results = play(located, 4)
    assert [result.hand_raised for result in results] == [False, True, True, True]
    pose = results[-1].customer_pose
    assert pose.frame_id == "map"
    assert pose.stamp_ns == results[-1].stamp_ns
    assert pose.position_m == pytest.approx((2.0, 0.0, 0.0), abs=0.15)
    assert results[-1].approach_pose.position_m[0] == pytest.approx(
        pose.position_m[0] - 0.8, abs=1e-6
    )
    assert results[0].customer_pose is None


def test_a_turning_robot_sees_a_standing_person_stand():
    pipeline = Pipeline(Config(), SeenHands((320, 100)))
    pipeline.add_transform(static("base_link", "camera_link"))
    pipeline.add_transform(static("map", "laser"))
    for number in range(-5, 20):
        stamp_ns = START_NS + number * PERIOD_NS // 5
        yaw = 0.5 * number / 50
        pose = RigidTransform((0, 0, 0), euler_to_quaternion(0, 0, yaw))
        pipeline.add_transform(StampedTransform(stamp_ns, "map", "base_link", pose))
    detector = pipeline.detector
    for number in range(4):
        yaw = 0.5 * number / 10
        detector.wrists_px = ((320 + 460 * np.tan(yaw), 100),)
        result = play(pipeline, 1, START_NS + number * PERIOD_NS)[0]
    assert result.tracks.mean[0, :2] == pytest.approx([2.0, 0.0], abs=0.15)
    assert len(result.tracks) == 1


@pytest.mark.parametrize("late_s", [0.06, -0.06])
def test_sensors_whose_stamps_are_late_or_early_are_looked_up_when_they_looked(late_s):
    """The robot turns by 1 rad/s on its place, before somebody 3 m away who stands still."""

    def seen(config):
        pipeline, turn = Pipeline(config, SeenHands((320, 100))), 1.0
        pipeline.add_transform(static("base_link", "camera_link"))
        pipeline.add_transform(static("base_link", "laser"))
        for number in range(-30, 61):
            pose = RigidTransform.from_planar(0.0, 0.0, turn * number / 50 - 0.3)
            stamp_ns = START_NS + number * PERIOD_NS // 5
            pipeline.add_transform(StampedTransform(stamp_ns, "map", "base_link", pose))
        for number in range(8):
            yaw = turn * (number / 10 - late_s) - 0.3
            pipeline.detector.wrists_px = ((320 + 460 * np.tan(yaw), 100),)
            scan = partial(person_scan, x=3.0 * np.cos(yaw), y=-3.0 * np.sin(yaw))
            result = play(pipeline, 1, START_NS + number * PERIOD_NS, scan)[0]
        return result

    ideal = Config(camera_stamp_offset_s=late_s, scan_stamp_offset_s=late_s)
    aware, naive = seen(ideal), seen(Config())
    assert aware.tracks.mean[0, 1] == pytest.approx(0.0, abs=0.03)
    assert abs(naive.tracks.mean[0, 1]) > 0.1
    # What 20 ms make of 1 rad/s at 3 m is in the published covariance.
    sure = seen(ideal.replace(stamp_std_s=0.0))
    wider = (aware.tracks.covariance - sure.tracks.covariance)[0]
    assert np.sqrt(wider[1, 1]) == pytest.approx(0.02 * 3.0, rel=0.15)
    assert aware.measurements.sensor_pose_covariance[0, 2, 2] == pytest.approx(0.02**2)


def test_hand_raised_needs_no_lidar_and_gives_no_pose_then(located):
    result = play(located, 4, scan=None)[-1]
    assert result.hand_raised
    assert result.customer_pose is None
    assert result.notes == (Note(NoteKind.NO_SCAN, "no scan was received"),)


def test_an_old_scan_is_not_used(located):
    located.add_scan(person_scan(START_NS - 2_000_000_000))
    result = play(located, 2, scan=None)[-1]
    assert result.scan is None
    assert result.notes[0].text.startswith("no scan within 0.25 s")


def test_a_scan_without_beams_is_noted(located):
    empty = lambda stamp: Scan(stamp, "laser", 0.0, 0.0, 0.1, 10.0, np.zeros(0))  # noqa: E731
    result = play(located, 2, scan=empty)[-1]
    assert [note.kind for note in result.notes] == [NoteKind.SCAN_WITHOUT_BEAMS]


def test_without_transforms_hands_are_still_reported_and_no_pose_is_given():
    pipeline = Pipeline(Config(), SeenHands((320, 100)))
    results = play(pipeline, 8)
    assert results[-1].hand_raised
    assert all(result.customer_pose is None for result in results)
    assert "no transform names the frame" in results[-1].notes[0].text.lower()


@pytest.mark.parametrize(
    ("config", "frame_id"),
    [
        (Config(), "camera_link"),
        (Config(camera_frame="head_cam"), "head_cam"),
        (Config(camera_frame="head_optical_frame"), None),
        (Config(camera_axes="optical"), None),
        (Config(camera_frame="head_optical_frame", camera_axes="body"), "head_optical_frame"),
        (Config(fixed_frame="camera_link"), "camera_link"),
    ],
    ids=["default", "named", "optical name", "optical axes", "body axes", "fixed camera"],
)
def test_before_any_transform_tracks_are_in_the_cameras_frame_or_in_none(config, frame_id):
    config = config.replace(transform_wait_s=0.0)
    results = play(Pipeline(config, SeenHands((320, 100))), 4)
    assert [result.frame_id for result in results] == [frame_id] * 4
    assert results[-1].hand_raised


def drive(speed_mps, located_frames, frames=30):
    """A robot drives towards somebody at x = 4 m; some images come without a transform."""
    pipeline = Pipeline(Config(transform_wait_s=0.0), SeenHands((320, 100)))
    for child in ("camera_link", "laser"):
        pipeline.add_transform(static("base_link", child))
    for number in range(frames):
        stamp_ns = START_NS + number * PERIOD_NS
        x_m = speed_mps * number * PERIOD_NS / 1e9
        pipeline.add_scan(person_scan(stamp_ns, x=4.0 - x_m))
        if number in located_frames:
            at = RigidTransform((x_m, 0.0, 0.0))
            pipeline.add_transform(StampedTransform(stamp_ns, "map", "base_link", at))
        yield pipeline.process(image_at(stamp_ns))


LOST = range(12, 20)


@pytest.mark.parametrize("speed_mps", [0.0, 0.25, 0.5, -0.5])
def test_no_place_is_given_without_the_transform_and_an_honest_one_after_it(speed_mps):
    whole = list(drive(speed_mps, range(30)))
    results = list(drive(speed_mps, set(range(30)) - set(LOST)))
    for number, result in enumerate(results[2:], 2):
        assert result.hand_raised
        assert result.tracks.id.tolist() == [1], number
        assert result.frame_id == (None if number in LOST else "map")
        if result.frame_id is not None:
            off_m = result.tracks.mean[0, :2] - whole[number].tracks.mean[0, :2]
            covariance = result.tracks.covariance[0, :2, :2]
            assert off_m @ np.linalg.solve(covariance, off_m) < 5.99, f"{number}: {off_m} m"
    assert np.hypot(*off_m) < 0.05


def test_a_robot_that_stood_still_without_transforms_loses_no_certainty():
    whole = list(drive(0.0, range(30)))[-1].tracks
    gap = list(drive(0.0, set(range(30)) - set(LOST)))[-1].tracks
    assert gap.covariance[0] == pytest.approx(whole.covariance[0], rel=0.02, abs=1e-6)


def test_an_image_waits_for_the_transform_of_its_stamp():
    pipeline = Pipeline(Config(transform_wait_s=0.2), SeenHands())
    moved = RigidTransform((1.0, 0.0, 0.0))
    pipeline.add_transform(StampedTransform(START_NS - PERIOD_NS, "map", "camera_link", moved))
    pipeline.add_image(image_at(START_NS))
    assert list(pipeline.advance(START_NS)) == []
    assert list(pipeline.advance(START_NS + PERIOD_NS)) == []
    pipeline.add_transform(StampedTransform(START_NS + PERIOD_NS, "map", "camera_link", moved))
    ((_, result),) = pipeline.advance(START_NS + PERIOD_NS)
    assert result.sensor_pose == pytest.approx([1.0, 0.0, 0.0])


def test_an_image_does_not_wait_for_ever():
    pipeline = Pipeline(Config(transform_wait_s=0.2), SeenHands())
    pipeline.add_image(image_at(START_NS))
    assert list(pipeline.advance(START_NS + PERIOD_NS)) == []
    assert len(list(pipeline.advance(START_NS + 2 * PERIOD_NS))) == 1


def test_a_late_map_frame_begins_the_tracks_anew_in_the_map():
    pipeline = Pipeline(Config(transform_wait_s=0.0), SeenHands((320, 100)))
    pipeline.add_transform(static("base_link", "camera_link"))
    pipeline.add_transform(static("base_link", "laser"))
    early = play(pipeline, 4)[-1]
    assert early.tracks.mean[0, :2] == pytest.approx([2.0, 0.0], abs=0.15)
    pipeline.add_transform(static("map", "base_link", RigidTransform.from_planar(5.0, 1.0, 0.0)))
    late = play(pipeline, 3, START_NS + 4 * PERIOD_NS)
    assert NoteKind.NEW_FIXED_FRAME in [note.kind for note in late[0].notes]
    assert late[-1].customer_pose.position_m == pytest.approx((7.0, 1.0, 0.0), abs=0.15)


def test_a_looped_recording_resets_and_goes_on(located):
    play(located, 5, START_NS + 10**10)
    results = play(located, 4)
    assert results[0].notes[0].kind is NoteKind.CLOCK_JUMPED
    assert located.detector.resets == 1
    assert not results[0].hand_raised
    assert results[-1].hand_raised
    assert results[-1].tracks.id.tolist() == [2]


def test_camera_info_replaces_the_configured_intrinsics(located):
    located.set_camera(CameraModel(230.0, 230.0, 160.0, 120.0))
    result = play(located, 1, scan=None)[0]
    # (320 - 160) / 230 to the right.
    assert result.measurements.values[0, 0] == pytest.approx(-np.arctan(160 / 230))


def test_camera_info_can_be_refused():
    pipeline = Pipeline(Config(use_camera_info=False), SeenHands((320, 100)))
    pipeline.set_camera(CameraModel(230.0, 230.0, 160.0, 120.0))
    assert pipeline.camera.fx == 460.0


def test_30_images_a_second_are_processed_at_10_hertz(located):
    results = []
    for number in range(90):
        stamp_ns = START_NS + number * 1_000_000_000 // 30
        located.add_image(image_at(stamp_ns))
        results += list(located.advance(stamp_ns))
    assert len(results) == 30


def test_changed_parameters_keep_the_tracks(located):
    play(located, 4)
    located.configure(Config(approach_distance_m=1.5))
    result = play(located, 1, START_NS + 4 * PERIOD_NS)[0]
    assert result.tracks.id.tolist() == [1]
    assert result.approach_pose.position_m[0] == pytest.approx(0.5, abs=0.15)


def test_parameters_that_the_detector_cannot_take_change_nothing(located, monkeypatch):
    def refuse(config):
        raise ModelFileError("no such file")

    monkeypatch.setattr(located.detector, "configure", refuse)
    before = located.config
    with pytest.raises(ModelFileError):
        located.configure(Config(processing_rate=5.0))
    assert located.config is before
    assert located.tracker.config is before


def test_algorithm_2_the_scan_nearest_to_the_image_is_the_one_that_counts(located):
    for offset, x in [(-2, 3.0), (-1, 2.5), (0, 2.0)]:
        located.add_scan(person_scan(START_NS + offset * PERIOD_NS, x))
    result = located.process(image_at(START_NS + PERIOD_NS // 10))
    assert result.scan.stamp_ns == START_NS


@pytest.mark.parametrize(("convention", "side"), [("spec", 1.0), ("rep103", -1.0)])
def test_algorithm_4_gives_the_specification_s_pose_of_a_pixel(convention, side):
    # Pixel 540 of a 640 wide image, fx 460, everything 3 m away: arctan(220 / 460) = 25.5600
    # degrees, 3 cos = 2.70640 m, 3 sin = 1.29437 m. The original counts right as positive.
    config = Config(ranging="spec", bearing_convention=convention)
    pipeline = Pipeline(config, SeenHands((540, 100)))
    pipeline.add_transform(static("map", "camera_link"))
    pipeline.add_transform(static("map", "laser"))

    def round_room(stamp_ns):
        ranges = np.full(720, 3.0)
        return Scan(stamp_ns, "laser", -np.pi, np.radians(0.5), 0.05, 12.0, ranges)

    pose = play(pipeline, 3, scan=round_room)[-1].customer_pose
    assert pose.position_m == pytest.approx((2.70640, side * 1.29437, 0.0), abs=1e-4)
    yaw = np.radians(side * 25.5600 + 180.0)
    expected = Rotation.from_euler("z", yaw)
    turned = expected.inv() * Rotation.from_quat(pose.quaternion_xyzw)
    assert turned.magnitude() == pytest.approx(0.0, abs=1e-4)


def circles_scan(stamp_ns, *centers, radius=0.07):
    """As `person_scan`, with several thin things."""
    scans = [person_scan(stamp_ns, x, y, radius).ranges_m for x, y in centers]
    one = person_scan(stamp_ns)
    return Scan(stamp_ns, "laser", 0.0, one.angle_increment_rad, 0.05, 12.0, np.min(scans, axis=0))


def test_the_camera_s_field_of_view_decides_who_is_missed_without_a_scan(located):
    play(located, 6)
    located.detector.wrists_px = ()
    assert len(play(located, 19, START_NS + 6 * PERIOD_NS, scan=None)[-1].tracks) == 1
    in_view = play(located, 30, START_NS + 25 * PERIOD_NS, scan=None)[-1]
    assert len(in_view.tracks) == 0


def test_who_is_behind_the_camera_stays_without_a_scan(located):
    play(located, 6)
    located.detector.wrists_px = ()
    turned = RigidTransform((0, 0, 0), euler_to_quaternion(0, 0, np.pi))
    located.add_transform(static("map", "camera_link", turned))
    assert len(play(located, 100, START_NS + 6 * PERIOD_NS, scan=None)[-1].tracks) == 1


def test_furniture_is_learnt_and_forgotten_on_reset():
    config = Config(background_after_s=2.0)
    pipeline = Pipeline(config, SeenHands())
    pipeline.add_transform(static("map", "camera_link"))
    pipeline.add_transform(static("map", "laser"))
    room = lambda stamp: circles_scan(stamp, (2.0, 1.0))  # noqa: E731
    results = play(pipeline, 30, scan=room)
    assert [len(result.measurements) for result in (results[0], results[-1])] == [1, 0]
    pipeline.reset()
    pipeline.add_transform(static("map", "camera_link"))
    pipeline.add_transform(static("map", "laser"))
    assert len(play(pipeline, 1, START_NS + 30 * PERIOD_NS, scan=room)[-1].measurements) == 1


def test_furniture_is_not_learnt_where_that_is_switched_off():
    pipeline = Pipeline(Config(background_after_s=0.0), SeenHands())
    pipeline.add_transform(static("map", "camera_link"))
    pipeline.add_transform(static("map", "laser"))
    room = lambda stamp: circles_scan(stamp, (2.0, 1.0))  # noqa: E731
    assert len(play(pipeline, 400, scan=room)[-1].measurements) == 1


def map_with_post(x, y, frame_id="map"):
    """4 m x 4 m around the origin in cells of 5 cm, one of them occupied."""
    cells = np.zeros((160, 160), np.int8)
    cells[int((y + 4.0) / 0.05), int((x + 4.0) / 0.05)] = 100
    return OccupancyGrid(0, frame_id, 0.05, (-4.0, -4.0, 0.0), cells)


def people_beside(pipeline, stamp_ns=START_NS):
    """How many the scan shows beside the hands, of a post of 12 cm at (2, .5)."""
    pipeline.add_scan(person_scan(stamp_ns, y=0.5, radius=0.06))
    result = pipeline.process(image_at(stamp_ns))
    return len(result.measurements), [note.kind for note in result.notes]


def pipeline_at_origin(config=None):
    pipeline = Pipeline(config or Config(), SeenHands())
    for child in ("camera_link", "laser"):
        pipeline.add_transform(static("map", child))
    return pipeline


def test_what_stands_on_an_occupied_cell_of_the_map_is_nobody():
    pipeline = pipeline_at_origin()
    assert people_beside(pipeline)[0] == 1
    pipeline.add(map_with_post(2.0, 0.5))
    assert people_beside(pipeline, START_NS + PERIOD_NS) == (0, [])
    pipeline.add(map_with_post(1.0, 0.5))  # a newer map in its place
    assert people_beside(pipeline, START_NS + 2 * PERIOD_NS) == (1, [])


def test_the_map_stays_when_everything_else_is_forgotten():
    pipeline = pipeline_at_origin()
    pipeline.add(map_with_post(2.0, 0.5))
    pipeline.reset()
    assert people_beside(pipeline)[0] == 0


def test_a_map_that_is_not_wanted_changes_nothing():
    pipeline = pipeline_at_origin(Config(use_map=False))
    pipeline.add(map_with_post(2.0, 0.5))
    assert people_beside(pipeline)[0] == 1


def test_a_map_of_another_frame_is_placed_by_its_transform_and_missed_without():
    pipeline = pipeline_at_origin()
    pipeline.add(map_with_post(1.0, -0.5, frame_id="/floor"))
    assert people_beside(pipeline) == (1, [NoteKind.MAP_NOT_LOCATED])
    pipeline.add_transform(static("floor", "map", RigidTransform((-1.0, -1.0, 0.0))))
    assert people_beside(pipeline, START_NS + PERIOD_NS) == (0, [])


def test_a_customer_who_stands_still_with_the_hand_down_is_no_furniture():
    pipeline = Pipeline(Config(background_after_s=2.0), SeenHands((320, 100)))
    pipeline.add_transform(static("map", "camera_link"))
    pipeline.add_transform(static("map", "laser"))
    stand = lambda stamp: circles_scan(stamp, (2.0, 0.1))  # noqa: E731
    play(pipeline, 5, scan=stand)
    pipeline.detector.wrists_px = ()
    last = play(pipeline, 60, START_NS + 5 * PERIOD_NS, scan=stand)[-1]
    assert len(last.tracks) == 1
    assert len(last.measurements) == 1
    assert last.tracks.unseen_s[0] == 0.0


def rolled(roll_deg):
    return RigidTransform(quaternion_xyzw=euler_to_quaternion(np.radians(roll_deg), 0.0, 0.0))


class SeenUpright(SeenHands):
    """Finds a raised hand so many pixels to the right of an upright picture's middle."""

    def find(self, image, hints=None):
        self.size = (image.width, image.height)
        self.wrists_px = (((image.width - 1) / 2 + 92.0, (image.height - 1) / 2),)
        return super().find(image)


CENTERED = CameraModel(460.0, 460.0, 319.5, 239.5)


@pytest.mark.parametrize("convention", ["rep103", "spec"])
@pytest.mark.parametrize("roll_deg", [0.0, 90.0, -90.0, 180.0, 45.0, -160.0])
def test_a_rolled_camera_gives_the_bearing_of_the_hand_in_the_upright_picture(
    roll_deg, convention
):
    pipeline = Pipeline(Config(bearing_convention=convention), SeenUpright())
    pipeline.set_camera(CENTERED)
    pipeline.add_transform(static("map", "camera_link", rolled(roll_deg)))
    (result,) = play(pipeline, 1, scan=None)
    to_the_right = -1.0 if convention == "rep103" else 1.0
    assert result.measurements.values[:, 0] == pytest.approx([to_the_right * np.arctan(0.2)])
    assert result.sensor_pose == pytest.approx([0.0, 0.0, 0.0], abs=1e-9)


def test_a_camera_on_its_side_is_searched_in_a_picture_that_stands():
    pipeline = Pipeline(Config(), SeenUpright())
    pipeline.add_transform(static("map", "camera_link", rolled(90.0)))
    (result,) = play(pipeline, 1, scan=None)
    assert pipeline.detector.size == (480, 640)
    fingers_px = result.hands.landmarks_px[0, 12] - result.hands.wrist_px[0]
    assert fingers_px == pytest.approx([-60.0, 0.0])  # up is to the left in the camera's picture


@pytest.mark.parametrize("convention", ["rep103", "spec"])
def test_a_roll_that_no_transform_tells_is_a_parameter(convention):
    config = Config(camera_roll_deg=-90.0, bearing_convention=convention, transform_wait_s=0.0)
    pipeline = Pipeline(config, SeenUpright())
    pipeline.set_camera(CENTERED)
    (result,) = play(pipeline, 1, scan=None)
    assert pipeline.detector.size == (480, 640)
    to_the_right = -1.0 if convention == "rep103" else 1.0
    assert result.measurements.values[:, 0] == pytest.approx([to_the_right * np.arctan(0.2)])


def test_hands_are_followed_anew_only_where_the_upright_turn_changes():
    pipeline = Pipeline(Config(), SeenUpright())
    rolls_deg = [0.0, 2.0, 5.0, 8.0, 5.0, 40.0, 42.0, 44.0, 41.0, 88.0, 90.0]
    for number, roll_deg in enumerate(rolls_deg):
        stamp_ns = START_NS + number * PERIOD_NS
        pipeline.add_transform(StampedTransform(stamp_ns, "map", "camera_link", rolled(roll_deg)))
    play(pipeline, len(rolls_deg), scan=None)
    assert pipeline.detector.resets == 2  # for the turns by 40 and by 90 degrees


@pytest.mark.parametrize("roll_deg", [0.0, 90.0, 180.0])
def test_the_view_of_a_rolled_camera_is_that_of_its_upright_picture(roll_deg, monkeypatch):
    pipeline = Pipeline(Config(), SeenHands())
    pipeline.set_camera(CENTERED)
    pipeline.add_transform(static("map", "camera_link", rolled(roll_deg)))
    views, step = [], pipeline.tracker.step

    def step_and_tell(*words, view, **others):
        views.append(view)
        return step(*words, view=view, **others)

    monkeypatch.setattr(pipeline.tracker, "step", step_and_tell)
    play(pipeline, 1, scan=None)
    half_px = 240.0 if roll_deg == 90.0 else 320.0
    assert views[0].horizontal_fov_rad == pytest.approx(2 * np.arctan(half_px / 460.0), abs=1e-3)


def test_a_picture_of_another_size_gets_intrinsics_of_its_size():
    pipeline = Pipeline(Config(), SeenHands((1180, 400)))
    image = CameraImage(START_NS, "camera_link", np.zeros((960, 1280, 3), np.uint8))
    result = pipeline.process(image)
    # (1180 - 640) / 920 to the right.
    assert result.hands.wrist_px[0].tolist() == [1180, 400]
    assert result.measurements.values[0, 0] == pytest.approx(-np.arctan(540 / 920))
    assert NoteKind.INTRINSICS_SCALED in [note.kind for note in result.notes]


def test_a_hand_beyond_the_lens_s_range_is_told_and_nobody_is_invented():
    pipeline = Pipeline(Config(), SeenHands((10, 200)))
    lens = (-0.5, 0.1, 0.0, 0.0)
    pipeline.set_camera(CameraModel(300.0, 300.0, 320.0, 240.0, lens, "plumb_bob", 640, 480))
    for number in range(4):
        image = CameraImage(
            START_NS + number * 10**8, "camera_link", np.zeros((480, 640, 3), np.uint8)
        )
        result = pipeline.process(image)
    assert NoteKind.HAND_BEYOND_LENS in [note.kind for note in result.notes]
    assert len(result.tracks) == 0


def test_a_remark_about_an_image_becomes_a_note():
    image = CameraImage(START_NS, "camera_link", np.zeros((480, 640, 3), np.uint8), "a guess")
    result = Pipeline(Config(), SeenHands((320, 100))).process(image)
    assert "a guess" in [note.text for note in result.notes]


def test_a_laser_of_unknown_mounting_is_level_beside_a_camera_that_hangs_upside_down():
    config = Config(camera_roll_deg=180.0, transform_wait_s=0.0)
    pipeline = Pipeline(config, SeenHands())
    (result,) = play(pipeline, 1, scan=lambda stamp_ns: person_scan(stamp_ns, 2.0, 1.0))
    assert result.measurements.values[:, 0] == pytest.approx([np.arctan2(1.0, 2.0)], abs=0.05)
    assert result.frame_id is None  # the camera's own frame is upside down


@pytest.mark.parametrize(
    "roll_pitch", [(np.pi, 0.0), (0.0, np.pi)], ids=["rolled by a half turn", "pitched by one"]
)
def test_a_scanner_upside_down_shows_people_on_their_own_side(roll_pitch):
    pipeline = Pipeline(Config(), SeenHands((320 - 460 * 0.3, 100)))
    pipeline.add_transform(static("map", "camera_link"))
    hung = RigidTransform((0.0, 0.0, 1.0), euler_to_quaternion(*roll_pitch, 0.4))
    pipeline.add_transform(static("map", "laser", hung))
    x, y, _ = hung.inverse().rotate([2.0, 0.6, 0.0])  # somebody at (2, 0.6), as the laser has it
    result = play(pipeline, 4, scan=lambda stamp_ns: person_scan(stamp_ns, x, y))[-1]
    assert result.tracks.mean[0, :2] == pytest.approx([2.0, 0.6], abs=0.12)
    assert len(result.measurements) == 1


def test_beams_are_turned_by_the_robot_s_motion_within_the_scan():
    """The robot turns by 2 rad/s; the scan takes 0.1 s and passes the person in its middle."""
    rate_radps, increment_s = 2.0, 0.1 / 720
    pipeline = Pipeline(Config(), SeenHands())
    pipeline.add_transform(static("map", "camera_link"))
    for number in range(-1, 20):
        stamp_ns = START_NS + number * PERIOD_NS // 2
        pose = RigidTransform(
            quaternion_xyzw=euler_to_quaternion(0, 0, rate_radps * 0.05 * number)
        )
        pipeline.add_transform(StampedTransform(stamp_ns, "map", "laser", pose))
    half_turn = rate_radps * 0.05  # when the scan is half done
    x, y = 2.0 * np.cos(np.pi), 2.0 * np.sin(np.pi)
    seen = person_scan(START_NS, x, y)
    scan = replace(seen, time_increment_s=increment_s)
    for each, heading in ((seen, np.pi), (scan, np.pi + half_turn)):
        pipeline.room.forget_scans_after(0)
        pipeline.add_scan(each)
        located = pipeline.process(image_at(START_NS)).scan
        nearest = located.xy_m[np.nanargmin(located.range_m)]
        assert np.hypot(*(nearest - 1.8 * np.array([np.cos(heading), np.sin(heading)]))) < 0.03


def test_a_scanner_of_millimeters_is_used_and_said(located):
    def in_millimeters(stamp_ns):
        scan = person_scan(stamp_ns)
        return replace(scan, ranges_m=1000 * scan.ranges_m, range_max_m=12_000.0)

    results = play(located, 4, scan=in_millimeters)
    assert results[-1].customer_pose.position_m == pytest.approx((2.0, 0.0, 0.0), abs=0.15)
    assert {note.kind for note in results[-1].notes} == {NoteKind.SCAN_IN_MILLIMETERS}


@pytest.mark.parametrize("roll_deg", [90.0, -90.0])
def test_a_scanner_on_its_side_is_not_used_and_said(located, roll_deg):
    located.add_transform(static("map", "laser", rolled(roll_deg)))
    result = play(located, 1)[0]
    assert result.scan is None
    assert NoteKind.SCAN_TOO_STEEP in [note.kind for note in result.notes]


def test_a_scan_that_ends_on_the_floor_is_said(located):
    down = RigidTransform((0.0, 0.0, 0.3), euler_to_quaternion(0.0, np.radians(40.0), 0.0))
    located.add_transform(static("map", "laser", down))

    def ahead(stamp_ns):
        return Scan(stamp_ns, "laser", -0.1, 0.01, 0.1, 12.0, np.full(21, 0.46))

    result = play(located, 1, scan=ahead)[0]
    assert NoteKind.SCAN_WITHOUT_RETURNS in [note.kind for note in result.notes]


def test_pictures_of_another_size_are_told(located):
    results = []
    for number, side in enumerate((480, 480, 240, 240)):
        picture = np.zeros((side, side * 4 // 3, 3), np.uint8)
        results.append(
            located.process(CameraImage(START_NS + number * PERIOD_NS, "camera_link", picture))
        )
    changed = [NoteKind.PICTURE_SIZE_CHANGED in [n.kind for n in r.notes] for r in results]
    assert changed == [False, False, True, False]


def test_a_kept_waiting_list_goes_on_once_the_camera_is_located():
    kept = WaitingList(
        0,
        (
            Caller(
                id=5, state=CallState.WAITING, called_ns=0, state_since_ns=0, raised_since_ns=0,
                last_up_ns=10**9, is_up=False, xy_m=(2.0, 0.0), covariance_m2=(0.01, 0.0, 0.01),
                seen_ns=0,
            ),
        ),
    )  # fmt: skip
    pipeline = Pipeline(Config(), SeenHands((320, 100)))
    pipeline.restore(kept)
    assert pipeline.process(image_at(START_NS)).waiting_list.find(5) is None
    pipeline.add_transform(static("map", "camera_link"))
    pipeline.add_transform(static("map", "laser"))
    last = play(pipeline, 4, START_NS + PERIOD_NS)[-1]
    assert [caller.id for caller in last.waiting_list.callers] == [5]
    assert last.waiting_list.find(5).track_id == last.tracks.id[0]


def test_calls_outlive_a_camera_that_pauses_for_minutes(located):
    play(located, 10)
    located.detector.wrists_px = ()
    play(located, 5, START_NS + 10 * PERIOD_NS)
    later = play(located, 3, START_NS + 200_000_000_000, scan=None)[-1]
    assert len(later.tracks) == 0
    assert [caller.id for caller in later.waiting_list.waiting] == [1]


class SignedHand(SeenHands):
    """One raised hand that shows a sign, drawn 150 px long."""

    def __init__(self, sign):
        super().__init__((320, 200))
        self.sign = sign

    def find(self, image, hints=None):
        drawn = draw_hands(
            self.sign, 4, np.random.default_rng(5), turn_max_deg=3.0,
            size_px=(150.0, 150.1), noise=(0.005, 0.006),
        )  # fmt: skip
        row = 0 if self.sign != "thumb" else int(np.argmax(drawn.gesture == Gesture.THUMB_UP))
        points = drawn.landmarks_px[[row]] + self.wrists_px[0]
        one = np.ones(1)
        return Hands(points, one, drawn.is_right[[row]], one.astype(bool), one)


def signing(sign, **changes):
    pipeline = Pipeline(Config(**changes), SignedHand(sign))
    pipeline.add_transform(static("map", "camera_link"))
    pipeline.add_transform(static("map", "laser"))
    return pipeline


def test_a_customer_says_what_the_hand_shows():
    result = play(signing("fist"), 5)[-1]
    assert result.tracks.gesture.tolist() == [Gesture.FIST]
    assert result.hand_raised


def test_a_sign_that_does_not_call_is_nobody():
    results = play(signing("fist", gesture_call="palm, wave"), 10)
    assert not results[-1].hand_raised
    assert results[-1].hands.refusal.tolist() == [Refusal.OTHER_SIGN]


def test_a_thumb_lets_the_served_customer_go():
    pipeline = signing("palm", gesture_release="thumb_up")
    served = play(pipeline, 5)[-1].tracks.selected_id
    assert served is not None
    pipeline.detector.sign = "thumb"
    results = play(pipeline, 10, START_NS + 5 * PERIOD_NS)
    assert results[0].tracks.selected_id == served
    assert results[-1].tracks.gesture.tolist() == [Gesture.THUMB_UP]
    assert results[-1].tracks.selected_id is None, "and is not chosen again while the hand is up"


def test_a_gesture_lets_nobody_go_unless_that_is_wanted():
    assert play(signing("thumb"), 10)[-1].tracks.selected_id is not None
