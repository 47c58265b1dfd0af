import numpy as np

from tracker.report.history.trail import Trail


def test_a_short_path_is_kept_whole():
    trail = Trail(2)
    for x in range(5):
        trail.append(float(x), 0.5)
    assert trail.rows.tolist() == [[x, 0.5] for x in range(5)]


def test_a_long_path_is_thinned_evenly_and_keeps_its_ends():
    trail = Trail(1, capacity=100)
    for x in range(100_000):
        trail.append(float(x))
    rows = trail.rows[:, 0]
    assert len(trail) <= 100
    assert (rows[0], rows[-1]) == (0.0, 99_999.0)
    steps = np.diff(rows[:-1])
    assert np.all(steps == steps[0])


def test_an_empty_path_has_no_rows():
    assert Trail(3).rows.shape == (0, 3)
