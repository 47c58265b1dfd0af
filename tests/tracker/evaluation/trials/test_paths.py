from pathlib import Path

import numpy as np
import pytest

from tracker.errors import SceneError
from tracker.evaluation.trials.paths import recorded, walks

STAMPS_S = 1.0 + np.arange(200) / 10
ZARA = Path(__file__).parents[4] / "../shared/data/trajectories/zara01.csv"


def test_walkers_stay_in_their_area_at_walking_speed():
    xy = walks(np.random.default_rng(1), STAMPS_S, 5, (1.0, 4.0, -2.0, 2.0), pause_s=2.0)
    assert xy.shape == (200, 5, 2)
    assert (xy[..., 0] >= 1.0).all()
    assert (xy[..., 0] <= 4.0).all()
    assert (np.abs(xy[..., 1]) <= 2.0).all()
    speed = np.linalg.norm(np.diff(xy, axis=0), axis=-1) * 10
    assert 0.5 < speed.max() < 1.7
    assert (speed < 1e-9).any()


def test_people_with_endless_stops_stand():
    xy = walks(np.random.default_rng(1), STAMPS_S, 3, (1.0, 4.0, -2.0, 2.0), pause_s=np.inf)
    assert np.ptp(xy, axis=0).max() == 0.0


@pytest.mark.skipif(not ZARA.exists(), reason="the recorded paths are not here")
def test_recorded_people_come_and_go_as_recorded():
    xy = recorded(np.random.default_rng(1), STAMPS_S, ZARA)
    assert np.isnan(xy).any()
    assert np.isfinite(xy).any(axis=(0, 2)).all()
    speed = np.linalg.norm(np.diff(xy, axis=0), axis=-1) * 10
    assert np.nanmax(speed) < 4.0


@pytest.mark.parametrize("text", ["", "t_s,id\n1,2\n", "t_s,id,x_m,y_m\n0,1,0,0\n1,1,1,0\n"])
def test_a_table_that_does_not_do_names_the_file(tmp_path, text):
    (tmp_path / "paths.csv").write_text(text)
    with pytest.raises(SceneError, match=r"paths\.csv"):
        recorded(np.random.default_rng(1), STAMPS_S, tmp_path / "paths.csv")
