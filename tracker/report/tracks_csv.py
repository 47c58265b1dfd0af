"""What does tracks.csv hold? One line per confirmed customer and processed image."""

from __future__ import annotations

from pathlib import Path

from tracker.closing import Closing
from tracker.containers import FrameResult
from tracker.errors import RecordingError

COLUMNS = (
    "stamp_s", "track_id", "x_m", "y_m", "vx_mps", "vy_mps",
    "var_x", "var_xy", "var_y", "existence", "raised", "selected",
)  # fmt: skip


class TracksCsv(Closing):
    """Writes confirmed customers line by line; what is written stays readable after a crash.

    Args:
        path: The file, replaced if it exists.

    Raises:
        RecordingError: The file cannot be created; later, that it cannot be written.
    """

    def __init__(self, path: str | Path) -> None:
        self._path = Path(path)
        try:
            self._file = self._path.open("wb", buffering=0)  # nothing is left behind in a crash
        except OSError as error:
            raise self._failure("created", error.strerror) from error
        self._put(",".join(COLUMNS) + "\n")

    def write(self, result: FrameResult) -> None:
        """Append the confirmed customers of one image.

        Raises:
            RecordingError: The disk does not take it.
        """
        tracks = result.tracks[result.tracks.confirmed]
        stamp = f"{tracks.stamp_ns // 10**9}.{tracks.stamp_ns % 10**9:09d}"
        lines = []
        for row in range(len(tracks)):
            x, y, vx, vy = tracks.mean[row]
            p = tracks.covariance[row]
            is_selected = int(tracks.id[row] == tracks.selected_id)
            lines.append(
                f"{stamp},{tracks.id[row]},{x:.6f},{y:.6f},{vx:.6f},{vy:.6f},"
                f"{p[0, 0]:.9g},{p[0, 1]:.9g},{p[1, 1]:.9g},"
                f"{tracks.existence[row]:.6f},{int(tracks.raised[row])},{is_selected}\n"
            )
        if lines:
            self._put("".join(lines))

    def close(self) -> None:
        """Nothing more comes."""
        self._file.close()

    def _put(self, text: str) -> None:
        line = text.encode("ascii")
        try:
            written = self._file.write(line)
        except OSError as error:
            self._file.close()
            raise self._failure("written", error.strerror) from error
        if written != len(line):
            self._file.close()
            raise self._failure("written", "the disk took only a part")

    def _failure(self, verb: str, reason: str | None) -> RecordingError:
        return RecordingError(
            f"{self._path}: cannot be {verb} ({reason}); "
            "a folder that exists, may be written and has room is needed."
        )
