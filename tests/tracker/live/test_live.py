import itertools
import time

import cv2
import numpy as np
import pytest

from tracker import CameraImage, Config, Hands, Pipeline
from tracker.errors import RecordingError
from tracker.live import CameraStream, live_events, run_live
from tracker.live.sources import paced, simulated_events
from tracker.live.teller import Teller
from tracker.recording import Topics, open_recording
from tracker.service import Command

PERIOD_NS = 100_000_000


class OneHand:
    work = None

    def find(self, image, hints=None):
        landmarks = np.full((1, 21, 2), (32.0, 24.0))
        landmarks[:, 12, 1] -= 6.0
        one = np.ones(1)
        return Hands(landmarks, one, one, one.astype(bool), one)

    def reset(self):
        pass

    def configure(self, config):
        pass


class FakeCapture:
    """A camera of OpenCV's kind that gives some pictures and breaks off, again and again."""

    opened = 0

    def __init__(self, *_):
        FakeCapture.opened += 1
        self.left = 5

    def isOpened(self):
        return FakeCapture.opened > 1 or self.is_there_at_once

    def set(self, *_):
        return True

    def read(self):
        self.left -= 1
        return self.left > 0, np.zeros((48, 64, 3), np.uint8)

    def release(self):
        pass


@pytest.fixture
def camera(monkeypatch):
    FakeCapture.opened, FakeCapture.is_there_at_once = 0, True
    monkeypatch.setattr(cv2, "VideoCapture", FakeCapture)
    monkeypatch.setattr("tracker.live.camera._RETRY_S", 0.01)
    return FakeCapture


def test_a_camera_that_breaks_off_is_opened_again(camera):
    told = []
    with CameraStream("0", told.append) as stream:
        for _ in itertools.islice(stream.images(), 3):
            time.sleep(0.05)
    assert camera.opened >= 2
    assert any("sends no more pictures" in text for text in told)
    assert any("is open" in text for text in told)


def test_only_the_newest_picture_of_a_camera_waits(camera, monkeypatch):
    monkeypatch.setattr(camera, "read", lambda self: (True, np.zeros((4, 4, 3), np.uint8)))
    with CameraStream("0", print) as stream:
        images = stream.images()
        next(images)
        time.sleep(0.1)
        before_ns = time.time_ns()
        assert before_ns - next(images).stamp_ns < 80_000_000


def test_a_network_camera_is_waited_for_and_a_webcam_that_is_missing_is_said(camera):
    camera.is_there_at_once = False
    with CameraStream("rtsp://somewhere", print, must_be_there=False) as stream:
        assert next(stream.images()).width == 64
    camera.opened = 0
    with pytest.raises(RecordingError, match="raised-hand live --simulated"):
        CameraStream("0", print)


def test_what_is_neither_file_nor_camera_is_said():
    with pytest.raises(RecordingError, match="a camera is a number"):
        with live_events("nothing.mp4", Topics(), print, "map"):
            pass


def test_events_are_handed_over_at_their_time():
    now, slept = [0.0], []

    def sleep(seconds):
        slept.append(seconds)
        now[0] += seconds

    image = CameraImage(0, "", np.zeros((2, 2, 3), np.uint8))
    events = [(0, image), (10**9, image), (2 * 10**9, image)]
    for log_ns, _ in paced(iter(events), now_s=lambda: now[0], sleep=sleep):
        if log_ns == 10**9:
            now[0] += 5.0  # the computer was busy: the clock of what is played waits for it
    assert slept == pytest.approx([1.0])


def test_a_scene_goes_on_with_later_stamps_in_the_next_round():
    scene_s = 12.0
    stamps_ns = []
    for _, event in simulated_events("lonely", 1, 0.5):
        if isinstance(event, CameraImage):
            stamps_ns.append(event.stamp_ns)
        if stamps_ns and stamps_ns[-1] - stamps_ns[0] > 2 * scene_s * 1e9:
            break
    assert stamps_ns == sorted(set(stamps_ns))


def test_what_is_recorded_live_replays_to_the_same_frames(tmp_path):
    def run(events, record=None):
        seen = []
        pipeline = Pipeline(Config(), OneHand())
        run_live(
            events,
            pipeline,
            watchers=[lambda image, result, busy_s: seen.append(result)],
            record=record,
        )
        return [(item.stamp_ns, item.tracks.mean.tolist()) for item in seen]

    def until(events, seconds):
        for log_ns, event in events:
            if log_ns > first_ns + seconds * 10**9:
                return
            yield log_ns, event

    first_ns = next(simulated_events("lonely", 1, 10.0))[0]
    path = tmp_path / "live.mcap"
    live = run(until(simulated_events("lonely", 1, 10.0), 3), path)
    assert len(live) >= 25
    with open_recording(path) as recording:
        replayed = run(recording.events())
    assert [stamp for stamp, _ in replayed] == [stamp for stamp, _ in live]
    np.testing.assert_allclose(replayed[-1][1], live[-1][1], atol=1e-6)


def test_the_teller_says_who_raises_a_hand_and_what_becomes_of_the_call():
    pipeline, lines = Pipeline(Config(), OneHand()), []
    teller = Teller(lines.append)
    for number in range(8):
        image = CameraImage(10**10 + number * PERIOD_NS, "", np.zeros((48, 64, 3), np.uint8))
        teller.watch(image, pipeline.process(image), 0.01)
        if number == 6:
            pipeline.tracker.calls.obey(Command.parse("serve 1"))
    assert len(lines) == 2
    assert lines[0].startswith("#1 raises a hand at ")
    assert lines[1] == "#1 being served"
    assert teller.frames == 8
