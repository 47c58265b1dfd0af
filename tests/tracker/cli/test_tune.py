import json
import sys

import pytest

from tracker.config import Config

pytest.importorskip("optuna", reason="Optuna is not installed")
QUICK = ("--scenes", 2, "--scene-s", 1, "--unseen", 2, "-j", 1)


def test_alone_it_lists_scenarios_and_parameters(run):
    status, output, _ = run("tune")
    assert status == 0
    for word in ("cheap-lidar", "acceleration_density", "process"):
        assert word in output
    assert "model-matched" not in output


def test_it_writes_the_winner_as_a_file_that_loads(run, tmp_path):
    words = (
        "--params",
        "range_std_m,life",
        *QUICK,
        "-n",
        2,
        "-p",
        "motion:=cv",
        "--json",
        "--report",
        "page.html",
    )
    status, output, _ = run("tune", "people", *words)
    assert status == 0
    found = json.loads(output)
    assert found["trials"] == 2
    assert found == json.loads((tmp_path / "tuning/tuning.json").read_text())
    page = (tmp_path / "page.html").read_text(encoding="utf-8")
    assert "Tuned on people" in page
    assert "range_std_m" in page
    best, default = Config.from_yaml(tmp_path / "tuning/best.yaml"), Config()
    changed = {name for name, value in best if value != getattr(default, name)}
    assert best.motion == "cv"
    assert changed <= {"motion", *found["parameters"]}


@pytest.mark.parametrize(
    ("words", "named"),
    [
        (("moonbase",), "moonbase"),
        (("people", "--params", "speed"), "`speed` cannot be tuned"),
        (("outliers",), "outliers has no tracks"),
        (("people", "-n", 1, "--storage", "nonsense"), "--storage nonsense"),
        (("people", "-p", "gate_probability:=2.0"), "gate_probability"),
    ],
)
def test_what_it_cannot_do_is_one_line_and_status_2(run, words, named):
    status, _, error = run("tune", *words, *QUICK)
    lines = [line for line in error.splitlines() if line.startswith("raised-hand: ")]
    assert status == 2
    assert len(lines) == 1
    assert named in lines[0]


def test_without_optuna_it_says_so_before_anything_begins(run, tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "optuna", None)
    status, _, error = run("tune", "people", *QUICK)
    assert status == 2
    assert ".[tune]" in error
    assert "Trying" not in error
    assert not (tmp_path / "tuning").exists()
