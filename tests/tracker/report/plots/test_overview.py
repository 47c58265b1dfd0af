import matplotlib.image
import numpy as np
import pytest
from matplotlib.colors import to_rgb

from tracker.containers import Truth
from tracker.errors import RecordingError
from tracker.evaluation.metrics.raised_hands.episodes import EpisodeEvaluation
from tracker.report.history.history import History
from tracker.report.palette import LIT, person_color
from tracker.report.plots.overview import draw_overview
from tracker.report.plots.timeline import lanes_of


@pytest.fixture(scope="module")
def history(results):
    history = History()
    for result in results:
        history.write(result)
    return history


@pytest.fixture(scope="module")
def truth(results):
    """Person 70 is track 1; person 90 raises a hand that nobody reports."""
    evaluation = EpisodeEvaluation(start_ns=results[0].stamp_ns)
    for frame, result in enumerate(results):
        up = np.array([20 <= frame < 75, 100 <= frame < 140])
        places = [[1.5, 0.8 + 0.004 * min(frame, 120)], [4.0, -2.0]]
        evaluation.add_truth(Truth(result.stamp_ns, [70, 90], places, up, [True, True]))
        evaluation.add_result(result)
    return evaluation.report()


def has(picture, color):
    return np.any(np.all(np.abs(picture[..., :3] - to_rgb(color)) < 0.02, axis=-1))


def test_the_picture_shows_every_person_and_the_lit_one(tmp_path, history, truth):
    draw_overview(history, tmp_path / "overview.png", truth)
    picture = matplotlib.image.imread(tmp_path / "overview.png")
    assert picture.shape[1] == 1600
    assert all(has(picture, person_color(number)) for number in (1, 2, 4))
    assert not has(picture, person_color(3))
    assert has(picture, LIT)


def test_a_recording_without_anybody_has_a_picture_too(tmp_path, result_of):
    history = History()
    draw_overview(history, tmp_path / "empty.png")
    history.write(result_of(0))
    draw_overview(history, tmp_path / "nobody.png")
    assert (tmp_path / "empty.png").stat().st_size > 0
    assert (tmp_path / "nobody.png").stat().st_size > 0


def test_a_crowd_over_a_day_has_a_picture_too(tmp_path, result_of):
    history = History()
    for number in range(1, 60):
        history.write(
            result_of(
                number * 10**12, (number, float(number), 0.0, number % 2 == 0), selected=number
            )
        )
    draw_overview(history, tmp_path / "crowd.png")
    assert len(lanes_of(history)) == 20
    assert matplotlib.image.imread(tmp_path / "crowd.png").shape[0] < 4000


def test_truth_joins_the_lane_of_its_identity_and_the_missed_have_their_own(history, truth):
    lanes = lanes_of(history, truth)
    assert [lane.person.id if lane.person else None for lane in lanes] == [1, 2, 4, None]
    assert [[row.person for row in lane.truth] for lane in lanes] == [[70], [], [], [90]]


def test_a_place_that_is_no_folder_is_named(tmp_path, history):
    (tmp_path / "file").write_text("")
    with pytest.raises(RecordingError, match="file: cannot be written"):
        draw_overview(history, tmp_path / "file" / "overview.png")


def test_two_drawings_of_one_history_are_the_same(tmp_path, history):
    draw_overview(history, tmp_path / "a.png")
    draw_overview(history, tmp_path / "b.png")
    assert (tmp_path / "a.png").read_bytes() == (tmp_path / "b.png").read_bytes()
