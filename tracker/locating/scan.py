"""Which scan belongs to an image? The nearest in time that can be located.

Transforms come later than scans: the nearest scan may lie beyond the last of them, where the one
before serves as well.
"""

from __future__ import annotations

import numpy as np

from tracker.config import Config
from tracker.containers import LocatedScan, Scan
from tracker.errors import TransformError
from tracker.geometry import RigidTransform
from tracker.locating.camera import CameraPlace, mounted
from tracker.notes import Note, NoteKind
from tracker.ranging import body_pose, locate_scan
from tracker.transforms import Transforms
from tracker.wording import counted

#: A person is seen by two beams at least.
_BEAMS_MIN = 2
#: A scanner tilted beyond this cuts a room from floor to ceiling; walls would look like people.
_TILT_MAX_DEG = 60.0


def choose_scan(
    scans: list[Scan],
    transforms: Transforms,
    stamp_ns: int,
    camera: CameraPlace,
    config: Config,
) -> tuple[LocatedScan | None, list[Note]]:
    """The scan that is used for an image, in the fixed frame at its own stamp.

    Args:
        scans: Those that have come, the nearest first.
        transforms: Where frames were.
        stamp_ns: Of what the image shows.
        camera: Where that was taken; without transforms the laser is beside it.
        config: The frames and the ranging group.

    Returns:
        The scan; None with the reason where none can be used. And notes about it.
    """
    timely = [
        scan for scan in scans if abs(scan.stamp_ns - stamp_ns) <= config.scan_max_age_s * 1e9
    ]
    usable = [scan for scan in timely if len(scan.ranges_m) >= _BEAMS_MIN]
    if not usable:
        return None, [_why_none(scans, timely, stamp_ns, config)]
    notes: list[Note] = []
    if not camera.is_located or config.fixed_frame == config.camera_frame:
        fixed_from_laser = _beside_camera(usable[0], transforms, camera, config)
        if fixed_from_laser is None:
            text = "no transform of the laser: it is assumed to be at the camera"
            notes.append(Note(NoteKind.LASER_MOUNTING_UNKNOWN, text))
        return _judged(locate_scan(usable[0], fixed_from_laser or _level(camera)), config, notes)
    failures = []
    for scan in usable:
        try:
            begin = transforms.lookup(config.fixed_frame, scan.frame_id, scan.stamp_ns)
        except TransformError as error:
            failures.append(error)
        else:
            tilt_deg = float(np.degrees(np.arccos(min(1.0, abs(begin.matrix[2, 2])))))
            if tilt_deg > _TILT_MAX_DEG:
                text = (
                    f"the scanner is tilted by {tilt_deg:.0f} degrees, so that it sees no people"
                )
                return None, [*notes, Note(NoteKind.SCAN_TOO_STEEP, text)]
            located = locate_scan(scan, begin, _at_end(scan, transforms, config))
            return _judged(located, config, notes)
    return None, [*notes, Note(NoteKind.SCAN_NOT_LOCATED, f"scan unused: {failures[0]}")]


def _judged(
    scan: LocatedScan, config: Config, notes: list[Note]
) -> tuple[LocatedScan, list[Note]]:
    """The scan, with a note where it cannot show anybody."""
    if not np.isfinite(scan.range_m).any():
        text = "no beam of the scan has a return"
    elif not scan.valid.any():
        text = "every beam of the scan ends on the floor or above people's heads"
    elif not len(scan.returns_m(config.person_range_max_m)):
        text = f"no beam of the scan ends within {config.person_range_max_m:g} m"
    else:
        return scan, notes
    return scan, [*notes, Note(NoteKind.SCAN_WITHOUT_RETURNS, text)]


def _why_none(scans: list[Scan], timely: list[Scan], stamp_ns: int, config: Config) -> Note:
    if timely:
        beams = counted(len(timely[0].ranges_m), "beam")
        text = f"the scan has {beams}; {_BEAMS_MIN} or more are needed"
        return Note(NoteKind.SCAN_WITHOUT_BEAMS, text)
    if not scans:
        return Note(NoteKind.NO_SCAN, "no scan was received")
    off_s = (scans[0].stamp_ns - stamp_ns) / 1e9
    where = f"{abs(off_s):.3f} s {'later' if off_s > 0 else 'earlier'}"
    text = f"no scan within {config.scan_max_age_s:g} s: the nearest is {where}"
    return Note(NoteKind.SCAN_TOO_OLD, text)


def _at_end(scan: Scan, transforms: Transforms, config: Config) -> RigidTransform | None:
    """The laser at the last beam of a scan, where transforms allow."""
    try:
        return transforms.lookup(config.fixed_frame, scan.frame_id, scan.end_ns)
    except TransformError:
        return None


def _beside_camera(
    scan: Scan, transforms: Transforms, camera: CameraPlace, config: Config
) -> RigidTransform | None:
    """The laser by its mounting beside the camera, where that is known."""
    frame = config.camera_frame
    try:
        mounting = transforms.lookup(scan.frame_id, frame, scan.stamp_ns)
    except TransformError:
        return None
    laser_from_camera = mounted(body_pose(mounting, frame, config.camera_axes), config)
    return camera.fixed_from_camera @ laser_from_camera.inverse()


def _level(camera: CameraPlace) -> RigidTransform:
    """A laser in the camera's place, level however the camera is rolled."""
    x_m, y_m, yaw_rad = camera.fixed_from_camera.planar
    return RigidTransform.from_planar(x_m, y_m, yaw_rad)
