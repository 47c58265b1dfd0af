"""The commands that documentation, image and checks name are there, with their options."""

import json
import re
import shlex
from pathlib import Path

import pytest
import yaml
from typer.main import get_command

from tracker.cli.commands import app

ROOT = Path(__file__).parents[1]
PAGES = [
    ROOT / "README.md",
    ROOT / "CONTRIBUTING.md",
    *sorted((ROOT / "docs").glob("*.md")),
    *sorted((ROOT / "notebooks").glob("*.md")),
]
FILES = [
    ROOT / "Dockerfile",
    ROOT / "docker/entrypoint.sh",
    ROOT / ".devcontainer/devcontainer.json",
    ROOT / ".github/workflows/checks.yml",
]


def console_lines(page):
    """What a page tells to type, without the prompt; continued lines as one."""
    for block in re.findall(r"```console\n(.*?)```", page.read_text(encoding="utf-8"), re.DOTALL):
        for line in block.replace("\\\n", " ").splitlines():
            if line.startswith("$ "):
                yield line.removeprefix("$ ")


def commands(pages, program):
    """The words that follow a program's name, for each time it is typed."""
    for page in pages:
        for line in console_lines(page):
            words = shlex.split(line, comments=True)
            starts = [place for place, word in enumerate(words) if word == program]
            yield from (words[place + 1 :] for place in starts)


@pytest.mark.parametrize("words", [*commands(PAGES, "raised-hand")], ids=" ".join)
def test_a_command_of_the_documentation_is_there_with_its_options(words):
    command, rest = get_command(app), list(words)
    while rest and rest[0] in getattr(command, "commands", {}):
        command = command.commands[rest.pop(0)]
    assert not hasattr(command, "commands") or all(word.startswith("-") for word in rest)
    known = {"--help", "-h"} | {option for item in command.params for option in item.opts}
    named = {word.partition("=")[0] for word in rest if re.match(r"--?[a-z]", word)}
    assert named <= known


def test_every_option_of_live_stands_in_the_documentation():
    running = (ROOT / "docs/running.md").read_text(encoding="utf-8")
    for item in get_command(app).commands["live"].params:
        options = [*item.opts, *item.secondary_opts] if item.opts[0].startswith("-") else []
        assert not options or any(f"`{option}" in running for option in options), item.name


def test_every_topic_that_a_replay_writes_stands_in_the_documentation():
    source = (ROOT / "tracker/replay/outputs.py").read_text(encoding="utf-8")
    running = (ROOT / "docs/running.md").read_text(encoding="utf-8")
    names = re.findall(r'"/\{NODE_NAME\}/(\w+)"', source)
    assert {"tracks", "waiting_list"} <= set(names)
    assert [name for name in names if f"`/hand_detector/{name}`" not in running] == []


def targets():
    return set(re.findall(r"^([a-z]+):", (ROOT / "Makefile").read_text(encoding="utf-8"), re.M))


def test_every_target_of_make_that_is_named_is_there():
    named = {words[0] for words in commands(PAGES, "make")}
    for path in FILES:
        named |= set(re.findall(r"\bmake ([a-z]+)", path.read_text(encoding="utf-8")))
    assert {"demo", "setup", "test"} <= named <= targets()


def extras(text):
    return set(re.findall(r"\.\[([a-z,]+)\]", text))


def test_every_extra_that_is_named_is_there():
    there = set(
        re.findall(r"^([a-z]+) = \[", (ROOT / "pyproject.toml").read_text(encoding="utf-8"), re.M)
    )
    for path in [*PAGES, *FILES]:
        for names in extras(path.read_text(encoding="utf-8")):
            assert set(names.split(",")) <= there, path


def test_every_file_that_the_image_takes_is_there_and_nothing_that_it_needs_is_left_out():
    lines = (ROOT / ".dockerignore").read_text(encoding="utf-8").splitlines()
    sent = {line.removeprefix("!") for line in lines if line.startswith("!")}
    assert all((ROOT / name).exists() for name in sent)
    needed = {"tracker", "nodes", "config", "launch", "resource", "package.xml"}
    assert needed | {"setup.py", "setup.cfg", "pyproject.toml", "README.md"} <= sent
    dockerfile = (ROOT / "Dockerfile").read_text(encoding="utf-8")
    for source in re.findall(r"^COPY (?:--\S+ )?(\S+) ", dockerfile, re.M):
        assert source == "." or source.partition("/")[0] in sent


def test_the_image_starts_programs_and_a_launch_file_that_are_there():
    dockerfile = (ROOT / "Dockerfile").read_text(encoding="utf-8")
    scripts = (ROOT / "pyproject.toml").read_text(encoding="utf-8")
    programs = re.findall(r"\.\./\.\./bin/(\w+)", dockerfile)
    assert programs
    assert all(f"\n{name} = " in scripts for name in programs)
    (start,) = re.findall(r"^CMD (.*)", dockerfile, re.M)
    assert (ROOT / "launch" / json.loads(start)[-1]).is_file()


def test_the_checks_and_the_development_container_use_the_image_s_stages_and_files():
    container = json.loads((ROOT / ".devcontainer/devcontainer.json").read_text(encoding="utf-8"))
    dockerfile = (ROOT / "Dockerfile").read_text(encoding="utf-8")
    assert f" AS {container['build']['target']}\n" in dockerfile
    workflow = yaml.safe_load((ROOT / ".github/workflows/checks.yml").read_text(encoding="utf-8"))
    text = json.dumps(workflow)
    assert "bash .ci/run" in text
    assert (ROOT / ".ci/run").is_file()
    assert workflow["jobs"]["with_ros"]["container"] in dockerfile


def test_the_numpy_of_ros_is_the_same_everywhere():
    assert "numpy==1.26." in (ROOT / "Dockerfile").read_text(encoding="utf-8")
    for path in (ROOT / ".ci/run", *FILES[2:]):
        assert "NUMPY=1.26.4" in path.read_text(encoding="utf-8"), path
