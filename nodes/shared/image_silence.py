"""When the camera is silent for too long, nobody is reported."""

from __future__ import annotations

from tracker.config import Config


def patience_s(config: Config) -> float:
    """A camera is silent, and nobody is reported, once no image was processed for this long.

    Images that come and cannot be used are silence too. Who asks for a low `processing_rate` gets
    an image each period at best, so one of them may always fail to come.
    """
    return max(config.image_silence_s, 2.0 / config.processing_rate)
