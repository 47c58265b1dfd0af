"""The lifecycle node: what its states allow, report and let go."""

import time
from pathlib import Path

import numpy as np
import pytest

pytest.importorskip("rclpy", reason="rclpy cannot be imported: no ROS 2 is sourced here")

from nodes.shared.topics import Output

pytestmark = [pytest.mark.slow, pytest.mark.model]


@pytest.fixture
def managed(ear, run, model_store):
    """A lifecycle node; `change` it, `put` a parameter, and see its `memory_mb` and `threads`."""
    from lifecycle_msgs.msg import Transition
    from lifecycle_msgs.srv import ChangeState
    from rcl_interfaces.srv import SetParameters
    from rclpy.parameter import Parameter

    node = run("-m", "nodes.lifecycle_hand_detector", name="node")

    def change(*names):
        for name in names:
            number = getattr(Transition, f"TRANSITION_{name.upper()}")
            request = ChangeState.Request(transition=Transition(id=number))
            assert ear.call(ChangeState, "hand_detector/change_state", request).success, node.log()

    def put(name, value):
        parameter = Parameter(name, value=value).to_parameter_msg()
        request = SetParameters.Request(parameters=[parameter])
        (result,) = ear.call(SetParameters, "hand_detector/set_parameters", request).results
        return result.successful, result.reason

    def status(name):
        lines = Path(f"/proc/{node.pid}/status").read_text(encoding="utf-8").splitlines()
        return next(int(line.split()[1]) for line in lines if line.startswith(name))

    node.change, node.put = change, put
    node.memory_mb = lambda: status("VmRSS") / 1024
    node.threads = lambda: status("Threads")
    return node


def test_before_configure_parameters_are_checked_and_all_may_change(managed):
    is_set, why = managed.put("ranging", "guess")
    assert not is_set
    assert "one of person, spec" in why
    assert managed.put("fixed_frame", "odom") == (True, "")
    assert managed.put("processing_rate", 5) == (True, "")
    managed.change("configure")
    is_set, why = managed.put("fixed_frame", "map")
    assert not is_set
    assert "cannot change while the node runs" in why
    assert managed.put("processing_rate", 6.0) == (True, "")
    managed.change("cleanup")
    assert managed.put("fixed_frame", "map") == (True, "")


def test_an_inactive_node_reports_no_error(managed, ear, play):
    def levels():
        return {name: item.level for name, item in ear.statuses().items()}

    managed.change("configure")
    ear.until(levels)
    assert set(levels().values()) == {0}, ear.statuses()
    time.sleep(1.5)
    ear.forget()
    managed.change("activate")
    player = play("--wait-for", "/image_raw")
    ear.until(lambda: ear.messages(Output.HAND_RAISED))
    managed.change("deactivate")
    player.kill()
    time.sleep(2.5)
    ear.forget()
    ear.until(levels)
    assert set(levels().values()) == {0}, ear.statuses()
    assert ear.statuses()["images"].message == "disabled"


def test_ten_rounds_leave_nothing_behind(managed, ear, play):
    player = play("--loop", 40)
    memory_mb, threads = [], []
    for _ in range(13):
        ear.forget()
        managed.change("configure", "activate")
        ear.until(lambda: len(ear.heard[Output.HAND_RAISED]) >= 3)
        managed.change("deactivate", "cleanup")
        memory_mb.append(managed.memory_mb())
        threads.append(managed.threads())
    player.kill()
    print("MB after each round:", *(f"{value:.0f}" for value in memory_mb), "threads:", threads)
    assert np.median(threads[-4:]) == np.median(threads[1:5])
    # Models held would be some 45 MB a round; a round ends with more or less on its way.
    assert np.median(memory_mb[-4:]) < np.median(memory_mb[1:5]) + 60.0
