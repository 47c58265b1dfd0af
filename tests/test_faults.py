"""A small part of the campaign of `make faults`."""

import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]


@pytest.mark.skipif(sys.platform == "win32", reason="needs fork")
def test_harmed_recordings_cost_no_more_than_the_damage():
    done = subprocess.run(
        [sys.executable, "-m", "benchmarks.faults", "--tries", "42", "--files-alone"],
        cwd=ROOT,
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stdout + done.stderr[-3000:]
    assert "42 attempts" in done.stdout
