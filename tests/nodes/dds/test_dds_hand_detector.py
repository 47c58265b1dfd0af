"""The node without ROS in a process of its own, played to by another, heard by a third."""

import signal
import time

import numpy as np
import pytest

pytest.importorskip("cyclonedds", reason="the extra dds is not installed")

from nodes.shared.qos import PROFILES
from nodes.shared.topics import INPUT_TOPICS, Input, Output
from tracker.camera import CameraModel
from tracker.config import Config
from tracker.containers import CameraImage, Scan
from tracker.geometry import RigidTransform
from tracker.messages import CameraInfo, encode
from tracker.messages.types import IMAGE, STRING, build, serialize
from tracker.transforms import StampedTransform

pytestmark = [pytest.mark.slow, pytest.mark.model]

TRIGGER, SET_BOOL = "std_srvs/srv/Trigger", "std_srvs/srv/SetBool"


#: The end of a recording is no dead camera.
NO_SILENCE = ("-p", "image_silence_s:=60.0")


def play_undisturbed(ear, start_node, play, *arguments):
    """Play until every image has come and the node lost none.

    The wire is best effort: on a machine that others use as well that takes tries, the last ones
    with slower clocks.

    Returns the rates by the stamps and by the player's clock.
    """
    for speed in (1.0, 1.0, 0.5, 0.25, 0.1):
        node = start_node(*arguments, *NO_SILENCE)
        player = play("--rate", speed)
        assert player.wait(300.0) == 0, player.log()
        time.sleep(1.1)
        status = ear.statuses()["processing"]
        received = ear.statuses()["images"].values["received"]
        stamps, _ = ear.frames()
        arrivals = [arrived for arrived, _ in ear.heard[Output.HAND_RAISED]]
        by_stamp_hz = (len(stamps) - 1) / ((stamps[-1] - stamps[0]) / 1e9)
        by_clock_hz = (len(arrivals) - 1) / (arrivals[-1] - arrivals[0]) / speed
        print(
            f"{by_stamp_hz:.3f} Hz by the stamps, {by_clock_hz:.3f} Hz at speed {speed}; "
            f"{received} images came; {status}"
        )
        if f"/image_raw: {received}\n" in player.log() and status.values["lost"] == "0":
            break
        node.kill()
        node.wait()
        ear.heard.clear()
    return by_stamp_hz, by_clock_hz


def assert_as_replay(ear, replayed, share=0.95):
    """The same images give the same Bool and, within 1 cm, the same pose."""
    stamps, raised = ear.frames()
    poses = ear.poses()
    print(f"{len(stamps)} of {len(replayed.raised)} images, {len(poses)} of {len(replayed.xy)}")
    assert set(stamps) <= set(replayed.raised), "other images were processed"
    assert len(stamps) >= share * len(replayed.raised), "images were lost"
    if len(stamps) == len(replayed.raised):
        assert dict(zip(stamps, raised, strict=True)) == replayed.raised
        assert set(poses) == set(replayed.xy)
    both = sorted(set(poses) & set(replayed.xy))
    off_m = [np.hypot(*np.subtract(poses[stamp], replayed.xy[stamp])) for stamp in both]
    print(f"poses off by {1000 * max(off_m):.3f} mm at most")
    assert len(both) >= share * len(replayed.xy)
    assert max(off_m) < 0.01


def test_ten_images_a_second_are_processed_as_replay_does(ear, start_node, play, replayed):
    expected = replayed()
    rates_hz = play_undisturbed(ear, start_node, play)
    assert rates_hz == pytest.approx((10.0, 10.0), abs=0.2)
    assert_as_replay(ear, expected)


def test_the_specifications_section_12_gives_eight_images_a_second(
    ear, start_node, play, replayed, section_12
):
    expected = replayed(Config.from_yaml(section_12))
    arguments = ("--ros-args", "--params-file", section_12)
    rates_hz = play_undisturbed(ear, start_node, play, *arguments)
    assert rates_hz == pytest.approx((8.0, 8.0), abs=0.2)
    assert_as_replay(ear, expected)


def test_a_recording_that_loops_resets_cleanly(ear, start_node, play):
    node = start_node()
    player = play("--loop", "--start-offset", 3, "--rate", 0.5)
    ear.until(lambda: ear.statuses()["processing"].values["resets"] == "2", 120.0)
    player.kill()
    stamps, raised = ear.frames()
    seams = np.flatnonzero(np.diff(stamps) < 0)
    assert len(seams) == 2
    assert node.log().count("Everybody is forgotten: stamps jumped back") == 2
    rounds = np.split(np.arange(len(stamps)), seams + 1)
    ups = [sum(raised[index] for index in part) for part in rounds[:2]]
    assert min(ups) > 5
    assert ups[0] == pytest.approx(ups[1], abs=4)
    assert node.poll() is None


def test_silence_shows_by_name_within_two_seconds(ear, start_node, play):
    node = start_node()

    def words():
        return {name: status.message.split(":")[0] for name, status in ear.statuses().items()}

    missing = {"images": "missing", "scan": "missing", "transforms": "missing"}
    assert missing.items() <= words().items()  # in the very first report, after a second
    player = play("--topic", "/image_raw", "--topic", "/tf", "--topic", "/tf_static")
    ear.until(lambda: {"images": "coming", "scan": "missing"}.items() <= words().items())
    player.kill()
    player.wait()
    stopped_s = time.monotonic()
    stale = {"images": "stale", "scan": "missing", "transforms": "stale"}
    told_s = ear.until(lambda: stale.items() <= words().items())
    assert told_s - stopped_s < 2.0
    assert node.poll() is None


def test_a_camera_that_dies_with_a_hand_up_leaves_no_raised_hand(ear, start_node, play):
    node = start_node()
    player = play()
    ear.until(lambda: ear.messages(Output.HAND_RAISED)[-1:] and
              ear.messages(Output.HAND_RAISED)[-1].data, 60.0)  # fmt: skip
    player.kill()
    player.wait()
    died_s = time.monotonic()
    ear.until(lambda: not ear.messages(Output.HAND_RAISED)[-1].data)
    took_s = time.monotonic() - died_s
    print(f"taken back {took_s:.2f} s after the last image")
    assert took_s < 2.0
    ear.until(lambda: ear.statuses()["customers"].message.startswith("nobody is reported"))
    assert ear.messages(Output.TRACKS)[-1].detections == []
    assert node.poll() is None


def tiny(stamp_ns):
    return CameraImage(stamp_ns, "camera_link", np.zeros((8, 8, 3), np.uint8))


BROKEN = {
    Input.IMAGES: [
        b"\0\1\0\0",
        b"\0\1\0\0" + b"\xff" * 60,
        encode(tiny(5 * 10**9)).cdr[:-20],
        encode(tiny(2**31 * 10**9 - 1)).cdr,
        encode(tiny(0)).cdr.replace(b"bgr8", b"fan8"),
    ],
    Input.SCAN: [
        b"\0\1\0\0",
        b"\0\1\0\0" + b"\xff" * 60,
        encode(Scan(5, "laser", -1.0, 1.0, 0.1, 9.0, np.ones(3))).cdr.replace(
            np.float32(-1.0).tobytes(), np.float32(np.nan).tobytes()
        ),
    ],
    Input.TRANSFORMS: [
        b"\0\1\0\0\xff\xff\xff\xff",
        encode(StampedTransform(1, "map", "base_link", RigidTransform((np.nan, 0, 0)))).cdr,
    ],
    Input.CAMERA_INFO: [
        b"\0\1\0\0" + b"\xff" * 60,
        encode(
            CameraInfo(1, "camera_link", 640, 480, CameraModel(1.0, 1.0, 1.0, 1.0))
        ).cdr.replace(np.float64(1.0).tobytes(), np.float64(np.nan).tobytes()),
    ],
}


def test_broken_messages_are_counted_and_the_good_ones_served(ear, start_node):
    node = start_node()
    topics = {Input.IMAGES: ("image_raw", IMAGE), **INPUT_TOPICS}
    reliable = PROFILES[Input.TRANSFORMS]
    publishers = {item: ear.node.publisher(*topics[item], reliable) for item in BROKEN}
    ear.until(lambda: all(publisher.subscribers for publisher in publishers.values()))
    for _ in range(10):
        for item, broken in BROKEN.items():
            for cdr in broken:
                publishers[item].publish(cdr)
                time.sleep(0.005)
    counts = {"images": 40, "scan": 30, "transforms": 20, "camera_info": 10}
    ear.until(
        lambda: all(
            int(ear.statuses()[name].values["malformed"]) >= 0.9 * count
            for name, count in counts.items()
        )
    )
    assert node.poll() is None
    warned = [line for line in node.log().splitlines() if "[WARN" in line]
    assert 4 <= len(warned) <= 24  # once for each kind, of more than a hundred
    before = len(ear.heard[Output.HAND_RAISED])
    for number in range(1, 4):
        publishers[Input.IMAGES].publish(encode(tiny(9 * 10**9 + number * 10**8)).cdr)
        time.sleep(0.1)
    ear.until(lambda: len(ear.heard[Output.HAND_RAISED]) > before)


def test_services_and_parameters_answer_while_it_works(ear, start_node, play, ask):
    start_node()
    release = "/hand_detector/release_customer"
    assert not ask(release, TRIGGER).success
    player = play("--start-offset", 1)
    ear.until(lambda: ear.heard[Output.CUSTOMER_POSE])
    reply = ask(release, TRIGGER)
    assert (reply.success, "customer" in reply.message) == (True, True)
    ear.until(lambda: ear.statuses()["customers"].values["selected_id"] == "none")

    value = build("rcl_interfaces/msg/ParameterValue", type=3, double_value=500.0)
    change = build("rcl_interfaces/msg/Parameter", name="processing_rate", value=value)
    service = "/hand_detector/set_parameters", "rcl_interfaces/srv/SetParameters"
    (result,) = ask(*service, parameters=[change]).results
    assert not result.successful
    assert "at most 240" in result.reason

    assert ask("/hand_detector/enable", SET_BOOL, data=False).message == "disabled"
    ear.until(lambda: ear.statuses()["processing"].message == "disabled")
    ear.until(lambda: not ear.messages(Output.HAND_RAISED)[-1].data)
    assert ask("/hand_detector/enable", SET_BOOL, data=True).success
    before = ear.statuses()["processing"].values["resets"]
    assert ask("/hand_detector/reset", TRIGGER).success
    ear.until(lambda: ear.statuses()["processing"].values["resets"] != before)
    player.kill()


def test_commands_are_followed_and_answered(ear, start_node, play, make_node):
    start_node()
    commands = make_node("waiter").publisher("/hand_detector/command", STRING)
    player = play("--start-offset", 1)
    ear.until(lambda: any(item.detections for item in ear.messages(Output.WAITING_LIST)))
    ear.until(lambda: commands.subscribers)
    for text in ("serve 1", "dance"):
        commands.publish(serialize(build(STRING, data=text)).cdr)
    ear.until(lambda: len(ear.heard[Output.ANSWERS]) == 2)
    assert {item.data.rpartition(": ")[0] for item in ear.messages(Output.ANSWERS)} >= {
        "serve 1: done"
    }
    ear.until(
        lambda: (
            ear.messages(Output.WAITING_LIST)[-1].detections[0].results[0].hypothesis.class_id
            == "being_served"
        )
    )
    player.kill()


def test_a_node_that_was_killed_goes_on_with_its_list(ear, start_node, play, make_node, tmp_path):
    kept = "-p", f"waiting_list_file:={tmp_path / 'calls.json'}"
    node = start_node(*kept)
    commands = make_node("waiter").publisher("/hand_detector/command", STRING)
    player = play("--start-offset", 1)
    ear.until(lambda: any(item.detections for item in ear.messages(Output.WAITING_LIST)))
    ear.until(lambda: commands.subscribers)
    commands.publish(serialize(build(STRING, data="serve 1")).cdr)
    ear.until(lambda: ear.heard[Output.ANSWERS])
    ear.until(lambda: "being_served" in (tmp_path / "calls.json").read_text(encoding="utf-8"))
    node.kill()  # as when the power fails
    player.kill()
    node.wait()
    ear.heard.clear()
    start_node(*kept)
    player = play("--start-offset", 9)
    ear.until(lambda: any(item.detections for item in ear.messages(Output.WAITING_LIST)))
    (anna,) = ear.messages(Output.WAITING_LIST)[-1].detections
    assert (anna.id, anna.results[0].hypothesis.class_id) == ("1", "being_served")
    player.kill()


def test_names_are_remapped_and_the_debug_image_is_drawn_for_who_looks(ear, start_node, play):
    start_node(
        "--ros-args", "-r", "image_raw:=/front/image", "-r", "hand_detection_debug:=~/debug",
        "-p", "processing_rate:=5.0", "--namespace", "/",
    )  # fmt: skip
    pictures = []
    ear.node.subscribe("/hand_detector/debug", IMAGE, pictures.append, PROFILES[Input.IMAGES])
    player = play("--remap", "/image_raw:=/front/image", "--start-offset", 1)
    ear.until(lambda: len(pictures) > 2)
    assert ear.statuses()["processing"].values["wanted_hz"] == "5.0"
    assert ear.statuses()["images"].values["topic"] == "/front/image"
    player.kill()


def test_simulated_time_stamps_the_diagnostics_and_resets_when_it_jumps_back(ear, start_node):
    node = start_node("-p", "use_sim_time:=true")
    clock = ear.node.publisher("/clock", "rosgraph_msgs/msg/Clock")
    ear.until(lambda: clock.subscribers)
    for second in (50, 20):
        cdr = encode_clock(build("builtin_interfaces/msg/Time", sec=second))
        # A clock ticks: of what comes in one go, a reader of depth one sees the last tick alone.
        ear.until(
            lambda cdr=cdr, second=second: (
                clock.publish(cdr)
                or ear.messages(Output.DIAGNOSTICS)[-1].header.stamp.sec == second
            )
        )
    ear.until(lambda: "/clock jumped back by 30.000 s" in node.log())


def encode_clock(now):
    from tracker.messages.types import serialize

    return serialize(build("rosgraph_msgs/msg/Clock", clock=now)).cdr


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_it_ends_at_once_and_takes_a_raised_hand_back(ear, start_node, play, number):
    node = start_node()
    player = play("--start-offset", 2)
    ear.until(lambda: ear.heard[Output.CUSTOMER_POSE])
    began_s = time.monotonic()
    node.send_signal(number)
    assert node.wait(10.0) == 0, node.log()
    assert time.monotonic() - began_s < 5.0
    assert "Traceback" not in node.log()
    ear.until(lambda: not ear.messages(Output.HAND_RAISED)[-1].data)
    player.kill()


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["-p", "procesing_rate:=5.0"], "did you mean `processing_rate`"),
        (["-p", "processing_rate"], "NAME:=VALUE"),
        (["--params-file", "nowhere.yaml"], "nowhere.yaml"),
        (["-r", "image raw:=x"], "image raw"),
    ],
    ids=["misspelled", "no-value", "no-file", "no-name"],
)
def test_words_that_make_no_sense_are_refused(run, model_store, arguments, words):
    node = run("-m", "nodes.dds_hand_detector", *arguments, name="node")
    assert node.wait(60.0) == 2
    assert words in node.log()
    assert "Traceback" not in node.log()


def test_a_file_of_an_earlier_version_starts_with_one_warning(start_node, tmp_path):
    file = tmp_path / "old.yaml"
    file.write_text("/**:\n  ros__parameters: {appearance_weight: 5, measurement_model: polar}\n")
    node = start_node("--params-file", file)
    [line] = [line for line in node.log().splitlines() if "appearance_weight" in line]
    assert line.startswith("[WARNING]")


def test_help_teaches(run):
    node = run("-m", "nodes.dds_hand_detector", "--help", name="node")
    assert node.wait(60.0) == 0
    text = " ".join(node.log().split())  # however wide the terminal is
    for words in ("--params-file", "ROS_DOMAIN_ID", "raised-hand play", "hand_raised"):
        assert words in text
