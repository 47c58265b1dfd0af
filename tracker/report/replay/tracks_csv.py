"""What does tracks.csv hold? One line per confirmed customer and processed image."""

from __future__ import annotations

import errno
from pathlib import Path

from tracker.containers import FrameResult
from tracker.outputs import GrowingFile, GrowingOutput, unwritable

COLUMNS = (
    "stamp_s", "track_id", "x_m", "y_m", "vx_mps", "vy_mps",
    "var_x", "var_xy", "var_y", "existence", "raised", "selected",
)  # fmt: skip


class TracksCsv(GrowingOutput):
    """Writes confirmed customers line by line; what is written stays readable after a crash.

    Args:
        path: The file, replaced if it exists.

    Raises:
        RecordingError: The file cannot be created; later, that it cannot be written.
    """

    def __init__(self, path: str | Path) -> None:
        self._path = Path(path)
        self._place = GrowingFile(self._path)
        try:
            self._file = self._place.path.open("wb", buffering=0)  # a crash loses no line
        except OSError as error:
            raise unwritable(self._path, error) from error
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
        """The table is whole and replaces an earlier one.

        Raises:
            OutputError: It cannot be renamed.
        """
        self._file.close()
        self._place.finish()

    def break_off(self) -> None:
        """As `GrowingOutput.break_off`."""
        self._file.close()

    def _put(self, text: str) -> None:
        line = text.encode("ascii")
        try:
            written = self._file.write(line)
        except OSError as error:
            self._file.close()
            raise unwritable(self._path, error) from error
        if written != len(line):
            self._file.close()
            full = OSError(errno.ENOSPC, "only a part could be written")
            raise unwritable(self._path, full)
