import shutil
import struct
import subprocess

import cv2
import numpy as np
import pytest

from tracker.errors import RecordingError
from tracker.recording import Topics, open_recording
from tracker.recording.pictures import natural_order


def write_video(path, codec, count=30, fps=15.0, size=(96, 64)):
    writer = cv2.VideoWriter(str(path), cv2.VideoWriter_fourcc(*codec), fps, size)
    if not writer.isOpened():
        pytest.skip(f"this OpenCV does not encode {codec}")
    for number in range(count):
        frame = np.full((size[1], size[0], 3), 8 * number % 256, dtype=np.uint8)
        cv2.circle(frame, (number % 90, 30), 12, (0, 0, 255), -1)
        writer.write(frame)
    writer.release()


@pytest.mark.parametrize(
    ("name", "codec"),
    [
        ("a.mp4", "mp4v"),
        ("a.avi", "MJPG"),
        ("a.mkv", "MJPG"),
        ("a.webm", "VP80"),
        ("a.mov", "mp4v"),
    ],
)
def test_videos_are_stamped_from_zero_at_their_frame_rate(tmp_path, name, codec):
    write_video(tmp_path / name, codec)
    with open_recording(tmp_path / name, Topics(image="/anything")) as recording:
        assert recording.has_images
        assert not recording.is_bag
        assert not recording.has_scans
        assert recording.summary.duration_s == pytest.approx(29 / 15, abs=0.1)
        events = list(recording.events())
    assert len(events) == 30
    assert all(log_ns == image.stamp_ns for log_ns, image in events)
    stamps_s = np.array([log_ns for log_ns, _ in events]) / 1e9
    np.testing.assert_allclose(stamps_s, np.arange(30) / 15.0, atol=0.002)
    assert events[0][1].bgr.shape == (64, 96, 3)
    assert events[20][1].bgr[60, 5].mean() > events[2][1].bgr[60, 5].mean() + 50


@pytest.mark.parametrize(
    ("matrix", "size", "corner"),
    [
        ((0, 1, -1, 0), (64, 96), "bottom"),
        ((-1, 0, 0, -1), (96, 64), "left"),
        ((0, -1, 1, 0), (64, 96), "top"),
    ],
    ids=["a quarter turn", "half a turn", "three quarters"],
)
def test_a_video_of_a_turned_phone_is_upright(tmp_path, matrix, size, corner):
    path = tmp_path / "phone.mp4"
    writer = cv2.VideoWriter(str(path), cv2.VideoWriter_fourcc(*"mp4v"), 15.0, (96, 64))
    frame = np.zeros((64, 96, 3), np.uint8)
    frame[:, 72:] = 255  # on the right before it is turned
    for _ in range(5):
        writer.write(frame)
    writer.release()
    content = bytearray(path.read_bytes())
    at = content.index(b"tkhd") + 44  # the matrix of the track's header
    a, b, c, d = (number << 16 for number in matrix)
    content[at : at + 36] = struct.pack(">9i", a, b, 0, c, d, 0, 0, 0, 1 << 30)
    path.write_bytes(content)
    with open_recording(path) as recording:
        bgr = next(recording.events())[1].bgr
    assert bgr.shape[1::-1] == size
    bright = {"left": bgr[:, :10], "top": bgr[:10], "bottom": bgr[-10:]}[corner]
    assert bright.min() > 200
    assert bgr.mean() == pytest.approx(64, abs=10)


@pytest.mark.skipif(shutil.which("ffmpeg") is None, reason="needs ffmpeg to make the video")
@pytest.mark.parametrize("suffix", ["mp4", "mkv", "avi"])
def test_frames_of_a_rate_that_varies_keep_their_own_times(tmp_path, suffix):
    write_video(tmp_path / "steady.mp4", "mp4v", count=30, fps=10.0)
    path = tmp_path / f"varies.{suffix}"
    codec = "mjpeg" if suffix == "avi" else "mpeg4"
    slower = "setpts='if(lt(N,15),N/10,1.5+(N-15)/2.5)/TB'"
    subprocess.run(
        ["ffmpeg", "-v", "error", "-i", tmp_path / "steady.mp4", "-vf", slower, "-vsync", "vfr",
         "-c:v", codec, path],
        check=True,
    )  # fmt: skip
    with open_recording(path) as recording:
        stamps_s = np.array([log_ns for log_ns, _ in recording.events()]) / 1e9
    expected_s = [*(np.arange(15) / 10), *(1.5 + np.arange(15) / 2.5)]
    np.testing.assert_allclose(stamps_s, expected_s, atol=0.011)


@pytest.mark.skipif(shutil.which("ffmpeg") is None, reason="needs ffmpeg to make the video")
@pytest.mark.skipif(not hasattr(cv2, "CAP_PROP_PTS"), reason="this OpenCV does not tell")
def test_a_piece_of_a_longer_video_is_read_from_0_to_its_end(tmp_path):
    write_video(tmp_path / "whole.mp4", "mp4v", count=30, fps=10.0)
    path = tmp_path / "piece.mkv"
    subprocess.run(
        ["ffmpeg", "-v", "error", "-itsoffset", "7", "-i", tmp_path / "whole.mp4", "-c", "copy",
         path],
        check=True,
    )  # fmt: skip
    with open_recording(path) as recording:
        stamps_s = np.array([log_ns for log_ns, _ in recording.events()]) / 1e9
    np.testing.assert_allclose(stamps_s, np.arange(30) / 10, atol=0.002)


def test_a_photo_beyond_the_limit_is_counted_and_the_others_are_read(tmp_path):
    for name, width in (("a.png", 40), ("b.jpg", 60), ("c.png", 41)):
        cv2.imwrite(str(tmp_path / name), np.zeros((50, width, 3), np.uint8))
    with open_recording(tmp_path, max_pixels=50 * 41) as recording:
        widths = [image.width for _, image in recording.events()]
        (line,) = recording.skipped_lines()
    assert widths == [40, 41]
    assert "60x50 pixels" in line
    assert "picture_max_pixels" in line


def test_a_video_of_too_many_pixels_is_refused_before_its_first_frame(tmp_path):
    write_video(tmp_path / "a.avi", "MJPG")
    with pytest.raises(RecordingError, match=r"a\.avi.*96x64 pixels; at most 6143"):
        open_recording(tmp_path / "a.avi", max_pixels=96 * 64 - 1)


def test_a_photo_of_16_bits_is_as_bright_as_its_sensor_saw(tmp_path):
    values = np.full((20, 30), 700, np.uint16)
    values[3, 3] = 1023
    cv2.imwrite(str(tmp_path / "a.png"), values)
    with open_recording(tmp_path / "a.png") as recording:
        ((_, image),) = recording.events()
    assert image.bgr[10, 10].tolist() == [175, 175, 175]
    assert "10 bits" in image.remark


def test_a_video_that_breaks_names_the_frame(tmp_path):
    path = tmp_path / "cut.avi"
    write_video(path, "MJPG", count=60)
    content = path.read_bytes()
    path.write_bytes(content[: len(content) // 2])
    with open_recording(path) as recording:
        images = []
        with pytest.raises(RecordingError, match=r"beyond frame \d+ of 60") as caught:
            images.extend(recording.events())  # keeps what came before the error
    assert 20 < len(images) < 40
    assert f"frame {len(images)} of" in str(caught.value)


def test_a_video_without_its_end_is_refused_where_nothing_can_be_decoded(tmp_path):
    path = tmp_path / "cut.mp4"  # the table of contents stands at the end
    write_video(path, "mp4v")
    path.write_bytes(path.read_bytes()[:-600])
    with pytest.raises(RecordingError, match=r"cut\.mp4"):
        open_recording(path)


def test_photos_come_in_natural_order_each_in_its_own_size(tmp_path):
    for number, suffix in ((10, "jpg"), (2, "png"), (1, "bmp"), (9, "webp")):
        cv2.imwrite(
            str(tmp_path / f"shot_{number}.{suffix}"), np.zeros((number + 8, 20, 3), np.uint8)
        )
    (tmp_path / "notes.txt").write_text("no photo")
    with open_recording(tmp_path, photo_period_s=0.5) as recording:
        events = list(recording.events())
        assert recording.summary.kind == "photos"
        assert recording.summary.duration_s == 1.5
    assert [image.height for _, image in events] == [9, 10, 17, 18]
    assert [log_ns for log_ns, _ in events] == [0, 500_000_000, 1_000_000_000, 1_500_000_000]


def test_one_photo_is_a_recording_of_one_frame(tmp_path):
    cv2.imwrite(str(tmp_path / "übung.png"), np.zeros((6, 5), np.uint8))
    with open_recording(tmp_path / "übung.png") as recording:
        ((log_ns, image),) = recording.events()
        assert recording.share(log_ns) == 1.0
    assert (log_ns, image.bgr.shape) == (0, (6, 5, 3))


def test_an_unreadable_photo_is_counted_and_named(tmp_path):
    for name in ("a.png", "c.png"):
        cv2.imwrite(str(tmp_path / name), np.zeros((6, 5, 3), np.uint8))
    (tmp_path / "b.png").write_bytes(b"no photo")
    with open_recording(tmp_path) as recording:
        stamps = [log_ns for log_ns, _ in recording.events()]
        (line,) = recording.skipped_lines()
    assert stamps == [0, 200_000_000]
    assert "b.png" in line
    assert "1 unusable" in line


def test_only_unreadable_photos_are_an_error(tmp_path):
    (tmp_path / "b.png").write_bytes(b"no photo")
    (tmp_path / "c.jpg").write_bytes(b"")
    with pytest.raises(RecordingError, match="not one photo"):
        open_recording(tmp_path)


def test_numbers_in_names_count_as_numbers():
    names = ["img10.jpg", "img9.jpg", "IMG1.jpg", "7.jpg", "a.jpg"]
    assert sorted(names, key=natural_order) == [
        "7.jpg",
        "a.jpg",
        "IMG1.jpg",
        "img9.jpg",
        "img10.jpg",
    ]
