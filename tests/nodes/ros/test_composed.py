"""The node in somebody else's program."""

import pytest

pytest.importorskip("rclpy", reason="rclpy cannot be imported: no ROS 2 is sourced here")

from pathlib import Path

from nodes.shared.topics import Output

pytestmark = [pytest.mark.slow, pytest.mark.model]

PROGRAM = Path(__file__).parent / "composed.py"


def test_it_takes_the_options_of_any_node_and_takes_a_hand_back_after_ctrl_c(
    ear, run, play, model_store, interrupt
):
    from diagnostic_msgs.msg import DiagnosticArray
    from std_msgs.msg import Bool

    from nodes.ros.wiring import _qos
    from nodes.shared.qos import PROFILES

    raised, reports = [], []
    qos = _qos(PROFILES[Output.HAND_RAISED])
    ear.node.create_subscription(Bool, "robot1/hand_raised", lambda m: raised.append(m.data), qos)
    ear.node.create_subscription(DiagnosticArray, "/diagnostics", reports.append, 10)
    program = run(PROGRAM, name="program")
    ear.until(lambda: reports or program.poll() is not None, 60.0)
    assert program.poll() is None, program.log()
    statuses = {status.name: status for status in reports[-1].status}
    assert {status.hardware_id for status in statuses.values()} == {"robot1/waiter"}
    values = {item.key: item.value for item in statuses["robot1/waiter: processing"].values}
    assert values["wanted_hz"] == "7.0"

    player = play("--wait-for", "/image_raw")
    ear.until(lambda: any(raised))
    status, took_s = interrupt(program)
    print(f"ended after {took_s:.2f} s")
    assert status == 0, program.log()
    assert "RCLError" not in program.log()
    assert "Traceback" not in program.log()
    ear.until(lambda: not raised[-1])
    player.kill()
