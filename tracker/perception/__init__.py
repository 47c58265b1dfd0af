"""Image in, hands out: model files, palm search, landmarks, following, raise rules, drawing."""

from typing import TYPE_CHECKING, Any

from tracker.perception.detector import HandDetector

if TYPE_CHECKING:
    from tracker.perception.hand_finder import HandFinder

__all__ = ["HandDetector", "HandFinder"]


def __getattr__(name: str) -> Any:
    """`HandFinder` brings OpenCV and ONNX Runtime along; other detectors need neither."""
    if name == "HandFinder":
        from tracker.perception.hand_finder import HandFinder

        return HandFinder
    raise AttributeError(f"module 'tracker.perception' has no attribute {name!r}")
