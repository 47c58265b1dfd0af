import csv
import dataclasses
import json
from pathlib import Path

import cv2
import numpy as np
import pytest

from tracker import CameraImage, Config, Scan
from tracker.camera import CameraModel
from tracker.containers import OccupancyGrid
from tracker.errors import ConfigError, RecordingError
from tracker.geometry import RigidTransform
from tracker.messages import CameraInfo
from tracker.outputs import FolderLock
from tracker.recording import RecordingWriter, open_recording
from tracker.replay import replay
from tracker.simulation import topic_of
from tracker.transforms import StampedTransform

AT_ORIGIN = tuple(
    StampedTransform(0, "map", frame, RigidTransform(), is_static=True)
    for frame in ("camera_link", "laser")
)
DATA = Path(__file__).parents[3] / "../shared/data"
START_NS = 1_700_000_000_000_000_000
SECOND_NS = 1_000_000_000


def read_topics(path):
    from rosbags.highlevel import AnyReader
    from rosbags.typesys import Stores, get_typestore

    store = get_typestore(Stores.ROS2_JAZZY)
    with AnyReader([path], default_typestore=store) as reader:
        for connection, log_ns, raw in reader.messages():
            yield connection.topic, log_ns, reader.deserialize(raw, connection.msgtype)


def read_table(path):
    return list(csv.DictReader(path.read_text().splitlines()))


def test_a_replay_leaves_a_recording_a_table_a_summary_a_picture_and_a_video(
    tmp_path, write_bag, hand_ahead
):
    bag = write_bag(tmp_path / "in.mcap")
    result = replay(bag, tmp_path / "out", detector=hand_ahead)
    assert result.problems == ()
    names = {path.name for path in result.files}
    assert names == {"output.mcap", "tracks.csv", "debug.mp4", "summary.json", "overview.png"}
    assert all(path.stat().st_size > 0 for path in result.files)

    rows = read_table(tmp_path / "out/tracks.csv")
    assert list(rows[0]) == [
        "stamp_s", "track_id", "x_m", "y_m", "vx_mps", "vy_mps",
        "var_x", "var_xy", "var_y", "existence", "raised", "selected",
    ]  # fmt: skip
    assert len(rows) == 19  # confirmed with the second of 20 images
    assert float(rows[-1]["x_m"]) == pytest.approx(1.5, abs=0.1)
    assert rows[-1]["raised"] == rows[-1]["selected"] == "1"

    summary = json.loads((tmp_path / "out/summary.json").read_text())
    assert summary["problems"] == []
    assert cv2.imread(str(tmp_path / "out/overview.png")) is not None
    video = cv2.VideoCapture(str(tmp_path / "out/debug.mp4"))
    assert sum(1 for _ in iter(lambda: video.read()[0], False)) == 20


def map_of(cells):
    return OccupancyGrid(START_NS, "map", 0.5, (-5.0, -5.0, 0.0), np.array(cells, np.int8))


def test_a_map_comes_from_the_recording_or_from_the_user_who_wins(tmp_path, write_bag, hand_ahead):
    free, taken = map_of(np.zeros((20, 20))), map_of(np.full((20, 20), 100))
    seen = write_bag(tmp_path / "seen.mcap", 1.0)
    with RecordingWriter(tmp_path / "in.mcap") as writer, open_recording(seen) as recording:
        writer.write("/map", START_NS, free)
        for log_ns, event in recording.events():
            writer.write(topic_of(event), log_ns, event)
    for own, expected in ((None, 0), (taken, 100)):
        out = tmp_path / f"out{expected}"
        result = replay(tmp_path / "in.mcap", out, detector=hand_ahead, room_map=own)
        maps = [
            item.data for topic, _, item in read_topics(out / "output.mcap") if topic == "/map"
        ]
        assert [int(data[0]) for data in maps] == [expected]
        assert result.problems == ()


def test_output_mcap_holds_the_topics_of_the_node_with_the_pose_before_the_bool(
    tmp_path, write_bag, hand_ahead
):
    bag = write_bag(tmp_path / "in.mcap")
    replay(bag, tmp_path / "out", detector=hand_ahead)
    seen = list(read_topics(tmp_path / "out/output.mcap"))
    topics = {topic for topic, _, _ in seen}
    assert topics >= {
        "/hand_raised", "/customer_pose", "/hand_detection_debug", "/scan", "/tf_static",
        "/hand_detector/tracks", "/hand_detector/markers", "/hand_detector/approach_pose",
        "/hand_detector/waiting_list", "/hand_detector/raised_hands",
    }  # fmt: skip
    raised = [message.data for topic, _, message in seen if topic == "/hand_raised"]
    assert raised == [False] + [True] * 19
    pose = [message for topic, _, message in seen if topic == "/customer_pose"][-1]
    assert pose.header.frame_id == "map"
    assert pose.pose.position.x == pytest.approx(1.5, abs=0.1)
    debug = next(message for topic, _, message in seen if topic == "/hand_detection_debug")
    assert (debug.height, debug.width, debug.encoding) == (240, 320, "bgr8")
    calls = [message for topic, _, message in seen if topic == "/hand_detector/waiting_list"]
    assert len(calls) == 20
    (caller,) = calls[-1].detections
    assert caller.results[0].hypothesis.class_id == "waiting"
    hands = [message for topic, _, message in seen if topic == "/hand_detector/raised_hands"]
    assert [len(message.detections) for message in hands] == [0] + [1] * 19
    assert caller.header.stamp == hands[-1].detections[0].header.stamp
    order = [topic for topic, log_ns, _ in seen if log_ns == START_NS + 19 * SECOND_NS // 10]
    assert order.index("/customer_pose") < order.index("/hand_raised")


def test_the_same_recording_gives_the_same_tracks(tmp_path, write_bag, hand_ahead):
    bag = write_bag(tmp_path / "in.mcap")
    for out in ("a", "b"):
        replay(bag, tmp_path / out, detector=hand_ahead)
    assert (tmp_path / "a/tracks.csv").read_bytes() == (tmp_path / "b/tracks.csv").read_bytes()
    assert (tmp_path / "a/output.mcap").read_bytes() == (tmp_path / "b/output.mcap").read_bytes()


def test_camera_info_of_the_recording_is_used(tmp_path, write_bag, hand_ahead):
    bag = write_bag(tmp_path / "in")
    info = CameraInfo(START_NS, "camera_link", 640, 480, CameraModel(460, 460, 100.0, 240))
    with RecordingWriter(tmp_path / "info.mcap") as writer:
        writer.write("/camera_info", START_NS, info)
        with open_recording(bag) as recording:
            for log_ns, event in recording.events():
                if isinstance(event, CameraImage):
                    writer.write("/image_raw", log_ns, event)
    result = replay(tmp_path / "info.mcap", tmp_path / "out", detector=hand_ahead)
    rows = read_table(tmp_path / "out/tracks.csv")
    bearing = np.arctan2(float(rows[-1]["y_m"]), float(rows[-1]["x_m"]))
    # A palm of 30 px is 1.46 m away, and its thumb points at an owner .3 m to the left.
    beside_rad = np.arctan2(0.3, 460 * 0.095 / 30)
    assert bearing == pytest.approx(beside_rad - np.arctan(220 / 460), abs=0.02)
    assert result.history.frames_processed == 20


def test_one_stray_stamp_is_a_problem_and_forgets_nobody(tmp_path, write_bag, hand_ahead):
    bag = write_bag(tmp_path / "in.mcap", jump=10)
    result = replay(bag, tmp_path / "out", detector=hand_ahead)
    (problem,) = result.problems
    assert "its stamp 1699999996.0" in problem
    assert result.history.frames_processed == 19
    assert list(result.history.people) == [1]


def relogged(bag, path, change):
    """The recording with the events that `change` makes of each log time and event."""
    with open_recording(bag) as recording, RecordingWriter(path) as writer:
        topics = {CameraImage: "/image_raw", Scan: "/scan", StampedTransform: "/tf_static"}
        for log_ns, event in recording.events():
            for changed in change(log_ns, event):
                writer.write(topics[type(event)], log_ns, changed)
    return path


def test_stamps_that_stay_back_are_a_problem_and_the_rest_is_replayed(
    tmp_path, write_bag, hand_ahead
):
    def back(log_ns, event):
        is_late = log_ns >= START_NS + 1_000_000_000 and not isinstance(event, StampedTransform)
        yield dataclasses.replace(event, stamp_ns=event.stamp_ns - 5 * 10**9) if is_late else event

    bag = relogged(write_bag(tmp_path / "in.mcap"), tmp_path / "back.mcap", back)
    result = replay(bag, tmp_path / "out", detector=hand_ahead)
    assert any("jumped back by 4.800 s" in problem for problem in result.problems)
    assert result.history.frames_processed == 19


def test_a_scanner_of_which_nothing_is_used_is_a_problem(tmp_path, write_bag, hand_ahead):
    def renamed(log_ns, event):
        yield dataclasses.replace(event, frame_id="lidar") if isinstance(event, Scan) else event

    bag = relogged(write_bag(tmp_path / "in.mcap"), tmp_path / "other.mcap", renamed)
    (problem,) = replay(bag, tmp_path / "out", detector=hand_ahead).problems
    assert problem.startswith("no scan was used in any of 20 images")
    assert "'lidar'" in problem


def test_a_scanner_whose_clock_runs_ahead_is_a_problem(tmp_path, write_bag, hand_ahead):
    def ahead(log_ns, event):
        is_scan = isinstance(event, Scan)
        yield dataclasses.replace(event, stamp_ns=event.stamp_ns + 5 * 10**8) if is_scan else event

    bag = relogged(write_bag(tmp_path / "in.mcap"), tmp_path / "ahead.mcap", ahead)
    (problem,) = replay(bag, tmp_path / "out", detector=hand_ahead).problems
    assert "stamps lie 0.500 s after their recording" in problem


def test_a_camera_that_is_half_a_second_late_is_no_problem(tmp_path, write_bag, hand_ahead):
    def late(log_ns, event):
        is_image = isinstance(event, CameraImage)
        yield (
            dataclasses.replace(event, stamp_ns=event.stamp_ns - 5 * 10**8) if is_image else event
        )

    bag = relogged(write_bag(tmp_path / "in.mcap"), tmp_path / "late.mcap", late)
    assert replay(bag, tmp_path / "out", detector=hand_ahead).problems == ()


def test_transforms_that_come_after_the_images_have_given_up_are_a_problem_with_the_remedy(
    tmp_path, write_bag, hand_ahead
):
    bag = write_bag(tmp_path / "in.mcap", links=())
    with RecordingWriter(tmp_path / "late.mcap") as writer:
        events = []
        with open_recording(bag) as recording:
            for log_ns, event in recording.events():
                topic = "/image_raw" if isinstance(event, CameraImage) else "/scan"
                events.append((log_ns, topic, event))
                for child in ("camera_link", "laser"):
                    link = StampedTransform(log_ns, "map", child, RigidTransform())
                    events.append((log_ns + 700_000_000, "/tf", link))
        for log_ns, topic, event in sorted(events, key=lambda row: row[0]):
            writer.write(topic, log_ns, event)
    (problem,) = replay(tmp_path / "late.mcap", tmp_path / "out", detector=hand_ahead).problems
    assert "recorded 0.700 s later" in problem
    assert "Raise transform_wait_s" in problem
    waits = Config(transform_wait_s=1.0)
    late = replay(tmp_path / "late.mcap", tmp_path / "out", waits, detector=hand_ahead)
    assert late.problems == ()


def test_transforms_that_stop_are_a_problem_with_their_share(tmp_path, write_bag, hand_ahead):
    bag = write_bag(tmp_path / "in.mcap", links=())
    with RecordingWriter(tmp_path / "stop.mcap") as writer, open_recording(bag) as recording:
        for log_ns, event in recording.events():
            for child in ("camera_link", "laser"):
                if log_ns <= START_NS + SECOND_NS:
                    link = StampedTransform(log_ns, "map", child, RigidTransform())
                    writer.write("/tf", log_ns, link)
            topic = "/image_raw" if isinstance(event, CameraImage) else "/scan"
            writer.write(topic, log_ns, event)
    result = replay(tmp_path / "stop.mcap", tmp_path / "out", detector=hand_ahead)
    assert any("in 9 of 20 images" in problem for problem in result.problems)


def test_a_recording_without_scans_is_remarked(tmp_path, write_bag, hand_ahead):
    bag = write_bag(tmp_path / "in.mcap", scan=None)
    result = replay(bag, tmp_path / "out", detector=hand_ahead)
    assert any("no scans in the recording" in remark for remark in result.remarks)


def test_missing_transforms_are_a_problem_that_names_the_frames(tmp_path, write_bag, hand_ahead):
    bag = write_bag(tmp_path / "in.mcap", links=())
    result = replay(bag, tmp_path / "out", detector=hand_ahead)
    (problem,) = result.problems
    assert "camera_link" in problem
    assert "'map'" in problem
    assert "fixed_frame" in problem
    raised = [
        m.data
        for topic, _, m in read_topics(tmp_path / "out/output.mcap")
        if topic == "/hand_raised"
    ]
    assert any(raised)


def test_without_transforms_nothing_is_written_in_the_map(tmp_path, write_bag, hand_ahead):
    bag = write_bag(tmp_path / "in.mcap", links=())
    for camera_frame, frame_ids in (("camera_link", {"camera_link"}), ("eye_optical", set())):
        config = Config(camera_frame=camera_frame)
        replay(bag, tmp_path / "out", config, detector=hand_ahead)
        said = {
            message.markers[0].header.frame_id if "markers" in topic else message.header.frame_id
            for topic, _, message in read_topics(tmp_path / "out/output.mcap")
            if "tracks" in topic or "markers" in topic
        }
        assert said == frame_ids


def test_the_camera_itself_can_be_the_fixed_frame(tmp_path, write_bag, hand_ahead):
    bag = write_bag(tmp_path / "in.mcap", links=())
    config = Config(fixed_frame="camera_link")
    assert replay(bag, tmp_path / "out", config, detector=hand_ahead).problems == ()


def test_scans_without_beams_are_a_problem(tmp_path, write_bag, hand_ahead):
    def empty(stamp_ns):
        return Scan(stamp_ns, "laser", 0.0, 0.0, 0.1, 10.0, np.zeros(0))

    bag = write_bag(tmp_path / "in.mcap", scan=empty)
    result = replay(bag, tmp_path / "out", detector=hand_ahead)
    assert any("beams" in problem for problem in result.problems)


def test_a_truncated_recording_is_replayed_as_far_as_it_goes(tmp_path, write_bag, hand_ahead):
    bag = write_bag(tmp_path / "in.mcap", seconds=6)
    content = bag.read_bytes()
    bag.write_bytes(content[: len(content) * 2 // 3])
    result = replay(bag, tmp_path / "out", detector=hand_ahead)
    assert str(bag) in result.problems[0]
    raised = [
        m.data
        for topic, _, m in read_topics(tmp_path / "out/output.mcap")
        if topic == "/hand_raised"
    ]
    assert 5 < len(raised) < 60


def test_a_recording_without_images_and_scans_is_an_error(tmp_path, write_bag, hand_ahead):
    bag = write_bag(tmp_path / "in.mcap", images=False, scan=None)
    with pytest.raises(RecordingError, match="no images on /image_raw"):
        replay(bag, tmp_path / "out", detector=hand_ahead)


def test_images_on_another_topic_are_an_error_that_names_it(tmp_path, person_ahead, hand_ahead):
    with RecordingWriter(tmp_path / "in.mcap") as writer:
        picture = np.zeros((48, 64, 3), np.uint8)
        writer.write("/front/image", START_NS, CameraImage(START_NS, "camera_link", picture))
        writer.write("/scan", START_NS, person_ahead(START_NS))
    with pytest.raises(RecordingError, match="--image-topic /front/image"):
        replay(tmp_path / "in.mcap", tmp_path / "out", detector=hand_ahead)


def test_a_recording_of_scans_alone_is_replayed_with_a_remark(tmp_path, write_bag, hand_ahead):
    bag = write_bag(tmp_path / "in.mcap", images=False)
    result = replay(bag, tmp_path / "out", detector=hand_ahead)
    assert result.problems == ()
    assert "no images" in result.summary["remarks"][0]


@pytest.mark.parametrize(
    "name",
    ["oko_slam_wraparound.bag", "leg_tracker__positive_1_extracted.bag", "leg_tracker_demo"],
)
def test_real_scan_recordings_replay_without_error(tmp_path, name, hand_ahead):
    source = DATA / "scans" / name
    if not source.exists():
        pytest.skip(f"{source.name} is not beside this checkout")
    assert replay(source, tmp_path, detector=hand_ahead).problems == ()


@pytest.mark.model
def test_real_photos_replay_without_error(tmp_path, model_store):
    photos = DATA / "photos"
    if not photos.exists():
        pytest.skip("the photos are not beside this checkout")
    result = replay(photos, tmp_path, Config(model_complexity=1))
    assert result.problems == ()
    assert result.history.frames_processed == len(list(photos.iterdir()))


def test_a_source_is_never_written_over(tmp_path, write_bag, hand_ahead):
    bag = write_bag(tmp_path / "out.mcap")
    (tmp_path / "out").mkdir()
    (tmp_path / "out/output.mcap").hardlink_to(bag)
    before = bag.read_bytes()
    for source in (bag, tmp_path / "out/output.mcap", tmp_path / "out"):
        with pytest.raises(ConfigError, match="choose another"):
            replay(source, tmp_path / "out", detector=hand_ahead)
    assert bag.read_bytes() == before


def test_two_replays_never_write_into_one_folder(tmp_path, write_bag, hand_ahead):
    bag = write_bag(tmp_path / "in.mcap")
    with (
        FolderLock(tmp_path / "out"),
        pytest.raises(ConfigError, match="another command is writing there"),
    ):
        replay(bag, tmp_path / "out", detector=hand_ahead)


def test_a_replay_that_is_stopped_leaves_the_earlier_one_s_files(tmp_path, write_bag, hand_ahead):
    bag, out = write_bag(tmp_path / "in.mcap"), tmp_path / "out"
    names = {path.name for path in replay(bag, out, detector=hand_ahead).files}
    before = {name: (out / name).read_bytes() for name in names}

    def stop(*_):
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        replay(bag, out, detector=hand_ahead, watchers=[stop])
    assert {name: (out / name).read_bytes() for name in names} == before
    with open_recording(out / "output.part.mcap") as recording:
        assert list(recording.topics)
    replay(bag, out, detector=hand_ahead)
    assert {path.name for path in out.iterdir()} == {*names, ".lock"}


def test_two_parents_of_a_frame_are_a_problem_that_names_both(tmp_path, write_bag, hand_ahead):
    link = StampedTransform(0, "base_footprint", "laser", RigidTransform(), is_static=True)
    links = (*AT_ORIGIN, link)
    bag = write_bag(tmp_path / "in.mcap", links=links)
    problems = replay(bag, tmp_path / "out", detector=hand_ahead).problems
    assert any("'laser' has two parents, 'map' and 'base_footprint'" in line for line in problems)
