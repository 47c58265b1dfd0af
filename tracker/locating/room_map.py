"""Where does the map lie in the fixed frame? The same frame mostly, or by a transform."""

from __future__ import annotations

from tracker.config import Config
from tracker.containers import OccupancyGrid
from tracker.errors import TransformError
from tracker.locating.camera import CameraPlace
from tracker.notes import Note, NoteKind
from tracker.ranging import RoomMap
from tracker.transforms import Transforms


class MapLocator:
    """Keeps the newest map, and transforms it into the fixed frame."""

    def __init__(self) -> None:
        self._frame_id = ""
        self._room: RoomMap | None = None

    @property
    def has_map(self) -> bool:
        """Whether a map has come."""
        return self._room is not None

    def set_map(self, grid: OccupancyGrid) -> None:
        """Take in a map, in place of the one before."""
        self._frame_id, self._room = grid.frame_id.lstrip("/"), RoomMap.of(grid)

    def locate(
        self, transforms: Transforms, stamp_ns: int, camera: CameraPlace, config: Config
    ) -> tuple[RoomMap | None, list[Note]]:
        """The map for points of the fixed frame, at the stamp of an image.

        Args:
            transforms: Where frames were.
            stamp_ns: Of the image.
            camera: Where that was taken; without transforms nobody knows where the map is.
            config: `use_map`, and the fixed frame.

        Returns:
            The map; None where there is none, or it is not wanted or not located. And notes on it.
        """
        if self._room is None or not config.use_map or not camera.is_located:
            return None, []
        fixed = config.fixed_frame.lstrip("/")
        if self._frame_id in ("", fixed):
            return self._room, []
        try:
            map_from_fixed = transforms.lookup(self._frame_id, fixed, stamp_ns)
        except TransformError as error:
            return None, [Note(NoteKind.MAP_NOT_LOCATED, f"map unused: {error}")]
        return self._room.seen_from(map_from_fixed), []
