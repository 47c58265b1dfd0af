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
    assert "1 not usable" in line


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
