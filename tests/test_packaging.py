"""setup.py, pyproject.toml and package.xml tell one story."""

import ast
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
