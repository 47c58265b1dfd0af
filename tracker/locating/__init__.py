"""Where in the fixed frame are camera, laser and map, at the stamps of the data?"""

from tracker.locating.camera import CameraLocator, CameraPlace, shown_ns
from tracker.locating.depth import DepthLocator
from tracker.locating.room_map import MapLocator
from tracker.locating.scan import choose_scan

__all__ = [
    "CameraLocator",
    "CameraPlace",
    "DepthLocator",
    "MapLocator",
    "choose_scan",
    "shown_ns",
]
