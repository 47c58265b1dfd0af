"""The comparison on recorded paths counts what it says."""

import importlib
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from tracker.containers import Tracks, Truth

ROOT = Path(__file__).parents[2]
PERIOD_NS = 100_000_000


@pytest.fixture
def real_paths(monkeypatch):
    monkeypatch.syspath_prepend(str(ROOT / "benchmarks"))
    return importlib.import_module("real_paths")


def people_at(frame, places):
    """Everybody calls, everywhere in view."""
    yes = np.ones(len(places), dtype=bool)
    return Truth(
        stamp_ns=frame * PERIOD_NS,
        id=np.array(list(places), dtype=np.int64),
        xy_m=np.array(list(places.values()), float).reshape(-1, 2),
        hand_up=yes,
        in_view=yes,
    )


def tracks_at(frame, places):
    count = len(places)
    mean = np.zeros((count, 4))
    mean[:, :2] = np.array(list(places.values()), float).reshape(-1, 2)
    tracks = Tracks.none(frame * PERIOD_NS)
    return replace(
        tracks,
        id=np.array(list(places), dtype=np.int64),
        mean=mean,
        covariance=np.tile(0.01 * np.eye(4), (count, 1, 1)),
        existence=np.ones(count),
        confirmed=np.ones(count, dtype=bool),
        raised=np.ones(count, dtype=bool),
        raised_since_ns=np.zeros(count, dtype=np.int64),
        age_s=np.zeros(count),
        unseen_s=np.zeros(count),
        hand=np.full(count, -1),
        gesture=np.zeros(count, dtype=np.int64),
    )


def row(real_paths, people, tracks, frames=200):
    scores = real_paths.Scores()
    for frame in range(frames):
        scores.add(people_at(frame, people(frame)), tracks_at(frame, tracks(frame)))
    return scores.row()


def test_a_tracker_that_is_right_has_no_error(real_paths):
    figures = row(real_paths, lambda _: {3: (2, 0), 5: (4, 1)}, lambda _: {1: (2, 0), 2: (4, 1)})
    for name in ("gospa_m", "switches_per_min", "nees", "missed_share", "false_tracks"):
        assert figures[name] == 0.0, name
    assert figures["covered_share"] == 1.0
    assert np.isnan(figures["gone_s"])


def test_missed_people_and_false_tracks_count_within_seven_meters_alone(real_paths):
    people = {1: (2, 0), 2: (7.5, 0)}
    near = row(real_paths, lambda _: people, lambda _: {1: (-3, 0), 2: (7.5, 0)})
    assert (near["missed_share"], near["false_tracks"]) == (1.0, 1.0)
    assert near["gospa_m"] == pytest.approx(1.0)
    far = row(real_paths, lambda _: people, lambda _: {1: (2.1, 0), 2: (0, -7.5)})
    assert (far["missed_share"], far["false_tracks"]) == (0.0, 0.0)
    assert far["nees"] == pytest.approx(1.0)


def test_a_new_identity_is_a_switch(real_paths):
    figures = row(real_paths, lambda _: {1: (2, 0)}, lambda frame: {1 + frame // 100: (2, 0)})
    assert figures["switches_per_min"] == pytest.approx(60 / 19.9)


def test_a_track_lingers_until_it_ends(real_paths):
    def tracks(frame):
        return {1: (2, 0)} if frame < 73 else {}

    figures = row(real_paths, lambda frame: {7: (2, 0)} if frame < 50 else {}, tracks)
    assert figures["gone_s"] == pytest.approx(2.3)
    assert np.isnan(figures["beyond_s"])


def test_a_track_lingers_until_it_is_somebody_else_s(real_paths):
    def people(frame):
        return {7: (2, 0)} if frame < 50 else {8: (4, 0)}

    figures = row(real_paths, people, lambda frame: {1: (min(2 + max(frame - 50, 0) * 0.1, 4), 0)})
    assert figures["gone_s"] == pytest.approx(1.0, abs=0.11)


def test_a_track_that_walks_on_beyond_reach_lingers_there(real_paths):
    def people(frame):
        return {7: (6 + 0.05 * frame, 0)} if frame < 40 else {}

    def tracks(frame):
        return {1: (6 + 0.05 * frame, 0)} if frame < 90 else {}

    figures = row(real_paths, people, tracks)
    assert figures["beyond_s"] == pytest.approx(5.0)
    assert np.isnan(figures["gone_s"])


def test_windows_are_drawn_from_a_recording_around_a_robot_that_people_pass(real_paths, tmp_path):
    recording = tmp_path / "hall.csv"
    rng = np.random.default_rng(4)
    lines = []
    for person in range(40):
        start, way = rng.uniform(-6, 6, 2), rng.normal(0, 0.8, 2)
        for step in range(60):
            x_m, y_m = start + 0.4 * step * way
            lines.append((3.0 * person + 0.4 * step, person, x_m, y_m))
    text = "\n".join(",".join(map(str, line)) for line in sorted(lines))
    recording.write_text(f"t_s,id,x_m,y_m\n{text}\n", encoding="utf-8")
    scenario = replace(real_paths.SENSORS, recording=str(recording), duration_s=20.0)
    frames = real_paths.draw_window(scenario, np.random.default_rng(1))
    assert len(frames) == 200
    ranges = np.concatenate([np.linalg.norm(truth.xy_m, axis=1) for truth, _ in frames])
    assert ranges.max() < real_paths.REACH_M
    scored = real_paths.score_window(scenario, ("hungarian", "reference"), 1, 0)
    assert set(scored["reference"]) == set(real_paths.FIGURES)


def test_a_recording_with_too_few_people_is_said(real_paths, tmp_path):
    recording = tmp_path / "empty.csv"
    recording.write_text("t_s,id,x_m,y_m\n0,1,0,0\n60,1,5,0\n", encoding="utf-8")
    scenario = replace(real_paths.SENSORS, recording=str(recording), duration_s=20.0)
    assert "no piece with 3 people" in real_paths.score_window(scenario, ("jpda",), 1, 0)
