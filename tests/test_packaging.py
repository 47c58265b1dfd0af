"""setup.py, pyproject.toml and package.xml tell one story."""

import ast
import re
import sys
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import pytest

if sys.version_info < (3, 11):
    pytest.skip("tomllib came with Python 3.11", allow_module_level=True)
import tomllib

ROOT = Path(__file__).parents[1]
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]


def setup_arguments():
    """The literal arguments of the call of setup(), read without running it."""
    tree = ast.parse((ROOT / "setup.py").read_text(encoding="utf-8"))
    call = next(
        node
        for node in ast.walk(tree)
        if isinstance(node, ast.Call) and getattr(node.func, "id", "") == "setup"
    )
    arguments = {}
    for keyword in call.keywords:
        try:
            arguments[keyword.arg] = ast.literal_eval(keyword.value)
        except ValueError:
            continue  # computed, such as the packages
    return arguments


def test_setup_and_pyproject_agree():
    arguments = setup_arguments()
    assert arguments["name"] == PROJECT["name"]
    assert arguments["version"] == PROJECT["version"]
    assert arguments["python_requires"] == PROJECT["requires-python"]
    assert arguments["extras_require"]["test"] == PROJECT["optional-dependencies"]["test"]
    scripts = dict(line.split(" = ") for line in arguments["entry_points"]["console_scripts"])
    assert scripts == PROJECT["scripts"]


def test_the_ros_package_has_the_same_version_license_and_description():
    package = ElementTree.parse(ROOT / "package.xml").getroot()
    assert package.findtext("name") == "raised_hand_tracker"
    assert package.findtext("version") == PROJECT["version"]
    assert package.findtext("license") == PROJECT["license"]["text"]
    assert package.findtext("description") == PROJECT["description"]
    assert package.find("maintainer").get("email") == PROJECT["authors"][0]["email"]


def test_rosdep_is_asked_only_for_what_it_can_install_on_ubuntu():
    package = ElementTree.parse(ROOT / "package.xml").getroot()
    keys = {item.text for item in package.iter("exec_depend")}
    # Ubuntu 24.04 lets rosdep install nothing with pip, and a whole installation fails by it.
    assert [key for key in keys if key.endswith("-pip")] == []
    ours = " ".join(PROJECT["dependencies"]).lower()
    modules = {key.removeprefix("python3-") for key in keys if key.startswith("python3-")}
    assert modules - {"venv", "yaml"} <= set(re.findall(r"[a-z0-9]+", ours))


def test_every_ros_package_that_the_nodes_import_is_named():
    package = ElementTree.parse(ROOT / "package.xml").getroot()
    keys = {item.text for item in package.iter("exec_depend")} | {"tf2_ros"}  # of tf2_ros_py
    sources = [*(ROOT / "nodes").rglob("*.py"), *(ROOT / "launch").glob("*.py")]
    ros = r"rclpy|tf2_\w+|launch\w*|ament_\w+|\w+_interfaces|\w+_msgs|\w+_srvs"
    words = rf"^ *(?:from|import) ({ros})\b"
    imported = {
        name
        for path in sources
        for name in re.findall(words, path.read_text(encoding="utf-8"), re.M)
    }
    assert {"rclpy", "sensor_msgs", "launch_ros"} <= imported <= keys


def test_the_resource_marker_bears_the_packages_name():
    assert (ROOT / "resource/raised_hand_tracker").is_file()


def test_every_dependency_has_an_upper_bound():
    optional = [item for items in PROJECT["optional-dependencies"].values() for item in items]
    assert [
        item
        for item in [*PROJECT["dependencies"], *optional]
        if "<" not in item and "==" not in item
    ] == []


def test_the_changelog_has_this_version_or_unreleased_work():
    changelog = (ROOT / "CHANGELOG.md").read_text(encoding="utf-8")
    assert f"## [{PROJECT['version']}]" in changelog or "## [Unreleased]" in changelog
