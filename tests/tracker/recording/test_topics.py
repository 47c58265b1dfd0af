import numpy as np
import pytest

from tracker.camera import CameraModel, DepthCamera
from tracker.containers import CameraImage, DepthImage
from tracker.errors import RecordingError
from tracker.messages import CameraInfo
from tracker.recording import RecordingWriter, Topics, open_recording
from tracker.recording.sources import TopicInfo
from tracker.recording.topics import TopicTable

IMAGE, SCAN, TF = "sensor_msgs/msg/Image", "sensor_msgs/msg/LaserScan", "tf2_msgs/msg/TFMessage"
INFO, PACKED = "sensor_msgs/msg/CameraInfo", "sensor_msgs/msg/CompressedImage"
CLOUD, ECHOES = "sensor_msgs/msg/PointCloud2", "sensor_msgs/msg/MultiEchoLaserScan"


def table(**types):
    """Topics as `robot1__tf=TF` for /robot1/tf; ten messages each."""
    named = {f"/{name.replace('__', '/')}": type_name for name, type_name in types.items()}
    return TopicTable({name: TopicInfo(type_name, 10) for name, type_name in named.items()})


@pytest.mark.parametrize("name", ["robot1", "fleet/left", "a"])
def test_transforms_of_the_only_namespace_are_found(name):
    key = name.replace("/", "__")
    there = table(**{f"{key}__tf": TF, f"{key}__tf_static": TF, "image_raw": IMAGE})
    found = there.find(Topics())
    assert (found.tf, found.tf_static) == (f"/{name}/tf", f"/{name}/tf_static")
    assert there.unread_transforms(found) == ""


def test_of_several_robots_the_one_with_the_camera_counts():
    there = table(one__tf=TF, two__tf=TF, two__camera__image=IMAGE, one__tf_static=TF)
    found = there.find(Topics(image="/two/camera/image"))
    assert found.tf == "/two/tf"
    assert found.tf_static == "/one/tf_static"


def test_of_several_robots_without_a_hint_all_are_named():
    there = table(one__tf=TF, two__tf=TF, image_raw=IMAGE, tf_static=TF)
    found = there.find(Topics())
    assert found.tf == "/tf"
    line = there.unread_transforms(found)
    assert "/one/tf, /two/tf" in line
    assert "--tf-topic" in line


def test_topics_that_are_there_are_kept_and_empty_ones_are_not():
    there = TopicTable({"/tf": TopicInfo(TF, 0), "/robot1/tf": TopicInfo(TF, 5)})
    assert there.find(Topics()).tf == "/robot1/tf"
    there = TopicTable({"/tf": TopicInfo(TF, 1), "/robot1/tf": TopicInfo(TF, 5)})
    assert there.find(Topics()).tf == "/tf"


@pytest.mark.parametrize(
    ("types", "words"),
    [
        ({"points": CLOUD}, ["/points", "PointCloud2", "pointcloud_to_laserscan"]),
        ({"scan": CLOUD}, ["/scan", "PointCloud2", "pointcloud_to_laserscan"]),
        ({"echoes": ECHOES}, ["/echoes", "MultiEchoLaserScan", "laser_proc"]),
        ({"front": SCAN, "rear": SCAN}, ["/front, /rear", "--scan-topic"]),
    ],
)
def test_a_laser_that_is_not_read_is_named_with_the_remedy(types, words):
    there = table(**types)
    line = there.unread_scans(there.find(Topics()).scan)
    assert all(word in line for word in words)


def test_nothing_is_said_of_a_laser_that_is_read_or_was_never_there():
    for types in ({"scan": SCAN, "points": CLOUD}, {"laser": SCAN}, {"image_raw": IMAGE}):
        there = table(**types)
        assert there.unread_scans(there.find(Topics()).scan) == ""


def test_ever_so_many_topics_make_one_line_that_ends(tmp_path):
    with RecordingWriter(tmp_path / "many.mcap") as writer:
        for number in range(300):
            writer.write(f"/up_{number:04d}\x1b[31m", 5, bool(number % 2))
    with open_recording(tmp_path / "many.mcap") as recording:
        with pytest.raises(RecordingError) as caught:
            recording.require_images()
    text = str(caught.value)
    assert "and 288 more" in text
    assert len(text) < 1500
    assert "\x1b" not in text
    assert "\\x1b[31m" in text


def test_lasting_transforms_of_a_namespace_come_first(tmp_path, sensor_items):
    with RecordingWriter(tmp_path / "a.mcap") as writer:
        for topic, log_ns, item in sensor_items(5):
            writer.write(topic.replace("/tf", "/robot7/tf"), log_ns, item)
    with open_recording(tmp_path / "a.mcap") as recording:
        events = [event for _, event in recording.events()]
        assert any("/robot7/tf_static is read instead" in note for note in recording.notes)
    assert events[0].is_static
    assert np.allclose(events[0].transform.translation_m, (0.2, 0.0, 0.3))


def test_the_only_map_is_found_in_a_namespace_and_no_cost_map():
    grid = "nav_msgs/msg/OccupancyGrid"
    there = table(robot1__map=grid, local_costmap__costmap=grid)
    assert there.find(Topics()).map == "/robot1/map"
    assert table(map=grid, other__map=grid).find(Topics()).map == "/map"
    assert table(a__map=grid, b__map=grid).find(Topics()).map == "/map"


def test_a_topic_is_found_without_its_slash():
    there = table(eye__image=IMAGE, eye__scan=SCAN, laser__scan=SCAN)
    found = there.find(Topics(image="eye/image", scan="laser/scan"))
    assert (found.image, found.scan) == ("/eye/image", "/laser/scan")


def test_packed_depth_and_the_intrinsics_beside_it_are_found():
    there = table(camera__depth__image__compressedDepth=PACKED, camera__depth__camera_info=INFO)
    found = there.find(Topics(depth="/camera/depth/image"))
    assert found.depth == "/camera/depth/image/compressedDepth"
    assert found.depth_camera_info == "/camera/depth/camera_info"


def test_the_color_camera_s_intrinsics_are_not_taken_for_a_depth_camera_s():
    there = table(image_raw=IMAGE, depth=IMAGE, camera_info=INFO)
    found = there.find(Topics())
    assert found.camera_info == "/camera_info"
    assert found.depth_camera_info == "/depth_camera_info"


@pytest.mark.parametrize("jpeg_quality", [None, 90], ids=["plain", "packed"])
@pytest.mark.parametrize("name", ["drive.mcap", "drive"], ids=["file", "folder"])
def test_depth_and_its_intrinsics_are_read_as_they_were_written(tmp_path, name, jpeg_quality):
    camera = CameraModel(400.0, 400.0, 32.0, 24.0, width=64, height=48)
    pixels = np.full((48, 64), 2345, np.uint16)
    with RecordingWriter(tmp_path / name, jpeg_quality=jpeg_quality) as writer:
        writer.write("/depth_camera_info", 1, CameraInfo(1, "eye", 64, 48, camera))
        writer.write("/depth", 2, DepthImage.of(2, "eye", pixels))
        writer.write("/image_raw", 3, CameraImage(3, "", np.zeros((48, 64, 3), np.uint8)))
    with open_recording(tmp_path / name) as recording:
        assert recording.has_depth
        info, depth, image = [event for _, event in recording.events()]
    assert isinstance(info, DepthCamera)
    assert info.camera.fx == 400.0
    assert (depth.stamp_ns, depth.frame_id) == (2, "eye")
    np.testing.assert_array_equal(depth.read(), pixels)
    assert isinstance(image, CameraImage)
