"""Every notebook runs from top to bottom, small, and leaves a file that the node's model loads."""

import os
from pathlib import Path

import pytest
import yaml

from tracker.config import Config

ROOT = Path(__file__).parents[2]
NOTEBOOKS = sorted((ROOT / "notebooks").glob("*.ipynb"))

#: Put after a notebook's first code cell, which holds what a reader may turn.
SMALL = {
    "01_is_the_filter_consistent": "SECONDS, TRIALS, SCENES = 12.0, 50, 1",
    "02_tuning_the_gains": "SECONDS, TRIALS, SCENES, UNSEEN = 5.0, 3, 1, 2",
    "03_ranging_and_calibration": "SECONDS = 50.0",
    "04_what_noise_does": "STEPS, TRIALS, SECONDS, FILTER_TRIALS = 2, 1, 5.0, 20",
}


def needed(module):
    """A module without which notebooks do not run: its absence is a failure in CI alone."""
    if os.environ.get("CI"):
        return __import__(module)
    return pytest.importorskip(module, reason=f"{module} is not installed: the `test` extra")


def read(path):
    return needed("nbformat").read(path, as_version=4)


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_a_notebook_runs_and_leaves_parameters_for_the_node(path, tmp_path, monkeypatch):
    for module in ("ipykernel", "ipywidgets"):
        needed(module)
    nbclient = needed("nbclient")
    notebook = read(path)
    first = next(row for row, cell in enumerate(notebook.cells) if cell.cell_type == "code")
    notebook.cells[first].source += "\n" + SMALL[path.stem]
    monkeypatch.setenv("PYTHONPATH", str(ROOT))
    resources = {"metadata": {"path": str(tmp_path)}}
    nbclient.NotebookClient(notebook, timeout=120, resources=resources).execute()

    said = [
        output.text
        for cell in notebook.cells
        for output in cell.get("outputs", [])
        if output.output_type == "stream" and output.name == "stderr"
    ]
    assert said == []
    written = tmp_path / f"{path.stem}.yaml"
    assert isinstance(Config.from_yaml(written), Config)
    document = yaml.safe_load(written.read_text(encoding="utf-8"))
    assert sorted(document["hand_detector"]["ros__parameters"]) == sorted(Config.model_fields)


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_a_notebook_is_committed_without_outputs(path):
    cells = [cell for cell in read(path).cells if cell.cell_type == "code"]
    assert all(cell.outputs == [] and cell.execution_count is None for cell in cells)


def test_the_index_names_every_notebook():
    index = (ROOT / "notebooks/README.md").read_text(encoding="utf-8")
    assert [path.name for path in NOTEBOOKS if path.name not in index] == []
