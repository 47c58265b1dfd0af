"""How can one watch a replay? In Rerun's viewer while it runs, or from a recording for it.

    camera/image, hands, torsos    the picture, what was found in it, and whose it is
    map/scan, robot, trails        beams, camera and everybody's way, in meters of the fixed frame
    map/people, ellipses, served   customers, their 2-sigma ellipses, and who is served
    hand_raised, existence/ID      over time, 0 to 1
    served                         over time, as a state

The only timeline is `stamp`, the sensors' own time.
"""

from __future__ import annotations

from pathlib import Path
from socket import socket
from time import sleep
from typing import Any

import cv2
import numpy as np

from tracker.containers import CameraImage, FloatArray, FrameResult, Hands, Tracks
from tracker.errors import ConfigError
from tracker.outputs import GrowingFile, GrowingOutput, unwritable
from tracker.report.palette import FADED, LIT, ROBOT, WALL, person_color
from tracker.report.video.debug_picture import FINGER_ROOTS, FINGERS, LOWERED_COLOR, RAISED_COLOR

_TIMELINE = "stamp"
_JPEG_QUALITY = 85
_SIGMAS = 2.0
_CIRCLE = np.stack(
    [np.cos(np.linspace(0, 2 * np.pi, 41)), np.sin(np.linspace(0, 2 * np.pi, 41))], axis=-1
)
_EYE_M, _LOOKED_AT_M = (1.5, 0.0, 9.0), (1.5, 0.0, 0.0)  # from above, at what is ahead
_NOBODY = "nobody"
_VIEWER = ("127.0.0.1", 9876)  # Rerun's own port
_SETTLING_S, _FLUSH_S = 1.5, 10.0


class RerunView(GrowingOutput):
    """Shows each image of a replay; a context manager.

    Args:
        live: Open the viewer, and stream to it.
        save: The .rrd file to write, replaced if it exists; None for none.

    Attributes:
        trouble: Why nobody can watch live, in a sentence; empty where somebody can.

    Raises:
        ConfigError: Rerun is not installed.
        OutputError: The file cannot be created.
    """

    def __init__(self, *, live: bool = False, save: Path | None = None) -> None:
        try:
            import rerun
        except ImportError as error:
            raise ConfigError(
                "The view needs Rerun, which is not installed: pip install "
                "'.[view]' in the project's folder, with Python 3.11 or newer and numpy 2."
            ) from error
        self._rerun = rerun
        self._place: GrowingFile | None = None
        self._stream = rerun.RecordingStream("raised_hand_tracker")
        self._stream.set_log_time_enabled(False)
        self._stream.set_log_tick_enabled(False)
        self.trouble = ""
        sinks = []
        if save is not None:
            self._place = GrowingFile(save)
            sinks.append(_file_sink(save, self._place.path))
        if live and self._start_viewer():
            sinks.append(rerun.GrpcSink())
        self._is_shown = bool(sinks)
        if sinks:  # without any, Rerun would keep it all in memory
            self._stream.set_sinks(*sinks, default_blueprint=_blueprint())
        self._stream.log("map", rerun.ViewCoordinates.RIGHT_HAND_Z_UP, static=True)
        line = rerun.SeriesLines(
            colors=_rgba(LIT), names="hand_raised", widths=3, interpolation_mode="StepAfter"
        )
        self._stream.log("hand_raised", line, static=True)
        self._last_xy_m: dict[int, FloatArray] = {}
        self._known: set[int] = set()
        self._served: str | None = None

    def watch(self, image: CameraImage, result: FrameResult, busy_s: float = 0.0) -> None:
        """Show an image and what it led to.

        Args:
            image: The picture.
            result: What the pipeline made of it.
            busy_s: Not shown.
        """
        if not self._is_shown:
            return
        stamp = np.datetime64(result.stamp_ns, "ns")
        self._stream.set_time(_TIMELINE, timestamp=stamp)
        self._show_camera(image, result.hands)
        self._show_room(result)
        tracks = result.tracks[result.tracks.confirmed]
        self._show_people(tracks)
        self._show_states(tracks, result.hand_raised)

    def close(self) -> None:
        """The file is whole and replaces an earlier one.

        Raises:
            OutputError: It cannot be renamed.
        """
        self.break_off()
        if self._place is not None:
            self._place.finish()

    def break_off(self) -> None:
        """As `GrowingOutput.break_off`."""
        try:
            self._stream.flush(timeout_sec=_FLUSH_S)
        except RuntimeError as error:  # the viewer was closed, or hangs
            self.trouble = f"the viewer did not receive everything ({error})."
        self._stream.disconnect()

    def _start_viewer(self) -> bool:
        """Whether there is one, which has not given up right away for want of a screen."""
        try:
            self._rerun.spawn(connect=False, recording=self._stream, hide_welcome_screen=True)
        except RuntimeError as error:
            self.trouble = f"the viewer cannot start ({error}); check it, or use --save-view."
            return False
        for _ in range(3):
            sleep(_SETTLING_S / 3)
            with socket() as probe:
                if probe.connect_ex(_VIEWER) != 0:
                    self.trouble = (
                        "the viewer cannot start: it needs a screen (DISPLAY or WAYLAND_DISPLAY); "
                        "use --save-view, and open the file where there is one."
                    )
                    return False
        return True

    def _show_camera(self, image: CameraImage, hands: Hands) -> None:
        rerun, log = self._rerun, self._stream.log
        _, jpeg = cv2.imencode(".jpg", image.bgr, [cv2.IMWRITE_JPEG_QUALITY, _JPEG_QUALITY])
        picture = rerun.EncodedImage(contents=jpeg.tobytes(), media_type="image/jpeg")
        log("camera/image", picture)
        chains = [list(chain) for chain in (*FINGERS, FINGER_ROOTS)]
        bones = [points[chain] for points in hands.landmarks_px for chain in chains]
        shades = [RAISED_COLOR if is_up else LOWERED_COLOR for is_up in hands.raised]
        colors = [shade[::-1] for shade in shades for _ in chains]
        log("camera/hands", rerun.LineStrips2D(bones, colors=colors, radii=1.5))
        owned = hands[hands.is_owned]
        arms = np.stack([owned.wrist_px, owned.torso_px], axis=1)
        log("camera/torsos", rerun.LineStrips2D(arms, colors=_rgba(FADED), radii=1.0))

    def _show_room(self, result: FrameResult) -> None:
        rerun, log = self._rerun, self._stream.log
        beams_m = np.zeros((0, 2))
        if result.scan is not None:
            beams_m = result.scan.returns_m()
        log("map/scan", rerun.Points3D(_on_floor(beams_m), colors=_rgba(WALL), radii=0.015))
        if result.sensor_pose is not None:
            x, y, yaw = result.sensor_pose
            nose = [[0.35 * np.cos(yaw), 0.35 * np.sin(yaw), 0.0]]
            robot = rerun.Arrows3D(
                vectors=nose,
                origins=[[x, y, 0.0]],
                radii=0.04,
                colors=_rgba(ROBOT),
                labels="camera",
            )
            log("map/robot", robot)

    def _show_people(self, tracks: Tracks) -> None:
        rerun, log = self._rerun, self._stream.log
        ids, xy_m = tracks.id.tolist(), tracks.mean[:, :2]
        colors = [_rgba(person_color(key)) for key in ids]
        places = _on_floor(xy_m)
        people = rerun.Points3D(
            places,
            colors=colors,
            radii=[0.06 if is_up else 0.03 for is_up in tracks.raised],
            labels=[_label(tracks, row) for row in range(len(tracks))],
            show_labels=True,
        )
        log("map/people", people)
        ellipses = [_on_floor(rim) for rim in _ellipses(tracks)]
        log("map/ellipses", rerun.LineStrips3D(ellipses, colors=colors, radii=0.01))
        row = tracks.row_of(tracks.selected_id)
        rings = [] if row is None else [_on_floor(xy_m[row] + 0.3 * _CIRCLE)]
        log("map/served", rerun.LineStrips3D(rings, colors=_rgba(LIT), radii=0.04))
        # A step of the trail with each image; the viewer shows those of all images until now.
        steps = [
            _on_floor(np.stack([self._last_xy_m.get(key, xy), xy]))
            for key, xy in zip(ids, xy_m, strict=True)
        ]
        log("map/trails", rerun.LineStrips3D(steps, colors=colors, radii=0.012))
        self._last_xy_m = dict(zip(ids, xy_m, strict=True))

    def _show_states(self, tracks: Tracks, hand_raised: bool) -> None:
        rerun, log = self._rerun, self._stream.log
        log("hand_raised", rerun.Scalars(float(hand_raised)))
        for track_id, existence in zip(tracks.id.tolist(), tracks.existence, strict=True):
            entity = f"existence/{track_id}"
            if track_id not in self._known:
                self._known.add(track_id)
                line = rerun.SeriesLines(
                    colors=_rgba(person_color(track_id)), names=f"#{track_id}"
                )
                log(entity, line, static=True)
            log(entity, rerun.Scalars(float(existence)))
        served = _NOBODY if tracks.selected_id is None else f"#{tracks.selected_id}"
        if served != self._served:
            log("served", rerun.StateChange(state=served))
            self._served = served


def _file_sink(name: Path, path: Path) -> Any:
    import rerun

    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        path.open("wb").close()
    except OSError as error:
        raise unwritable(name, error) from error
    return rerun.FileSink(path)


def _blueprint() -> Any:
    """Camera and map beside each other, below them what happens over time."""
    import rerun.blueprint as rrb

    until_now = rrb.VisibleTimeRanges(
        timeline=_TIMELINE,
        start=rrb.TimeRangeBoundary.infinite(),
        end=rrb.TimeRangeBoundary.cursor_relative(),
    )
    room = rrb.Spatial3DView(
        origin="map",
        name="Map",
        overrides={"map/trails": until_now},
        eye_controls=rrb.EyeControls3D(
            position=_EYE_M, look_target=_LOOKED_AT_M, eye_up=(1.0, 0.0, 0.0)
        ),
    )
    camera = rrb.Spatial2DView(origin="camera", name="Camera")
    raised = rrb.TimeSeriesView(
        contents=["hand_raised", "existence/**"],
        name="Hand raised, and who exists",
        axis_y=rrb.ScalarAxis(range=(-0.05, 1.05)),
    )
    served = rrb.StateTimelineView(origin="served", name="Who is served")
    return rrb.Blueprint(
        rrb.Vertical(
            rrb.Horizontal(camera, room),
            raised,
            served,
            row_shares=[5, 2, 1],
        ),
        rrb.TimePanel(timeline=_TIMELINE, state="collapsed"),
        rrb.SelectionPanel(state="collapsed"),
        rrb.BlueprintPanel(state="collapsed"),
    )


def _ellipses(tracks: Tracks) -> FloatArray:
    """Shape (N, 41, 2): rims of the 2-sigma ellipses."""
    values, vectors = np.linalg.eigh(tracks.covariance[:, :2, :2])
    axes = vectors * (_SIGMAS * np.sqrt(np.maximum(values, 0.0)))[:, None, :]
    return np.asarray(tracks.mean[:, None, :2] + _CIRCLE @ axes.transpose(0, 2, 1))


def _label(tracks: Tracks, row: int) -> str:
    parts = [f"#{tracks.id[row]}", f"{tracks.existence[row]:.0%}"]
    parts += ["hand up"] if tracks.raised[row] else []
    parts += ["served"] if tracks.id[row] == tracks.selected_id else []
    return " ".join(parts)


def _rgba(color: str) -> int:
    """A color of the palette as Rerun wants it, 0xRRGGBBAA."""
    return int(color[1:] + "ff", 16)


def _on_floor(xy_m: FloatArray) -> FloatArray:
    """Shape (..., 3): the same points at height 0."""
    return np.concatenate([xy_m, np.zeros((*xy_m.shape[:-1], 1))], axis=-1)
