import subprocess
import sys

import av
import cv2
import numpy as np
import pytest

from tracker.errors import OutputError
from tracker.report.video.debug_video import DebugVideo, side_by_side


def frames_of(path):
    reader = cv2.VideoCapture(str(path))
    frames = []
    while True:
        is_there, frame = reader.read()
        if not is_there:
            return frames, reader.get(cv2.CAP_PROP_FPS)
        frames.append(frame)


def plain(height, width, gray):
    return np.full((height, width, 3), gray, np.uint8)


def test_pictures_come_back_in_number_size_rate_and_order(tmp_path):
    with DebugVideo(tmp_path / "debug.mp4", 10.0) as video:
        for number in range(20):
            video.write(plain(120, 160, 10 * number))
    frames, rate_hz = frames_of(tmp_path / "debug.mp4")
    assert len(frames) == 20
    assert frames[0].shape == (120, 160, 3)
    assert rate_hz == pytest.approx(10.0)
    assert [frame.mean() for frame in frames] == pytest.approx(10.0 * np.arange(20), abs=6.0)


def test_odd_sides_are_padded_to_even_ones(tmp_path):
    with DebugVideo(tmp_path / "debug.mp4", 10.0) as video:
        video.write(plain(121, 161, 200))
        video.write(plain(121, 161, 200))
    frames, _ = frames_of(tmp_path / "debug.mp4")
    assert [frame.shape for frame in frames] == [(122, 162, 3)] * 2


def test_a_picture_of_another_size_is_fitted_between_bars(tmp_path):
    with DebugVideo(tmp_path / "debug.mp4", 10.0) as video:
        video.write(plain(120, 160, 200))
        video.write(plain(400, 200, 200))  # upright: bars left and right
        video.write(plain(30, 160, 200))  # a strip: bars above and below
    frames, _ = frames_of(tmp_path / "debug.mp4")
    assert [frame.shape for frame in frames] == [(120, 160, 3)] * 3
    assert frames[1][:, :40].mean() < 20 < 180 < frames[1][:, 60:100].mean()
    assert frames[2][:35].mean() < 20 < 180 < frames[2][55:65].mean()


def test_an_exception_leaves_a_video_that_plays(tmp_path):
    def break_off():
        with DebugVideo(tmp_path / "debug.mp4", 10.0) as video:
            for _ in range(7):
                video.write(plain(120, 160, 90))
            raise KeyError("somebody else's trouble")

    with pytest.raises(KeyError):
        break_off()
    assert len(frames_of(tmp_path / "debug.mp4")[0]) == 7


def test_no_picture_no_file(tmp_path):
    with DebugVideo(tmp_path / "debug.mp4", 10.0):
        pass
    assert not (tmp_path / "debug.mp4").exists()


def test_a_folder_that_does_not_exist_is_named(tmp_path):
    with (
        pytest.raises(OutputError, match="nowhere"),
        DebugVideo(tmp_path / "nowhere" / "debug.mp4", 10.0) as video,
    ):
        video.write(plain(120, 160, 0))


def test_it_is_what_browsers_play(tmp_path):
    with DebugVideo(tmp_path / "debug.mp4", 10.0) as video:
        video.write(plain(120, 160, 90))
    with av.open(str(tmp_path / "debug.mp4")) as container:
        (stream,) = container.streams
        assert (stream.codec_context.name, stream.codec_context.pix_fmt) == ("h264", "yuv420p")


def test_a_kill_costs_the_last_second_alone(tmp_path):
    path = tmp_path / "debug.mp4"
    script = f"""
import os, numpy as np
from tracker.report.video.debug_video import DebugVideo
video = DebugVideo({str(path)!r}, 10.0)
for number in range(47):
    video.write(np.full((120, 160, 3), 5 * number, np.uint8))
os.kill(os.getpid(), 9)
"""
    subprocess.run([sys.executable, "-c", script], check=False)
    assert 37 <= len(frames_of(path)[0]) <= 47


def test_a_disk_that_takes_no_more_ends_it_and_leaves_what_was_written(tmp_path):
    resource = pytest.importorskip("resource", reason="limits the size of files")
    rng = np.random.default_rng(3)

    def fill_up():
        with DebugVideo(tmp_path / "debug.mp4", 10.0) as video:
            for _ in range(200):
                video.write(rng.integers(0, 256, (240, 320, 3), dtype=np.uint8))

    soft, hard = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (3_000_000, hard))
    try:
        with pytest.raises(OutputError, match=r"debug\.mp4: .*free some space on the disk"):
            fill_up()
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, (soft, hard))
    assert len(frames_of(tmp_path / "debug.mp4")[0]) >= 10


def test_an_earlier_video_stays_until_the_new_one_is_whole(tmp_path):
    path = tmp_path / "debug.mp4"
    with DebugVideo(path, 10.0) as video:
        video.write(plain(120, 160, 90))
    earlier = path.read_bytes()
    with DebugVideo(path, 10.0) as video:
        for _ in range(3):
            video.write(plain(120, 160, 200))
        assert path.read_bytes() == earlier
    assert len(frames_of(path)[0]) == 3
    assert [file.name for file in tmp_path.iterdir()] == ["debug.mp4"]


def test_two_pictures_stand_side_by_side_at_the_left_ones_height():
    assert side_by_side(plain(480, 640, 1), plain(200, 100, 2)).shape == (480, 880, 3)
    assert side_by_side(plain(480, 640, 1), plain(480, 480, 2)).shape == (480, 1120, 3)
