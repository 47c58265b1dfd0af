import json
import os
import subprocess
import sys

import cv2
import numpy as np
import pytest
from typer.main import get_command

import tracker
from tracker import CameraImage
from tracker.cli.commands import app
from tracker.perception.models import ModelStore
from tracker.recording import RecordingWriter


def complaint(error):
    """The one line of a failure."""
    lines = [line for line in error.splitlines() if line.startswith("raised-hand: ")]
    assert len(lines) == 1, error
    assert "Traceback" not in error
    return lines[0]


@pytest.mark.parametrize(
    "words",
    [
        (),
        ("demo",),
        ("live",),
        ("replay",),
        ("simulate",),
        ("monte-carlo",),
        ("tune",),
        ("parameters",),
        ("evaluate",),
        ("models",),
        ("models", "fetch"),
        ("models", "list"),
    ],
)
def test_help_explains_every_command(run, words):
    status, output, _ = run(*words, "--help")
    assert status == 0
    assert "Usage" in output


def test_paragraphs_of_a_help_are_left_to_the_terminal_to_wrap():
    def texts(group):
        for command in getattr(group, "commands", {}).values():
            yield command.help or ""
            yield from texts(command)

    paragraphs = [part for text in texts(get_command(app)) for part in text.split("\n\n")]
    assert len(paragraphs) > 20
    assert [part for part in paragraphs if "\n" in part and not part.startswith(" ")] == []


@pytest.mark.parametrize("program", ["raised-hand", "raised-hand-dds"])
def test_every_program_tells_its_version(run, capsys, monkeypatch, program):
    if program == "raised-hand":
        status, output, _ = run("--version")
    else:
        pytest.importorskip("cyclonedds", reason="the extra dds is not installed")
        from nodes.raised_hand_dds import main

        monkeypatch.setattr(sys, "argv", [program, "--version"])
        with pytest.raises(SystemExit) as stopped:
            main()
        status, output = stopped.value.code, capsys.readouterr().out
    assert status == 0
    assert output == f"raised-hand-tracker {tracker.__version__}\n"


@pytest.mark.parametrize(
    ("typed", "offered"),
    [("raised-hand mon", "monte-carlo"), ("raised-hand parameters gate_", "gate_probability")],
)
def test_the_shell_completes_commands_and_parameters(typed, offered):
    # A process of its own: completion goes by the name of the running program.
    program = "import sys; sys.argv = ['raised-hand']; from tracker.cli.app import main; main()"
    asked = {
        "_RAISED_HAND_COMPLETE": "complete_bash",
        "COMP_WORDS": typed,
        "COMP_CWORD": str(len(typed.split()) - 1),
    }
    answer = subprocess.run(
        [sys.executable, "-c", program], env=os.environ | asked, capture_output=True, text=True
    )
    assert (answer.stdout, answer.stderr) == (f"{offered}\n", "")


def test_the_list_of_models_cuts_no_name(run):
    _, output, _ = run("models", "list")
    assert "…" not in output
    assert f"in {ModelStore().directory}\n" in output


def test_an_unknown_command_is_a_usage_error(run):
    status, _, error = run("dance")
    assert status == 2
    assert "dance" in error


@pytest.mark.parametrize(
    ("yaml", "named"),
    [
        ("hand_detector:\n  ros__parameters:\n    procesing_rate: 5.0\n", "procesing_rate"),
        ("hand_detector:\n  ros__parameters:\n    processing_rate: fast\n", "'fast'"),
        ("hand_detector:\n  ros__parameters:\n    processing_rate: -1.0\n", "-1.0"),
        ("hand_detector: [\n", "line"),
    ],
    ids=["typo", "wrong type", "out of range", "broken"],
)
@pytest.mark.model
def test_a_wrong_parameter_file_is_one_line_and_status_2(run, tmp_path, model_store, yaml, named):
    (tmp_path / "wrong.yaml").write_text(yaml)
    (tmp_path / "photos").mkdir()
    status, _, error = run("replay", "photos", "--config", "wrong.yaml")
    assert status == 2
    assert named in complaint(error)


@pytest.mark.parametrize(
    ("assignment", "named"),
    [
        ("lower_streak:=[", "-p lower_streak:=[: is not YAML"),
        ("lower_streak:=%x", "is not YAML"),
        ("lower_streak:=*x", "`*x`, which is not defined"),
        ("lower_streak:=2031-02-03", "'2031-02-03'; allowed is a whole number"),
        ("lower_streak:={a: 1}", "{'a': 1}; allowed is a whole number"),
        ("lower_streak:=3e0", "3.0; allowed is a whole number"),
        ("lower_streak:=" + "[" * 5000, "nest"),
        ("lower_streak:=" + "9" * 5000, "allowed is a whole number"),
        ("amcl:lower_streak:=3", "for the node /amcl"),
        ("measurement_model:=polar", "`measurement_model` is no longer there: measurements"),
    ],
)
def test_a_wrong_assignment_is_one_line_and_status_2(run, assignment, named):
    status, _, error = run("monte-carlo", "outliers", "-n", 1, "-p", assignment)
    assert status == 2
    assert named in complaint(error)


@pytest.mark.model
def test_a_parameter_file_of_an_earlier_version_costs_one_line(run, tmp_path, model_store):
    old = "/**:\n  ros__parameters: {appearance_weight: 0.5, measurement_model: polar}\n"
    (tmp_path / "old.yaml").write_text(old)
    (tmp_path / "photos").mkdir()
    cv2.imwrite(str(tmp_path / "photos" / "gray.png"), np.full((120, 160, 3), 128, np.uint8))
    _, usual_output, usual_error = run("replay", "photos")
    status, output, error = run("replay", "photos", "--config", "old.yaml")
    assert (status, output) == (0, usual_output)
    [line] = set(error.splitlines()) - set(usual_error.splitlines())
    assert error.count(line) == 1
    assert line.startswith("note: old.yaml: ")
    assert "`appearance_weight` (comparing" in line
    assert "`measurement_model` (measurements" in line


@pytest.mark.model
def test_bad_recordings_are_one_line_and_status_1(run, tmp_path, model_store):
    (tmp_path / "broken.bag").write_bytes(b"#ROSBAG V2.0\nnonsense")
    (tmp_path / "broken.db3").write_bytes(b"SQLite format 3\0" + bytes(50))
    (tmp_path / "broken.mcap").write_bytes(b"\x89MCAP0\r\n")
    (tmp_path / "broken.mp4").write_bytes(b"no video at all")
    (tmp_path / "empty").mkdir()
    for name in ("broken.bag", "broken.db3", "broken.mcap", "broken.mp4", "empty"):
        status, _, error = run("replay", name)
        assert status == 1, name
        assert name in complaint(error)


def test_a_recording_that_is_not_there_is_a_usage_error(run):
    status, _, error = run("replay", "nowhere.mcap")
    assert status == 2
    assert "nowhere.mcap" in complaint(error)


def test_an_unknown_scene_is_a_usage_error_that_names_those_there_are(run):
    status, _, error = run("simulate", "moonbase", "--out", "x.mcap")
    assert status == 2
    assert "moonbase" in complaint(error)
    assert "restaurant" in error


def test_a_simulation_with_a_camera_s_name_is_a_usage_error_that_names_the_option(run):
    status, _, error = run("live", "--simulated", "bistro")
    assert status == 2
    assert "--scene bistro" in complaint(error)


def test_a_recording_is_not_overwritten_without_being_told(run, tmp_path):
    (tmp_path / "there.mcap").write_bytes(b"precious")
    status, _, error = run("simulate", "lonely", "--out", "there.mcap")
    assert status == 1
    assert "there.mcap" in complaint(error)
    assert (tmp_path / "there.mcap").read_bytes() == b"precious"


def test_monte_carlo_prints_the_scenarios_there_are(run):
    status, output, _ = run("monte-carlo")
    assert status == 0
    assert "model-matched" in output
    assert "hands-down" in output


def test_monte_carlo_tells_what_it_found_and_writes_it(run, tmp_path):
    status, output, _ = run("monte-carlo", "outliers", "-n", 30, "--out", "study")
    assert status == 0
    assert "RMSE / Cramer-Rao bound" in output
    assert (tmp_path / "study/study.png").stat().st_size > 10_000
    status, again, _ = run("monte-carlo", "outliers", "-n", 30, "--json")
    assert status == 0
    assert json.loads(again) == json.loads((tmp_path / "study/study.json").read_text())


def test_monte_carlo_goes_on_in_its_folder_and_refuses_another_study_s(run, tmp_path):
    words = ("monte-carlo", "outliers", "--out", "study", "--format", "parquet")
    for trials in (20, 30):
        status, _, error = run(*words, "-n", trials)
        assert status == 0, error
    assert len((tmp_path / "study/trials.csv").read_text().splitlines()) == 31
    assert (tmp_path / "study/trials.parquet").exists()
    status, _, error = run(*words, "-n", 30, "--seed", 2)
    assert status == 2
    assert "seed is 1 in the folder and 2 now" in complaint(error)


def test_monte_carlo_takes_parameters(run):
    words = ("monte-carlo", "outliers", "-n", 30, "--json")
    usual = json.loads(run(*words)[1])
    gaussian = json.loads(run(*words, "-p", "outlier_dof:=0.0")[1])
    assert gaussian["figures"][1]["value"] > usual["figures"][1]["value"]


@pytest.mark.parametrize(
    ("words", "named"),
    [
        (("moonbase",), "moonbase"),
        (("people", "-p", "gate_probability:=2.0"), "gate_probability"),
        (("outliers", "--paths", "x.csv"), "--paths"),
        (("people", "-n", 1, "--paths", "nowhere.csv"), "nowhere.csv"),
        (("people", "--executor", "threads"), "expected processes, or an address"),
        (("people", "--format", "parquet"), "--out FOLDER"),
    ],
)
def test_what_monte_carlo_cannot_do_is_one_line_and_status_2(run, words, named):
    status, _, error = run("monte-carlo", *words)
    assert status == 2
    assert named in complaint(error)


@pytest.mark.model
def test_the_lonely_guest_s_raised_hand_is_found_by_the_demo(run, tmp_path, model_store):
    status, output, _ = run("demo", "lonely", "--json")
    assert status == 0
    evaluation = json.loads(output)["evaluation"]
    (episode,) = evaluation["episodes"]
    assert evaluation["invented"] == []
    assert episode["reported_after_frames"] <= 3
    assert episode["position_error_m"] <= 0.3
    assert (tmp_path / "demo/overview.png").exists()


@pytest.mark.model
def test_zero_sized_images_are_one_line_and_status_1(run, tmp_path, model_store):
    from tracker.messages import encode
    from tracker.messages.types import build, serialize

    with RecordingWriter(tmp_path / "in.mcap") as writer:
        good = CameraImage(10**9, "camera_link", np.zeros((48, 64, 3), np.uint8))
        empty = build("sensor_msgs/msg/Image", encoding="bgr8")
        writer.write("/image_raw", 10**9, serialize(empty))
        writer.write("/image_raw", 10**9 + 1, encode(good))
    status, _, error = run("replay", "in.mcap", "-p", "fixed_frame:=camera_link", "--out", "out")
    assert status == 1
    assert "/image_raw" in complaint(error)
    assert (tmp_path / "out/output.mcap").stat().st_size > 0


@pytest.mark.parametrize(
    ("words", "status", "expected"),
    [
        (("evaluate", "--distances", "near"), 2, "--distances is 'near'; expected meters"),
        (("evaluate", "--distances", "0.1,2"), 2, "The distances are 0.1, 2; expected"),
        (("evaluate", "-n", 0, "--minutes-of-nobody", 0), 2, "0 episodes and 0 minutes"),
        (("evaluate", "nowhere"), 1, "labels.csv: does not exist; write one"),
    ],
)
def test_an_evaluation_that_cannot_be_is_one_line(run, words, status, expected):
    got, _, error = run(*words)
    assert got == status
    assert expected in complaint(error)


@pytest.mark.model
def test_evaluate_measures_drawn_scenes(run, tmp_path):
    got, output, _ = run(
        "evaluate", "-n", 1, "--minutes-of-nobody", 0, "--distances", 2, "-j", 1,
        "--json", "-o", "out",
    )  # fmt: skip
    assert got == 0
    assert json.loads(output)["recall"]["total"] == 1
    assert (tmp_path / "out" / "evaluation.png").is_file()


@pytest.mark.model
def test_evaluate_judges_photos(run, tmp_path):
    (tmp_path / "photos").mkdir()
    (tmp_path / "photos" / "labels.csv").write_text("file,raised\ngray.png,0\n")
    cv2.imwrite(str(tmp_path / "photos" / "gray.png"), np.full((120, 160, 3), 128, np.uint8))
    got, output, _ = run("evaluate", "photos", "-o", "out")
    assert got == 0
    assert "0 of 1" in output
    assert (tmp_path / "out" / "photos.csv").read_text().splitlines()[1] == "gray.png,0,0,0,"


def test_a_study_has_a_page_that_tells_its_command(run, tmp_path):
    words = ("monte-carlo", "known-people", "-n", "3", "-j", "1", "--report", "new/page.html")
    status, output, _ = run(*words)
    assert status == 0
    assert "wrote new/page.html" in output
    page = (tmp_path / "new/page.html").read_text(encoding="utf-8")
    assert "raised-hand monte-carlo known-people -n 3 -j 1 --report new/page.html" in page


@pytest.mark.parametrize("command", ["replay", "monte-carlo"])
def test_a_page_cannot_take_the_place_of_a_folder(run, tmp_path, command):
    (tmp_path / "bag.mcap").touch()
    (tmp_path / "page").mkdir()
    what = "bag.mcap" if command == "replay" else "people"
    status, _, error = run(command, what, "--report", "page")
    assert status == 2
    assert "--report is page, a folder" in complaint(error)


@pytest.fixture
def blank_recording(tmp_path):
    """Three images of nothing, in the current folder."""
    with RecordingWriter(tmp_path / "in.mcap") as writer:
        for number in range(3):
            stamp_ns = 10**9 + number * 10**8
            picture = np.zeros((48, 64, 3), np.uint8)
            writer.write("/image_raw", stamp_ns, CameraImage(stamp_ns, "camera_link", picture))
    return "in.mcap"


@pytest.mark.model
def test_a_replay_has_a_page_that_tells_problems_and_command(
    run, tmp_path, model_store, blank_recording
):
    run("replay", blank_recording, "--report", "page.html", "-p", "processing_rate:=9.0")
    page = (tmp_path / "page.html").read_text(encoding="utf-8")
    assert "no transform from" in page
    assert "raised-hand replay in.mcap --report page.html -p processing_rate:=9.0" in page
    assert "<td>processing_rate</td>" in page


@pytest.mark.model
def test_a_replay_leaves_a_recording_for_the_viewer(run, tmp_path, model_store, blank_recording):
    pytest.importorskip("rerun", reason="the extra `view` is absent", exc_type=ImportError)
    _, output, _ = run("replay", blank_recording, "--save-view", "view.rrd")
    assert "wrote view.rrd" in output
    assert (tmp_path / "view.rrd").stat().st_size > 1000


@pytest.mark.model
@pytest.mark.parametrize("option", [("--view",), ("--save-view", "view.rrd")])
def test_a_view_without_rerun_is_one_line_and_status_2(
    run, monkeypatch, model_store, blank_recording, option
):
    monkeypatch.setitem(sys.modules, "rerun", None)
    status, _, error = run("replay", blank_recording, *option)
    assert status == 2
    assert "pip install '.[view]'" in complaint(error)
