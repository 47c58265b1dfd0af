"""Chooses pictures of a recording for its page: those in which a hand has just gone up."""

from __future__ import annotations

from tracker.config import Config
from tracker.containers import CameraImage, FrameResult
from tracker.report.page import Picture
from tracker.report.video.debug_picture import draw_debug_image

_KEPT = 8


class Moments:
    """Draws and keeps a few pictures of a recording of any length, spread over it.

    Args:
        config: How the picture is drawn.
    """

    def __init__(self, config: Config) -> None:
        self._config = config.replace(downscale_factor=1)
        self._raises = _Spread()
        self._others = _Spread()
        self._up: frozenset[int] = frozenset()
        self._start_ns: int | None = None

    def write(self, image: CameraImage, result: FrameResult) -> None:
        """Take in an image and what it led to; it is drawn only if it may be kept."""
        if self._start_ns is None:
            self._start_ns = result.stamp_ns
        tracks = result.tracks
        up = frozenset(tracks.id[tracks.raised & tracks.confirmed].tolist())
        came, self._up = up - self._up, up
        spread = self._raises if came else self._others
        if spread.wants_next():
            words = ", ".join(f"#{key}" for key in sorted(came)) + " up" if came else ""
            at_s = f"{(result.stamp_ns - self._start_ns) / 1e9:.1f} s"
            picture = draw_debug_image(image, result.hands, tracks, self._config)
            spread.keep(Picture.photo(picture, ": ".join(filter(None, [at_s, words]))))

    @property
    def pictures(self) -> tuple[Picture, ...]:
        """At most eight, in order of time; any images where no hand was ever up."""
        return tuple(self._raises.kept or self._others.kept)


class _Spread:
    """Every so many-th of what comes, so that no more than `_KEPT` are kept."""

    def __init__(self) -> None:
        self.kept: list[Picture] = []
        self._stride = 1
        self._count = 0

    def wants_next(self) -> bool:
        self._count += 1
        return (self._count - 1) % self._stride == 0

    def keep(self, picture: Picture) -> None:
        self.kept.append(picture)
        if len(self.kept) > _KEPT:
            del self.kept[1::2]
            self._stride *= 2
