"""Image in, hands out: model files, search, landmarks, following, poses, the verdict."""

from typing import TYPE_CHECKING, Any

from tracker.perception.detector import HandDetector

if TYPE_CHECKING:
    from tracker.perception.hands.hand_finder import HandFinder
    from tracker.perception.opening import open_detector

__all__ = ["HandDetector", "HandFinder", "open_detector"]


def __getattr__(name: str) -> Any:
    """These import OpenCV and ONNX Runtime; other detectors need neither."""
    if name == "HandFinder":
        from tracker.perception.hands.hand_finder import HandFinder

        return HandFinder
    if name == "open_detector":
        from tracker.perception.opening import open_detector

        return open_detector
    raise AttributeError(f"module 'tracker.perception' has no attribute {name!r}")
