"""What does a replay leave behind? A recording, a table and a video, written as it goes."""

from __future__ import annotations

from contextlib import ExitStack
from pathlib import Path
from types import TracebackType

import numpy as np

from tracker.config import NODE_NAME, Config
from tracker.containers import (
    CameraImage,
    FloatArray,
    FrameResult,
    ImageArray,
    OccupancyGrid,
    Scan,
)
from tracker.messages import (
    encode_markers,
    encode_raised,
    encode_tracks,
    encode_waiting_list,
)
from tracker.perception.gestures.customers import GestureNews
from tracker.recording import RecordingWriter
from tracker.report.replay.tracks_csv import TracksCsv
from tracker.report.video.birdseye import draw_birdseye
from tracker.report.video.debug_picture import draw_debug_image
from tracker.report.video.debug_video import DebugVideo, side_by_side
from tracker.transforms import StampedTransform

#: How far the picture from above reaches: farther once there is a customer to be shown there.
_AHEAD_M = (4.0, 6.0, 8.0)


def replay_files(out: Path) -> tuple[Path, ...]:
    """Every file of a replay: recording, table and video, then summary and picture."""
    names = ("output.mcap", "tracks.csv", "debug.mp4", "summary.json", "overview.png")
    return tuple(out / name for name in names)


class ReplayOutputs:
    """The files that grow with a recording; a context manager.

    They replace those of an earlier replay when the recording is over; after an error, that the
    recording itself is broken apart, those stay.

    Args:
        out: An existing folder.
        config: The parameters in force.

    Raises:
        OutputError: A file cannot be written.
    """

    def __init__(self, out: Path, config: Config) -> None:
        recording, table, video, *_ = replay_files(out)
        self._config = config
        self._ahead_m = _AHEAD_M[0]
        self._robot_xy_m: FloatArray | None = None
        self._gestures = GestureNews()
        with ExitStack() as opened:
            enter, frame = opened.enter_context, config.fixed_frame
            self._recording = enter(RecordingWriter(recording, fixed_frame=frame, overwrite=True))
            self._table = enter(TracksCsv(table))
            self._video = enter(DebugVideo(video, config.processing_rate))
            self._stack = opened.pop_all()

    def __enter__(self) -> ReplayOutputs:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        self._stack.__exit__(kind, error, traceback)

    def copy(self, log_ns: int, event: object) -> None:
        """Pass scans, transforms and maps on, so that the output can be looked at on its own."""
        if isinstance(event, Scan):
            self._recording.write("/scan", log_ns, event)
        elif isinstance(event, StampedTransform):
            topic = "/tf_static" if event.is_static else "/tf"
            self._recording.write(topic, log_ns, event)
        elif isinstance(event, OccupancyGrid):
            self._recording.write("/map", log_ns, event)

    def write(self, image: CameraImage, result: FrameResult) -> None:
        """Publish one processed image as the node would: the pose before the Bool."""
        put, stamp_ns, tracks = self._recording.write, result.stamp_ns, result.tracks
        if result.customer_pose is not None:
            put("/customer_pose", stamp_ns, result.customer_pose)
        if result.approach_pose is not None:
            put(f"/{NODE_NAME}/approach_pose", stamp_ns, result.approach_pose)
        put("/hand_raised", stamp_ns, result.hand_raised)
        raised = encode_raised(tracks, frame_id=result.frame_id, is_on_floor=result.is_on_floor)
        put(f"/{NODE_NAME}/raised_hands", stamp_ns, raised)
        self._write_waiting_list(result)
        for news in self._gestures.after(tracks):
            put(f"/{NODE_NAME}/gesture", stamp_ns, news)
        debug = draw_debug_image(image, result.hands, tracks, self._config)
        put("/hand_detection_debug", stamp_ns, CameraImage(stamp_ns, image.frame_id, debug))
        if result.frame_id is not None:
            confirmed, frame_id = tracks[tracks.confirmed], result.frame_id
            markers = encode_markers(confirmed, frame_id=frame_id, approach=result.approach_pose)
            said = encode_tracks(confirmed, frame_id=frame_id, is_on_floor=result.is_on_floor)
            put(f"/{NODE_NAME}/tracks", stamp_ns, said)
            put(f"/{NODE_NAME}/markers", stamp_ns, markers)
        self._table.write(result)
        self._video.write(self._side_by_side(image, result))

    def _write_waiting_list(self, result: FrameResult) -> None:
        """As the node: from the first image on at which the robot was located."""
        if result.sensor_pose is not None:
            self._robot_xy_m = result.sensor_pose[:2]
        if self._robot_xy_m is None:
            return
        said = encode_waiting_list(
            result.waiting_list,
            frame_id=self._config.fixed_frame,
            robot_xy_m=self._robot_xy_m,
            approach_distance_m=self._config.approach_distance_m,
        )
        self._recording.write(f"/{NODE_NAME}/waiting_list", result.stamp_ns, said)

    def _side_by_side(self, image: CameraImage, result: FrameResult) -> ImageArray:
        full_size = self._config.replace(downscale_factor=1)
        picture = draw_debug_image(image, result.hands, result.tracks, full_size)
        self._ahead_m = max(self._ahead_m, _reach_m(result))
        return side_by_side(picture, draw_birdseye(result, ahead_m=self._ahead_m))


def _reach_m(result: FrameResult) -> float:
    """How far the picture from above must reach to show every customer."""
    xy_m = result.tracks.mean[result.tracks.confirmed, :2]
    if result.sensor_pose is None or not len(xy_m):
        return _AHEAD_M[0]
    farthest_m = float(np.linalg.norm(xy_m - result.sensor_pose[:2], axis=1).max())
    return next((ahead_m for ahead_m in _AHEAD_M if ahead_m > farthest_m + 0.5), _AHEAD_M[-1])
