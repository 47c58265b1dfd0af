"""The command of the node without ROS, where Cyclone DDS is missing."""

import subprocess
import sys

WITHOUT = """
import sys
sys.modules["cyclonedds"] = None
from nodes.raised_hand_dds import main
main()
"""


def test_without_its_extra_the_command_names_it_in_one_line():
    ended = subprocess.run([sys.executable, "-c", WITHOUT], capture_output=True, text=True)
    assert ended.returncode == 2
    assert ended.stdout == ""
    [line] = ended.stderr.splitlines()
    assert "pip install 'raised-hand-tracker[dds]'" in line
