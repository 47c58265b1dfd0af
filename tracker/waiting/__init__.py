"""Where images, scans and transforms wait for each other, in a recording and on a robot alike."""

from tracker.waiting.image_gate import ImageGate, Verdict
from tracker.waiting.image_queue import IMAGES_KEPT, ImageQueue, WaitingImage
from tracker.waiting.room import WaitingRoom

__all__ = ["IMAGES_KEPT", "ImageGate", "ImageQueue", "Verdict", "WaitingImage", "WaitingRoom"]
