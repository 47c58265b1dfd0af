"""examples/waiter.py beside `raised-hand-dds`, in processes and on the wire, in real time."""

import time

import pytest

pytest.importorskip("cyclonedds", reason="the extra dds is not installed")

from nodes.shared.topics import Output
from tracker.messages.types import STRING, build, serialize

pytestmark = [pytest.mark.slow, pytest.mark.model]

SERVICE_S = 4.0


@pytest.mark.parametrize(("scene", "drive_s"), [("restaurant", 11.0), ("bistro", 18.0)])
def test_everybody_who_called_is_served_once_in_order(
    ear, start_node, run, make_node, waiter_class, scene_recording, guests_of, scene, drive_s
):
    played, path = scene_recording(scene)
    guests = guests_of(played)
    order = guests.order(drive_s + SERVICE_S)
    start_node("-p", "image_transport:=compressed")
    commands = make_node("waiter").publisher("/hand_detector/command", STRING)
    ends_s = []
    waiter = waiter_class(
        say=lambda text: commands.publish(serialize(build(STRING, data=text)).cdr),
        drive=lambda pose, frame: ends_s.append(time.monotonic() + drive_s),
        service_s=SERVICE_S,
    )
    player = run("-m", "tracker.cli", "play", path, "--best-effort", "--delay", 2, name="player")
    until_s = time.monotonic() + played.duration_s + len(order) * (drive_s + SERVICE_S) + 30.0
    while len(waiter.served) < len(order) or player.poll() is None or waiter._wish:
        now_s = time.monotonic()
        assert now_s < until_s, f"served: {waiter.served}"
        if ear.heard[Output.WAITING_LIST]:
            waiter.hear(ear.messages(Output.WAITING_LIST)[-1])
            del ear.heard[Output.WAITING_LIST][:-1]
        if ends_s and now_s >= ends_s[0]:
            ends_s.clear()
            waiter.arrived(True, now_s)
        waiter.think(now_s)
        time.sleep(0.1)
    places = {
        person.id: (
            person.results[0].pose.pose.position.x, person.results[0].pose.pose.position.y
        )
        for person in ear.messages(Output.WAITING_LIST)[-1].detections
    }  # fmt: skip
    assert guests.known_as(waiter.served, places) == order
