import sys

import numpy as np
import pytest

from tracker import CameraImage, Hands
from tracker.errors import ConfigError, RecordingError
from tracker.report.video.rerun_view import RerunView


@pytest.fixture
def rerun():
    """Rerun, strict: what it cannot show is an error."""
    rerun = pytest.importorskip("rerun", reason="the extra `view` is absent", exc_type=ImportError)
    before = rerun.strict_mode()
    rerun.set_strict_mode(True)
    yield rerun
    rerun.set_strict_mode(before)


def an_image(result):
    return CameraImage(result.stamp_ns, "camera", np.full((60, 80, 3), 90, np.uint8))


def rows_of(path, component):
    """(stamp_ns, value) of a component in the only recording of a file, statics left out."""
    from rerun.chunk import RrdReader

    entity, _, name = component.partition(":")
    found = []
    for chunk in RrdReader(str(path)).store().stream():
        if chunk.entity_path != entity or chunk.is_static:
            continue
        assert chunk.timeline_names == ["stamp"]
        batch = chunk.to_record_batch()
        if name in batch.schema.names:
            stamps = batch.column("stamp").cast("int64").to_pylist()
            found += zip(stamps, batch.column(name).to_pylist(), strict=True)
    return sorted(found)


def save(path, results):
    with RerunView(save=path) as view:
        for result in results:
            view.watch(an_image(result), result)
    return path


@pytest.fixture
def some(results):
    """Two seconds with the first person's hand going up, and with somebody confirmed."""
    return results[15:35]


def test_every_image_is_there_at_its_own_stamp(rerun, tmp_path, some):
    path = save(tmp_path / "new" / "view.rrd", some)
    stamps = [result.stamp_ns for result in some]
    for component in (
        "/camera/image:EncodedImage:blob", "/camera/hands:LineStrips2D:strips",
        "/camera/torsos:LineStrips2D:strips", "/map/scan:Points3D:positions",
        "/map/robot:Arrows3D:origins", "/map/people:Points3D:positions",
        "/map/ellipses:LineStrips3D:strips", "/map/trails:LineStrips3D:strips",
        "/map/served:LineStrips3D:strips", "/hand_raised:Scalars:scalars",
    ):  # fmt: skip
        assert [stamp for stamp, _ in rows_of(path, component)] == stamps, component


def test_people_are_where_the_tracker_has_them_with_id_and_existence(rerun, tmp_path, some):
    path = save(tmp_path / "view.rrd", some)
    known = some[-1].tracks[some[-1].tracks.confirmed]
    assert known.id.tolist() == [1]
    (place,) = rows_of(path, "/map/people:Points3D:positions")[-1][1]
    assert place == pytest.approx([*known.mean[0, :2], 0.0], abs=1e-6)
    assert rows_of(path, "/map/people:Points3D:labels")[-1][1] == ["#1 97% hand up served"]
    assert rows_of(path, "/map/people:Points3D:colors")[-1][1] == [0x2F6DB5FF]
    assert rows_of(path, "/existence/1:Scalars:scalars")[-1] == (some[-1].stamp_ns, [0.97])


def test_ellipses_are_two_standard_deviations(rerun, tmp_path, some):
    path = save(tmp_path / "view.rrd", some)
    tracks = some[-1].tracks
    (rim,) = rows_of(path, "/map/ellipses:LineStrips3D:strips")[-1][1]
    offset = np.array(rim)[:, :2] - tracks.mean[0, :2]
    inverse = np.linalg.inv(tracks.covariance[0, :2, :2])
    squared = np.einsum("ni,ij,nj->n", offset, inverse, offset)
    assert squared == pytest.approx(np.full(len(rim), 4.0), rel=1e-4)


def test_hand_raised_and_who_is_served_follow_the_result(rerun, tmp_path, some):
    path = save(tmp_path / "view.rrd", some)
    raised = [value for _, (value,) in rows_of(path, "/hand_raised:Scalars:scalars")]
    assert raised == [float(result.hand_raised) for result in some]
    came = next(result.stamp_ns for result in some if result.hand_raised)
    assert rows_of(path, "/served:StateChange:state") == [
        (some[0].stamp_ns, ["nobody"]),
        (came, ["#1"]),
    ]


def test_the_file_brings_its_own_arrangement(rerun, tmp_path, some):
    from rerun.chunk import RrdReader

    assert len(RrdReader(str(save(tmp_path / "view.rrd", some))).blueprints()) == 1


def test_hands_are_drawn_bone_by_bone_and_tied_to_their_owners(rerun, tmp_path, result_of):
    landmarks = np.arange(84.0).reshape(2, 21, 2)
    torso = np.array([[5.0, 6.0], [np.nan, np.nan]])
    hands = Hands(landmarks, np.ones(2), np.ones(2), [True, False], np.ones(2), torso)
    path = save(tmp_path / "view.rrd", [result_of(10**9, hands=hands)])
    ((_, bones),) = rows_of(path, "/camera/hands:LineStrips2D:strips")
    assert len(bones) == 2 * 6
    assert bones[0] == landmarks[0, :5].tolist()
    ((_, arms),) = rows_of(path, "/camera/torsos:LineStrips2D:strips")
    assert arms == [[[0.0, 1.0], [5.0, 6.0]]]


def test_nobody_in_front_of_a_camera_that_does_not_know_its_place_can_be_watched(
    rerun, tmp_path, result_of
):
    path = save(tmp_path / "view.rrd", [result_of(10**9)])
    assert rows_of(path, "/map/scan:Points3D:positions") == [(10**9, [])]
    assert rows_of(path, "/map/robot:Arrows3D:origins") == []


def test_a_place_that_cannot_be_written_is_named(rerun, tmp_path):
    (tmp_path / "file").write_text("in the way")
    with pytest.raises(RecordingError, match="file"):
        RerunView(save=tmp_path / "file" / "view.rrd")


def test_without_rerun_the_extra_is_named(monkeypatch, tmp_path):
    monkeypatch.setitem(sys.modules, "rerun", None)
    with pytest.raises(ConfigError, match=r"pip install '.\[view\]'"):
        RerunView(save=tmp_path / "view.rrd")


def test_a_viewer_that_cannot_start_is_said_and_nothing_waits_for_it(
    rerun, tmp_path, some, monkeypatch
):
    monkeypatch.setattr(rerun, "spawn", lambda **_: None)  # it gives up where there is no screen
    monkeypatch.setattr("tracker.report.video.rerun_view._VIEWER", ("127.0.0.1", 9))
    monkeypatch.setattr("tracker.report.video.rerun_view._SETTLING_S", 0.0)
    with RerunView(live=True, save=tmp_path / "view.rrd") as view:
        view.watch(an_image(some[0]), some[0])
    assert "cannot start: it needs a screen" in view.trouble
    assert (tmp_path / "view.rrd").stat().st_size > 1000
    with RerunView(live=True) as view:
        view.watch(an_image(some[0]), some[0])
    assert view.trouble


def test_a_viewer_that_was_closed_ends_the_waiting(rerun, tmp_path, some, monkeypatch):
    def fail(*_, **__):
        raise RuntimeError("unable to connect")

    with RerunView(save=tmp_path / "view.rrd") as view:
        view.watch(an_image(some[0]), some[0])
        monkeypatch.setattr(type(view._stream), "flush", fail)
    assert "did not receive everything (unable to connect)" in view.trouble


def test_the_viewer_is_started_for_the_stream_that_it_shows(rerun, monkeypatch):
    asked = []
    monkeypatch.setattr(rerun, "spawn", lambda **options: asked.append(options))
    monkeypatch.setattr("tracker.report.video.rerun_view._SETTLING_S", 0.0)
    with RerunView(live=True) as view:
        assert asked[0]["recording"] is view._stream  # without one Rerun does nothing at all
