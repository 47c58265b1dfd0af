from pathlib import Path

import pytest

from benchmarks._annotated_scans import read_annotated_scans, score_clusters
from tracker.errors import RecordingError

SCANS = Path(__file__).parents[2] / "../shared/data/scans"
MARKED = SCANS / "leg_tracker__positive_1_extracted.bag"


def test_people_whose_legs_are_marked_in_a_real_recording_are_found():
    if not MARKED.exists():
        pytest.skip(f"{MARKED.name} is not beside the checkout")
    score = score_clusters(MARKED)
    assert len(list(read_annotated_scans(MARKED))) == 197
    assert score.people >= 197
    assert score.recall >= 0.95
    assert score.distance_m < 0.1
    # Only one person is marked among a room's furniture.
    assert score.right >= score.found
    assert score.precision < 1.0


def test_what_is_no_bag_is_told_so(tmp_path):
    file = tmp_path / "marked.bag"
    file.write_bytes(b"nothing")
    with pytest.raises(RecordingError, match="not a bag"):
        score_clusters(file)


def test_scans_without_marks_are_told_so():
    demo = SCANS / "leg_tracker_demo"
    if not demo.exists():
        pytest.skip(f"{demo.name} is not beside the checkout")
    with pytest.raises(RecordingError, match="0 PoseArrays"):
        list(read_annotated_scans(demo))
