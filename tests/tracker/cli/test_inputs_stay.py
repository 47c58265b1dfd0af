"""No command writes over what it reads."""

import os
from pathlib import Path

import cv2
import numpy as np
import pytest

from tracker.config_file import default_yaml
from tracker.simulation import scene_names

SCENES = Path(__file__).parents[3] / "config/scenes"


@pytest.fixture
def things(tmp_path):
    """Inputs of every kind, each with a link of an output's name; their bytes."""
    (tmp_path / "drive.mcap").write_bytes(b"a drive" * 99)
    (tmp_path / "robot.yaml").write_text(default_yaml())
    (tmp_path / "walk.csv").write_text("t_s,id,x_m,y_m\n0,1,0,0\n1,1,1,0\n")
    (tmp_path / "scene.yaml").write_text((SCENES / f"{scene_names()[0]}.yaml").read_text())
    (tmp_path / "photos").mkdir()
    cv2.imwrite(str(tmp_path / "photos/a.png"), np.zeros((48, 64, 3), np.uint8))
    (tmp_path / "photos/labels.csv").write_text("file,raised\na.png,0\n")
    out = tmp_path / "out"
    out.mkdir()
    os.link(tmp_path / "drive.mcap", out / "output.mcap")
    os.symlink("../robot.yaml", out / "best.yaml")
    os.link(tmp_path / "walk.csv", out / "trials.csv")
    os.link(tmp_path / "scene.yaml", out / "recording.mcap")
    os.link(tmp_path / "photos/a.png", out / "contact_sheet.png")

    def contents():
        files = [file for file in tmp_path.rglob("*") if file.is_file()]
        return {file: file.read_bytes() for file in files}

    return contents


@pytest.mark.parametrize(
    "words",
    [
        "replay drive.mcap -o out",
        "replay out/output.mcap -o out",
        "replay drive.mcap -o new --report drive.mcap",
        "replay drive.mcap -o new --save-view photos/../drive.mcap",
        "replay drive.mcap -o new -c robot.yaml --report robot.yaml",
        "replay drive.mcap -o new --report new/summary.json",
        "replay photos -o photos",
        "replay photos -o new --report photos/page.html",
        "demo scene.yaml -o out",
        "simulate scene.yaml -o scene.yaml --force",
        "simulate out/recording.mcap -o out/recording.mcap --force",
        "tune rough -c robot.yaml -o out",
        "tune rough -c robot.yaml -o new --report robot.yaml",
        "tune drive.mcap -o new --report drive.mcap",
        "monte-carlo people --paths walk.csv --out out",
        "monte-carlo people -c robot.yaml --report robot.yaml",
        "evaluate photos -o photos",
        "evaluate photos -o out",
    ],
)
def test_an_output_in_the_place_of_an_input_is_refused_before_the_work(run, things, words):
    before = things()
    status, _, error = run(*words.split())
    assert status == 2
    assert "choose another" in error
    assert things() == before
