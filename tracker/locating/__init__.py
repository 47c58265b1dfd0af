"""Where in the fixed frame are camera and laser, at the stamps of their own data?"""

from tracker.locating.camera import CameraLocator, CameraPlace
from tracker.locating.depth import DepthLocator
from tracker.locating.scan import choose_scan

__all__ = ["CameraLocator", "CameraPlace", "DepthLocator", "choose_scan"]
