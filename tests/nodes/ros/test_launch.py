"""The launch file, started by `ros2 launch` as colcon would have installed it."""

import os
import shutil
import signal
import subprocess
import sys

import pytest

pytest.importorskip("rclpy", reason="rclpy cannot be imported: no ROS 2 is sourced here")

from pathlib import Path

ROOT = Path(__file__).parents[3]
ROS2 = shutil.which("ros2")

pytestmark = [
    pytest.mark.slow,
    pytest.mark.model,
    pytest.mark.skipif(ROS2 is None, reason="the command ros2 is not there"),
]


@pytest.fixture
def installed(tmp_path, monkeypatch):
    """The package in a prefix of its own."""
    share = tmp_path / "share/raised_hand_tracker"
    for folder in ("launch", "config"):
        shutil.copytree(ROOT / folder, share / folder)
    shutil.copy(ROOT / "package.xml", share)
    index = tmp_path / "share/ament_index/resource_index/packages"
    index.mkdir(parents=True)
    (index / "raised_hand_tracker").touch()
    programs = tmp_path / "lib/raised_hand_tracker"
    programs.mkdir(parents=True)
    for name in ("hand_detector", "lifecycle_hand_detector"):
        program = programs / name
        program.write_text(f'#!/bin/sh\nexec {sys.executable} -m nodes.{name} "$@"\n')
        program.chmod(0o755)
    prefixes = f"{tmp_path}{os.pathsep}{os.environ['AMENT_PREFIX_PATH']}"
    monkeypatch.setenv("AMENT_PREFIX_PATH", prefixes)
    monkeypatch.setenv("PYTHONPATH", f"{ROOT}{os.pathsep}{os.environ.get('PYTHONPATH', '')}")
    monkeypatch.setenv("TMPDIR", str(tmp_path / "tmp"))
    (tmp_path / "tmp").mkdir()
    return tmp_path


@pytest.fixture
def launch(installed):
    """Starts the launch file; it is interrupted in the end, and must leave no file behind."""
    processes = []

    def start(*arguments):
        command = [ROS2, "launch", "raised_hand_tracker", "hand_detector.launch.py", *arguments]
        processes.append(subprocess.Popen(command, start_new_session=True))

    yield start
    for process in processes:
        os.killpg(process.pid, signal.SIGINT)
        assert process.wait(20.0) == 0
    left = [path.name for path in (installed / "tmp").iterdir()]
    assert not [name for name in left if not name.startswith(".")]


def values(ear, node, *names):
    from rcl_interfaces.srv import GetParameters
    from rclpy.parameter import parameter_value_to_python

    request = GetParameters.Request(names=names)
    answer = ear.call(GetParameters, f"{node}/get_parameters", request)
    return [parameter_value_to_python(value) for value in answer.values]


@pytest.mark.parametrize(
    "section",
    ["hand_detector:", "robot1:\n hand_detector:", "/robot1/hand_detector:", "/**:"],
    ids=["bare", "nested", "full", "wildcard"],
)
def test_a_parameter_file_counts_in_a_namespace(ear, launch, installed, model_store, section):
    file = installed / "robot.yaml"
    file.write_text(
        f"{section}\n  ros__parameters:\n    fixed_frame: odom\n    pose_max_std_m: 1e-1\n"
    )
    launch(f"params_file:={file}", "namespace:=robot1", "use_sim_time:=true", "tf_topic:=tf")
    names = ("fixed_frame", "pose_max_std_m", "use_sim_time")
    assert values(ear, "robot1/hand_detector", *names) == ["odom", 0.1, True]
    heard = {"/robot1/tf", "/tf_static", "/robot1/scan"}

    def listened():
        found = ear.node.get_subscriber_names_and_types_by_node("hand_detector", "/robot1")
        return {topic for topic, _ in found}

    ear.until(lambda: heard <= listened())


def test_the_node_starts_with_the_packages_own_parameters(ear, launch, model_store):
    launch("image_transport:=compressed")
    names = ("fixed_frame", "image_transport", "use_sim_time")
    assert values(ear, "hand_detector", *names) == ["map", "compressed", False]
