"""A robot engineer's workspace: colcon finds, builds and tests the package. No ROS is needed."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
PACKAGE = "raised_hand_tracker"
pytestmark = pytest.mark.slow

#: Of setuptools, colcon's `--symlink-install` needs `setup.py develop` as it was before 80.
COLCON = (
    "colcon-core>=0.16,<1",
    "colcon-ros>=0.4,<1",
    "colcon-package-information>=0.4,<1",
    "setuptools>=64,<80",
    "wheel<0.46",
)
LEFT_OUT = shutil.ignore_patterns(
    ".git", ".venv*", ".*_cache", ".hypothesis", "*.egg-info", "__pycache__", "build", "install"
)


@pytest.fixture(scope="module")
def colcon(tmp_path_factory):
    """PyPI's colcon in a folder of its own: it brings pytest plug-ins that nobody else wants."""
    folder = tmp_path_factory.mktemp("colcon")
    got = subprocess.run(
        [sys.executable, "-m", "pip", "install", "--quiet", "--target", folder, *COLCON],
        capture_output=True,
        text=True,
    )
    if got.returncode and not os.environ.get("CI"):
        pytest.skip(f"colcon cannot be installed here: {got.stderr.strip().splitlines()[-1]}")
    assert got.returncode == 0, got.stderr

    def run(*arguments, cwd):
        path = os.pathsep.join(filter(None, [str(folder), os.environ.get("PYTHONPATH")]))
        done = subprocess.run(
            [sys.executable, "-W", "ignore", "-m", "colcon", *arguments],
            cwd=cwd,
            env=os.environ | {"PYTHONPATH": path, "COLCON_HOME": str(folder)},
            capture_output=True,
            text=True,
        )
        assert done.returncode == 0, done.stdout + done.stderr
        return done.stdout + done.stderr

    return run


@pytest.fixture
def workspace(tmp_path):
    shutil.copytree(ROOT, tmp_path / "src" / PACKAGE, ignore=LEFT_OUT)
    return tmp_path


def test_colcon_takes_it_for_a_python_package_of_ros(colcon, workspace):
    # A mistake in package.xml would silently make it an ordinary Python package.
    words = colcon("list", cwd=workspace).split()
    assert words == [PACKAGE, f"src/{PACKAGE}", "(ros.ament_python)"]


@pytest.mark.parametrize("how", [(), ("--symlink-install",)], ids=["copied", "linked"])
def test_a_workspace_is_built_with_everything_ros_looks_for(colcon, workspace, how):
    colcon("build", *how, cwd=workspace)
    prefix = workspace / "install" / PACKAGE
    programs = prefix / "lib" / PACKAGE
    names = {path.name for path in programs.iterdir()}
    assert {"hand_detector", "perception.py", "lifecycle_hand_detector", "raised-hand"} <= names
    assert all(os.access(path, os.X_OK) for path in programs.iterdir())
    share = prefix / "share" / PACKAGE
    for name in (
        "package.xml",
        "config/hand_detector.yaml",
        "config/hand_detector.rviz",
        "launch/hand_detector.launch.py",
        "config/scenes/restaurant.yaml",
    ):
        assert (share / name).is_file(), name
    assert (prefix / "share/ament_index/resource_index/packages" / PACKAGE).is_file()
    said = subprocess.run(
        ["sh", "-c", f". install/setup.sh && '{programs}/raised-hand' --help"],
        cwd=workspace,
        env=os.environ | {"COLCON_CURRENT_PREFIX": str(workspace / "install")},
        capture_output=True,
        text=True,
    )
    assert "replay" in said.stdout, said.stderr


def test_colcon_test_runs_the_tests(colcon, workspace):
    colcon("build", cwd=workspace)
    colcon(
        "test", "--return-code-on-test-failure", "--pytest-args", "tests/nodes/shared/test_qos.py",
        cwd=workspace,
    )  # fmt: skip
    report = workspace / "build" / PACKAGE / "pytest.xml"
    assert 'tests="3"' in report.read_text(encoding="utf-8")
