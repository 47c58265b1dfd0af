"""The node in a process of its own, played to by another, as on a robot."""

import re
import time
from pathlib import Path

import numpy as np
import pytest

pytest.importorskip("rclpy", reason="rclpy cannot be imported: no ROS 2 is sourced here")

from nodes.shared.topics import Output
from tracker.camera import CameraModel
from tracker.config import Config
from tracker.containers import CameraImage
from tracker.geometry import RigidTransform
from tracker.messages import CameraInfo, encode
from tracker.transforms import StampedTransform

ROOT = Path(__file__).parents[3]

pytestmark = [pytest.mark.slow, pytest.mark.model]


def assert_as_replay(ear, replayed, share=0.95):
    """The same images give the same Bool and, within 1 cm, the same pose."""
    stamps, raised = ear.frames()
    assert set(stamps) <= set(replayed.raised), "other images were processed"
    assert len(stamps) >= share * len(replayed.raised), "images were lost"
    said = dict(zip(stamps, raised, strict=True))
    poses = ear.poses()
    print(
        f"{len(stamps)} of {len(replayed.raised)} images, {len(poses)} of {len(replayed.xy)} poses"
    )
    if len(stamps) == len(replayed.raised):
        assert said == replayed.raised
        assert set(poses) == set(replayed.xy)
    both = sorted(set(poses) & set(replayed.xy))
    off_m = np.linalg.norm(
        [np.subtract(poses[stamp], replayed.xy[stamp]) for stamp in both], axis=-1
    )
    print(f"poses off by {1000 * off_m.max():.2f} mm at most")
    assert len(both) >= share * len(replayed.xy)
    assert off_m.max() < 0.01


#: The end of a recording is no dead camera.
NO_SILENCE = ("-p", "image_silence_s:=60.0")


def play_undisturbed(ear, start_node, play, *ros_arguments, loop=1, late_tf_s=0.0):
    """Play until the node lost no image.

    On a machine that others use as well that takes tries, the last ones with slower clocks.

    Returns the node, and the rates by the stamps and by the player's clock.
    """
    driving = ("--loop", loop, "--late-tf", late_tf_s)
    for speed in (1.0, 1.0, 0.5, 0.25, 0.1):
        node = start_node(*ros_arguments, *NO_SILENCE)
        assert play(*driving, "--rate", speed).wait(300.0) == 0
        time.sleep(1.1)
        status = ear.statuses()["processing"]
        stamps, _ = ear.frames()
        arrivals = [arrived for arrived, _ in ear.heard[Output.HAND_RAISED]]
        by_stamp_hz = (len(stamps) - 1) / ((stamps[-1] - stamps[0]) / 1e9)
        by_clock_hz = (len(arrivals) - 1) / (arrivals[-1] - arrivals[0]) / speed
        print(
            f"{by_stamp_hz:.3f} Hz by the stamps, {by_clock_hz:.3f} Hz at speed {speed}; {status}"
        )
        if status.values["lost"] == "0":
            break
        node.kill()
        node.wait()
        ear.forget()
    return node, (by_stamp_hz, by_clock_hz)


def test_ten_images_a_second_are_processed_as_replay_does(ear, start_node, play, replayed):
    expected = replayed()
    _, rates_hz = play_undisturbed(ear, start_node, play)
    assert rates_hz == pytest.approx((10.0, 10.0), abs=0.2)
    assert_as_replay(ear, expected)


def test_the_specifications_section_12_gives_eight_images_a_second(
    ear, start_node, play, replayed, section_12
):
    expected = replayed(Config.from_yaml(section_12))
    _, rates_hz = play_undisturbed(ear, start_node, play, "--params-file", section_12)
    assert rates_hz == pytest.approx((8.0, 8.0), abs=0.2)
    assert_as_replay(ear, expected)


def test_bad_parameters_are_refused_with_the_reason(ear, start_node):
    from rcl_interfaces.srv import SetParameters
    from rclpy.parameter import Parameter

    start_node()

    def put(name, value):
        request = SetParameters.Request(
            parameters=[Parameter(name, value=value).to_parameter_msg()]
        )
        (result,) = ear.call(SetParameters, "hand_detector/set_parameters", request).results
        return result.successful, result.reason

    assert put("processing_rate", 9) == (True, "")  # 9 is as good as 9.0
    ear.until(lambda: ear.statuses()["processing"].values["wanted_hz"] == "9.0")
    for name, value, reason in [
        ("processing_rate", -3.0, "out of range"),
        ("processing_rate", 0.0, "above 0"),
        ("confirm_detections", 9, "confirm_window"),
        ("ranging", "guess", "one of person, spec"),
        ("fixed_frame", "odom", "read-only"),
        ("raise_rule", 1, "type"),
    ]:
        is_set, why = put(name, value)
        assert not is_set, name
        assert reason in why
    assert ear.statuses()["processing"].values["wanted_hz"] == "9.0"


@pytest.mark.parametrize(
    ("name", "value", "reason"),
    [
        ("procesing_rate", "5.0", "did you mean `processing_rate`"),
        ("processing_rate", "0.0", "above 0"),
    ],
    ids=["misspelled", "out-of-range"],
)
def test_a_node_with_bad_parameters_does_not_start(run, ear, name, value, reason):
    node = run("-m", "nodes.hand_detector", "--ros-args", "-p", f"{name}:={value}", name="node")
    assert node.wait(30.0) == 2
    assert reason in node.log()


@pytest.mark.parametrize("module", ["nodes.hand_detector", "nodes.lifecycle_hand_detector"])
def test_a_file_of_an_earlier_version_starts_with_one_warning(run, ear, tmp_path, module):
    from rcl_interfaces.srv import ListParameters

    file = tmp_path / "old.yaml"
    file.write_text(
        "/**:\n  ros__parameters: {camera_fx: 5.0, appearance_weight: 5, measurement_model: no}\n"
    )
    node = run("-m", module, "--ros-args", "--params-file", file, name="node")
    answer = ear.call(ListParameters, "hand_detector/list_parameters", ListParameters.Request())
    assert "camera_fx" in answer.result.names
    assert not {"appearance_weight", "measurement_model"} & set(answer.result.names)
    [line] = [line for line in node.log().splitlines() if "appearance_weight" in line]
    assert line.startswith("[WARN]")
    assert "`measurement_model` (measurements" in line


def test_transforms_later_than_scans_and_images_cost_no_pose(ear, start_node, play, replayed):
    expected = replayed()
    play_undisturbed(ear, start_node, play, "-p", "transform_wait_s:=2.0", late_tf_s=0.15)
    poses = ear.poses()
    print(f"{len(poses)} poses, {len(expected.xy)} with timely transforms")
    assert len(poses) >= 0.9 * len(expected.xy)
    both = set(poses) & set(expected.xy)
    off_m = [np.hypot(*np.subtract(poses[stamp], expected.xy[stamp])) for stamp in both]
    assert np.percentile(off_m, 95) < 0.05


def test_a_recording_that_loops_resets_cleanly(ear, start_node, play, replayed):
    expected = replayed()
    node, _ = play_undisturbed(ear, start_node, play, loop=2)
    assert ear.statuses()["processing"].values["resets"] == "1"
    assert node.log().count("Everybody is forgotten: stamps jumped back") == 1
    stamps, raised = ear.frames()
    (seam,) = np.flatnonzero(np.diff(stamps) < 0)
    first, second = stamps[: seam + 1], stamps[seam + 1 :]
    assert len(second) == pytest.approx(len(first), abs=3)
    ups = [sum(raised[: seam + 1]), sum(raised[seam + 1 :])]
    assert ups[0] == pytest.approx(ups[1], abs=2)
    ids = [
        item.id
        for message in ear.messages(Output.TRACKS)[seam + 1 :]
        for item in message.detections
    ]
    assert len(set(ids)) == 1
    # The second time round the camera begins its grid of images a frame or two later.
    where = np.array(list(expected.xy.values()))
    late = [pose for stamp, pose in ear.poses().items() if stamp in second]
    assert len(late) >= 0.8 * len(where)
    assert np.abs(np.median(late, axis=0) - np.median(where, axis=0)).max() < 0.01


def test_silence_shows_by_name_within_two_seconds(ear, start_node, play):
    began = time.monotonic()
    start_node()

    def levels():
        return {name: status.message.split(":")[0] for name, status in ear.statuses().items()}

    missing = {"images": "missing", "scan": "missing", "transforms": "missing"}
    ear.until(lambda: missing.items() <= levels().items())
    print(f"missing inputs told {time.monotonic() - began:.1f} s after the process was started")
    assert levels()["camera_info"] == "missing"

    player = play("--without", "/scan")
    ear.until(lambda: {"images": "coming", "scan": "missing"}.items() <= levels().items())
    assert ear.statuses()["transforms"].level == b"\0" or ear.statuses()["transforms"].level == 0
    player.kill()
    player.wait()
    stopped = time.monotonic()
    stale = {"images": "stale", "scan": "missing", "transforms": "stale"}
    told = ear.until(lambda: stale.items() <= levels().items())
    print(f"stale inputs told after {told - stopped:.2f} s")
    assert told - stopped < 2.0


def test_a_camera_that_dies_with_a_hand_up_leaves_no_raised_hand(ear, start_node, play):
    start_node()
    player = play()
    ear.until(lambda: any(message.data for message in ear.messages(Output.HAND_RAISED)))
    player.kill()
    player.wait()
    died = time.monotonic()
    took_s = ear.until(lambda: not ear.messages(Output.HAND_RAISED)[-1].data) - died
    print(f"taken back {took_s:.2f} s after the last image")
    assert took_s < 2.0
    ear.until(lambda: ear.statuses()["customers"].message.startswith("nobody is reported"))
    assert ear.messages(Output.TRACKS)[-1].detections == []


def test_transforms_that_stop_show_within_two_seconds(ear, start_node, play):
    start_node()
    player = play("--without", "/tf", "--without", "/tf_static", "--wait-for", "/image_raw")
    ear.until(
        lambda: ear.statuses().get("images") and ear.statuses()["images"].message == "coming"
    )
    assert ear.statuses()["transforms"].message.startswith("missing")
    player.kill()


BROKEN = {
    "image_raw": [
        b"\0\1\0\0",
        b"\0\1\0\0" + b"\xff" * 60,
        encode(CameraImage(5 * 10**9, "camera_link", np.zeros((8, 8, 3), np.uint8))).cdr[:-20],
        encode(CameraImage(2**31 * 10**9 - 1, "camera_link", np.zeros((8, 8, 3), np.uint8))).cdr,
        encode(CameraImage(0, "camera_link", np.zeros((8, 8, 3), np.uint8)))
        .cdr.replace(b"bgr8", b"fan8"),
    ],
    "scan": [b"\0\1\0\0", b"\0\1\0\0" + b"\xff" * 60],
    "tf": [
        b"\0\1\0\0\xff\xff\xff\xff",
        encode(StampedTransform(2**31 * 10**9 - 1, "map", "odom", RigidTransform())).cdr,
        encode(StampedTransform(1, "map", "base_link", RigidTransform((np.nan, 0, 0)))).cdr,
    ],
    "camera_info": [
        b"\0\1\0\0" + b"\xff" * 60,
        encode(CameraInfo(1, "camera_link", 640, 480, CameraModel(1.0, 1.0, 1.0, 1.0)))
        .cdr.replace(np.float64(1.0).tobytes(), np.float64(np.nan).tobytes()),
    ],
}  # fmt: skip


def test_broken_messages_are_counted_and_the_good_ones_served(ear, start_node, play, replayed):
    from sensor_msgs.msg import CameraInfo as RosCameraInfo
    from sensor_msgs.msg import Image, LaserScan
    from tf2_msgs.msg import TFMessage

    kinds = {"image_raw": Image, "scan": LaserScan, "tf": TFMessage, "camera_info": RosCameraInfo}
    node = start_node()
    publishers = {name: ear.node.create_publisher(kind, name, 10) for name, kind in kinds.items()}
    ear.until(lambda: all(item.get_subscription_count() for item in publishers.values()))
    player = play()
    ear.until(lambda: len(ear.heard[Output.HAND_RAISED]) > 5)
    for _ in range(20):
        for name, broken in BROKEN.items():
            for cdr in broken:
                publishers[name].publish(cdr)
        time.sleep(0.1)
    assert player.wait(60.0) == 0
    time.sleep(1.2)
    statuses = ear.statuses()
    counts = {
        name: int(statuses[name].values["malformed"])
        for name in ("images", "scan", "transforms", "camera_info")
    }
    print("malformed:", counts, statuses["processing"], node.log(), sep="\n")
    assert node.poll() is None
    # Best effort may lose some of them.
    assert counts["images"] >= 80
    assert counts["scan"] == pytest.approx(40, abs=4)
    assert counts["transforms"] >= 50
    assert counts["camera_info"] >= 30
    said = [line for line in node.log().splitlines() if "[WARN]" in line]
    assert len(said) <= 20  # kinds of faults, and what was missing before and after
    expected = replayed()
    stamps, _ = ear.frames()
    assert len(stamps) >= 0.8 * len(expected.raised)
    assert len(ear.poses()) >= 0.6 * len(expected.xy)  # on a busy machine


def test_the_services_answer(ear, start_node, play):
    from std_srvs.srv import SetBool, Trigger

    start_node()
    release = "hand_detector/release_customer"
    assert not ear.call(Trigger, release, Trigger.Request()).success
    player = play()
    ear.until(lambda: ear.heard[Output.CUSTOMER_POSE])
    assert "customer 1" in ear.call(Trigger, release, Trigger.Request()).message
    ear.until(lambda: ear.statuses()["customers"].values["selected_id"] == "none")
    ear.forget()
    assert ear.call(SetBool, "hand_detector/enable", SetBool.Request(data=False)).success
    ear.until(lambda: ear.messages(Output.HAND_RAISED)[-1:] and
              not ear.messages(Output.HAND_RAISED)[-1].data)  # fmt: skip
    time.sleep(0.3)
    count = len(ear.heard[Output.HAND_RAISED])
    time.sleep(0.5)
    assert len(ear.heard[Output.HAND_RAISED]) == count
    assert ear.call(SetBool, "hand_detector/enable", SetBool.Request(data=True)).success
    ear.until(lambda: len(ear.heard[Output.HAND_RAISED]) > count + 2)
    assert ear.call(Trigger, "hand_detector/reset", Trigger.Request()).success
    ear.until(lambda: ear.statuses()["processing"].values["resets"] == "1")
    player.kill()


@pytest.mark.parametrize("module", ["nodes.hand_detector", "nodes.dds_hand_detector"])
def test_the_example_waiter_serves_who_calls_and_who_is_unknown_is_refused(
    ear, start_node, play, run, module
):
    from std_msgs.msg import String

    start_node(module=module)
    example = ROOT / "examples/waiter.py"
    waiter = run(example, "--pretend-drive-s", 2, "--service-s", 0.5, "--count", 1, name="waiter")
    player = play("--loop", 2)
    assert waiter.wait(60.0) == 0, waiter.log()
    number = re.search(r"served: (\d+)\n", waiter.log()).group(1)
    command = ear.node.create_publisher(String, "hand_detector/command", 10)
    ear.until(command.get_subscription_count)
    command.publish(String(data="serve 99"))
    ear.until(lambda: "99" in "".join(item.data for item in ear.messages(Output.ANSWERS)))
    answered = [item.data.partition(":")[0] for item in ear.messages(Output.ANSWERS)]
    # On a busy machine the waiter says a command once more.
    assert list(dict.fromkeys(answered)) == [f"serve {number}", f"served {number}", "serve 99"]
    assert "refused: no customer has the number 99" in ear.messages(Output.ANSWERS)[-1].data
    lists = ear.messages(Output.WAITING_LIST)
    assert any(item.id == number for said in lists for item in said.detections)
    raised = [len(item.detections) > 0 for item in ear.messages(Output.RAISED_HANDS)]
    assert raised == [item.data for item in ear.messages(Output.HAND_RAISED)][: len(raised)]
    player.kill()


@pytest.mark.parametrize("module", ["nodes.hand_detector", "nodes.dds_hand_detector"])
@pytest.mark.parametrize(("scene", "drive_s"), [("restaurant", 18.0), ("bistro", 11.0)])
def test_the_example_waiter_serves_everybody_once_in_order(
    ear, start_node, run, scene_recording, guests_of, module, scene, drive_s
):
    service_s = 4.0
    played, path = scene_recording(scene)
    guests = guests_of(played)
    order = guests.order(drive_s + service_s)
    start_node("-p", "image_transport:=compressed", module=module)
    waiter = run(
        ROOT / "examples/waiter.py", "--pretend-drive-s", drive_s, "--service-s", service_s,
        "--count", len(order), name="waiter",
    )  # fmt: skip
    run(Path(__file__).with_name("play_recording.py"), path, name="player")
    most_s = played.duration_s + len(order) * (drive_s + service_s) + 60.0
    assert waiter.wait(most_s) == 0, waiter.log()
    served = re.search(r"served: ([\d, ]+)\n", waiter.log()).group(1).split(", ")
    places = {
        person.id: _xy(person.results[0])
        for person in ear.messages(Output.WAITING_LIST)[-1].detections
    }
    assert guests.known_as(served, places) == order


@pytest.mark.parametrize("module", ["nodes.hand_detector", "nodes.dds_hand_detector"])
def test_ros_reads_in_tracks_since_when_a_hand_is_up_and_how_fast_its_owner_walks(
    ear, start_node, play, module
):
    from rclpy.serialization import deserialize_message
    from vision_msgs.msg import Detection3DArray

    start_node(module=module)
    player = play("--loop", 2)

    def last(output):
        heard = ear.heard[output]
        return (
            deserialize_message(bytes(heard[-1][1]), Detection3DArray).detections if heard else []
        )

    ear.until(lambda: last(Output.RAISED_HANDS) and last(Output.TRACKS))
    player.kill()
    (person,), (raised,) = last(Output.TRACKS), last(Output.RAISED_HANDS)
    words = {result.hypothesis.class_id.partition("/")[0]: result for result in person.results}
    since = words["raised_since"].hypothesis.class_id.partition("/")[2]
    assert since == f"{raised.header.stamp.sec}.{raised.header.stamp.nanosec:09d}"
    assert float(words["age_s"].hypothesis.class_id.partition("/")[2]) > 0.0
    assert np.hypot(*_xy(words["velocity"])) < 2.0
    assert person.results[0].pose.covariance[35] == pytest.approx(np.pi**2 / 3)


def _xy(result):
    return result.pose.pose.position.x, result.pose.pose.position.y


def test_a_simulated_clock_that_jumps_back_resets(ear, start_node):
    from rosgraph_msgs.msg import Clock

    node = start_node("-p", "use_sim_time:=true")
    clock = ear.node.create_publisher(Clock, "/clock", 10)
    ear.until(clock.get_subscription_count)
    message = Clock()
    for second in (50, 51, 20, 21):
        message.clock.sec = second
        for _ in range(5):
            clock.publish(message)
            time.sleep(0.1)
    ear.until(lambda: "Everybody is forgotten: the clock has jumped by -31.000 s" in node.log())
    ear.until(lambda: ear.messages(Output.DIAGNOSTICS)[-1].header.stamp.sec == 21)


def test_ctrl_c_ends_it_at_once_and_takes_a_raised_hand_back(ear, start_node, play, interrupt):
    node = start_node()
    player = play()
    ear.until(lambda: ear.heard[Output.CUSTOMER_POSE])
    status, took_s = interrupt(node)
    print(f"ended after {took_s:.2f} s")
    assert status == 0, node.log()
    assert "Traceback" not in node.log()
    assert took_s < 3.0
    ear.until(lambda: not ear.messages(Output.HAND_RAISED)[-1].data)
    player.kill()


def test_the_lifecycle_node_follows_its_manager(ear, run, play, model_store, interrupt):
    from lifecycle_msgs.msg import Transition
    from lifecycle_msgs.srv import ChangeState

    node = run("-m", "nodes.lifecycle_hand_detector", name="node")

    def change(number):
        request = ChangeState.Request(transition=Transition(id=number))
        assert ear.call(ChangeState, "hand_detector/change_state", request).success, node.log()

    change(Transition.TRANSITION_CONFIGURE)
    assert not ear.heard[Output.HAND_RAISED]
    change(Transition.TRANSITION_ACTIVATE)
    player = play()
    ear.until(lambda: ear.heard[Output.CUSTOMER_POSE])
    change(Transition.TRANSITION_DEACTIVATE)
    ear.until(lambda: not ear.messages(Output.HAND_RAISED)[-1].data)
    count = len(ear.heard[Output.HAND_RAISED])
    change(Transition.TRANSITION_ACTIVATE)
    ear.until(lambda: len(ear.heard[Output.HAND_RAISED]) > count + 3)
    change(Transition.TRANSITION_DEACTIVATE)
    change(Transition.TRANSITION_CLEANUP)
    change(Transition.TRANSITION_CONFIGURE)
    player.kill()
    status, _ = interrupt(node)
    assert status == 0, node.log()
    assert "Traceback" not in node.log()
