import numpy as np

from nodes.shared.link import Link
from nodes.shared.topics import Input, Output
from tracker import Config
from tracker.camera import CameraModel
from tracker.containers import OccupancyGrid
from tracker.messages import CameraInfo, encode

START_NS = 1_000_000_000_000
OK, WARN, ERROR = 0, 1, 2


def test_what_never_came_is_missing_by_name_with_its_topic(make_wire):
    wire = make_wire(topic_names={Input.SCAN: "/robot/scan"})
    found = wire.diagnose()
    assert (found["images"].level, found["images"].message) == (
        ERROR, "missing: nothing has come on image_raw",
    )  # fmt: skip
    assert found["scan"].level == WARN
    assert found["scan"].message == "missing: nothing has come on /robot/scan"
    assert found["transforms"].message == "missing: nothing has come on /tf"
    assert found["camera_info"].level == OK
    assert found["camera_info"].message.startswith("missing: camera_fx")
    assert found["customers"].message == "no image was processed yet"


def test_what_has_ceased_is_stale_within_a_second(wire):
    wire.base(START_NS - 1)
    wire.base(START_NS + 1)
    wire.scan(START_NS)
    wire.image(START_NS)
    wire.settle()
    found = wire.diagnose()
    assert [found[name].level for name in ("images", "scan", "transforms")] == [OK, OK, OK]
    wire.steady_ns += 900_000_000
    found = wire.diagnose()
    assert found["images"].message == "stale: nothing has come on image_raw for 0.9 s"
    assert found["scan"].message == "stale: nothing has come on scan for 0.9 s"
    assert found["transforms"].message == "stale: nothing has come on /tf for 0.9 s"


def test_a_camera_that_stands_still_needs_no_moving_transforms(make_wire):
    wire = make_wire(Config(fixed_frame="base_link"))
    wire.mounting()
    wire.settle()
    wire.image(START_NS)
    wire.settle()
    assert wire.diagnose()["transforms"].level == OK


def test_transforms_that_do_not_connect_are_told_apart_from_missing_ones(make_wire):
    wire = make_wire()  # nothing mounts the camera on the base
    wire.base(START_NS - 1)
    wire.base(START_NS + 1)
    wire.image(START_NS)
    wire.steady_ns += 400_000_000
    wire.base(START_NS + 2)
    wire.settle()
    transforms = wire.diagnose()["transforms"]
    assert transforms.level == WARN
    assert "No transform names the frame 'camera_link'" in transforms.message


def test_rates_are_told_by_the_steady_clock(wire):
    wire.base(START_NS - 1)
    wire.diagnose()
    for second in range(4):
        for number in range(30):
            stamp_ns = START_NS + second * 10**9 + number * 33_333_333
            wire.base(stamp_ns + 1)
            wire.image(stamp_ns)
        wire.settle()
        wire.steady_ns += 1_000_000_000
        found = wire.diagnose()
    assert found["images"].values["rate_hz"] == "30.0"
    assert found["images"].values["received"] == "120"


def test_latency_is_from_the_stamp_to_the_publication_on_the_nodes_clock(wire):
    wire.now_ns = START_NS + 42_000_000
    wire.base(START_NS - 1)
    wire.base(START_NS + 1)
    wire.image(START_NS)
    wire.settle()
    values = wire.diagnose()["processing"].values
    assert values["latency_ms_median"] == values["latency_ms_p99"] == "42.0"
    assert values["processed"] == "1"
    assert values["detector"] == "OneRaisedHand"
    assert values["raise_rule"] == "evidence"


def test_stamps_of_another_time_are_named_rather_than_called_late(wire):
    wire.now_ns = START_NS + 3600 * 10**9
    wire.base(START_NS - 1)
    wire.base(START_NS + 1)
    wire.image(START_NS)
    wire.settle()
    values = wire.diagnose()["processing"].values
    assert "3600.0 s from the node's clock: is use_sim_time right?" in values["latency"]
    assert "latency_ms_median" not in values


def test_the_report_bears_the_nodes_time(wire):
    wire.core.diagnose()
    stamp = wire.messages(Output.DIAGNOSTICS)[-1].header.stamp
    assert stamp.sec == START_NS // 10**9


def test_what_the_wire_knows_follows_what_is_missing_and_what_is_lost(make_wire):
    links = {Input.IMAGES: Link(1, loss="the socket is full", values={"dropped": 7})}
    wire = make_wire(Config(fixed_frame="base_link"), links=lambda: links)
    found = wire.diagnose()["images"]
    assert found.message == (
        "missing: nothing has come on image_raw; 1 publisher connected, but the socket is full"
    )
    assert (found.values["publishers"], found.values["dropped"]) == ("1", "7")
    wire.mounting()
    wire.settle()
    wire.image(START_NS)
    wire.settle()
    found = wire.diagnose()["images"]
    assert (found.level, found.message) == (WARN, "coming, but the socket is full")


def test_intrinsics_that_do_not_fit_the_picture_are_told_by_both_sizes(wire):
    info = CameraInfo(START_NS, "camera_link", 640, 360, CameraModel(400.0, 400.0, 320.0, 180.0))
    wire.core.receive(Input.CAMERA_INFO, encode(info))
    wire.base(START_NS - 1)
    wire.base(START_NS + 1)
    wire.image(START_NS)
    wire.settle()
    status = wire.diagnose()["camera_info"]
    assert status.level == WARN
    assert "640x360" in status.message
    assert "64x48" in status.message


def test_a_map_is_not_missed_and_said_once_it_has_come(wire):
    assert wire.diagnose()["map"].level == OK
    assert wire.diagnose()["map"].message.startswith("missing: only the scan")
    grid = OccupancyGrid(START_NS, "map", 0.05, (0.0, 0.0, 0.0), np.zeros((4, 4), np.int8))
    wire.core.receive(Input.MAP, encode(grid))
    wire.settle()
    assert (wire.diagnose()["map"].level, wire.diagnose()["map"].message) == (OK, "has come")


def test_a_map_that_no_transform_places_is_told(wire):
    grid = OccupancyGrid(START_NS, "floor", 0.05, (0.0, 0.0, 0.0), np.zeros((4, 4), np.int8))
    wire.core.receive(Input.MAP, encode(grid))
    wire.mounting()
    wire.base(START_NS - 1)
    wire.base(START_NS + 1)
    wire.image(START_NS)
    wire.settle()
    assert wire.diagnose()["map"].level == WARN
    assert "map unused" in wire.diagnose()["map"].message


def test_a_map_that_makes_no_sense_is_counted_as_malformed(wire):
    grid = OccupancyGrid(START_NS, "map", 0.05, (0.0, 0.0, 0.0), np.zeros((4, 4), np.int8))
    wire.core.receive(Input.MAP, encode(grid)._replace(cdr=encode(grid).cdr[:-4]))
    wire.settle()
    assert wire.diagnose()["map"].values["malformed"] == "1"


def test_a_picture_that_claims_too_many_pixels_is_counted_as_malformed(make_wire):
    wire = make_wire(Config(picture_max_pixels=64 * 48))
    for number, width in enumerate((64, 65)):
        wire.image(START_NS + number * 10**9, width)
    wire.steady_ns += 400_000_000
    wire.base(START_NS - 1)
    wire.base(START_NS + 2 * 10**9)
    wire.settle()
    images = wire.diagnose()["images"]
    assert images.values["malformed"] == "1"
    assert "65x48 pixels" in images.values["last_fault"]


def test_a_disabled_node_misses_nothing_and_waits_a_while_once_it_is_enabled(wire):
    wire.core.enable(False)
    wire.steady_ns += 5_000_000_000
    assert {status.level for status in wire.diagnose().values()} == {OK}
    assert wire.diagnose()["images"].message == "disabled"
    wire.core.enable(True)
    assert wire.diagnose()["images"].message == "awaited"
    assert {status.level for status in wire.diagnose().values()} == {OK}
    wire.steady_ns += 900_000_000
    assert wire.diagnose()["images"].level == ERROR


def test_two_robots_are_told_apart_by_the_nodes_full_name(make_wire):
    wire = make_wire(node_name="/robot1/hand_detector")
    wire.core.diagnose()
    for status in wire.messages(Output.DIAGNOSTICS)[-1].status:
        assert status.name.startswith("robot1/hand_detector: ")
        assert status.hardware_id == "robot1/hand_detector"


def test_without_a_depth_camera_nothing_is_said_of_depth(wire):
    assert "depth" not in wire.diagnose()


def test_a_depth_camera_is_told_of_and_no_scanner_is_missed_then(make_wire):
    wire = make_wire()
    wire.mounting()
    wire.base(START_NS - 1)
    wire.base(START_NS + 1)
    wire.depth(START_NS)
    wire.image(START_NS)
    wire.settle()
    found = wire.diagnose()
    assert (found["depth"].level, found["depth"].message) == (OK, "coming")
    assert "scan" not in found
    wire.steady_ns += 900_000_000
    stale = wire.diagnose()["depth"]
    assert (stale.level, stale.message) == (WARN, "stale: nothing has come on depth for 0.9 s")


def test_a_depth_camera_that_is_wanted_and_missing_is_told(make_wire):
    found = make_wire(Config(depth_source="depth", depth_transport="compressed")).diagnose()
    assert found["depth"].level == WARN
    assert found["depth"].message == "missing: nothing has come on depth/compressedDepth"


def test_depth_of_which_nothing_is_used_is_told_with_the_reason(make_wire):
    wire = make_wire()
    wire.mounting()
    wire.base(START_NS - 1)
    wire.base(START_NS + 3_000_000_000)
    wire.depth(START_NS)
    for number in range(10):
        wire.image(START_NS + 500_000_000 + number * 100_000_000)
        wire.settle()
    depth = wire.diagnose()["depth"]
    assert depth.level == WARN
    assert "no depth was used in the last" in depth.message
    assert "clocks" in depth.message
