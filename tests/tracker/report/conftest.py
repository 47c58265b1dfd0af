"""A hand-made afternoon: three customers, a turning camera, a room with walls and a table."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from tracker.containers import FrameResult, Hands, LocatedScan, Measurements, Scan, Tracks
from tracker.geometry import RigidTransform
from tracker.notes import Note, NoteKind
from tracker.ranging import locate_scan

START_NS = 1_700_000_000_123_456_789
PERIOD_NS = 100_000_000

# Corner points of closed lines: the room, and two tables.
ROOM = (
    ((-1.0, -2.6), (4.6, -2.6), (4.6, 2.6), (-1.0, 2.6)),
    ((2.9, -0.45), (3.7, -0.45), (3.7, 0.45), (2.9, 0.45)),
    ((1.2, -2.3), (2.0, -2.3), (2.0, -1.75), (1.2, -1.75)),
)
# id, place at the start, velocity, and when the hand is up (frames).
PEOPLE = (
    (1, (1.5, 0.75), (0.0, 0.004), ((20, 75), (240, 290))),
    (2, (2.1, -0.75), (0.0, -0.0008), ((55, 130),)),
    (4, (2.6, 1.35), (-0.0016, 0.001), ((160, 230),)),
)
FRAMES = 320


def _place(start: tuple[float, float], step: tuple[float, float], frame: int) -> np.ndarray:
    return np.array(start) + np.array(step) * min(frame, 120)


def _scan(stamp_ns: int, pose: np.ndarray, bodies: list[np.ndarray], rng) -> LocatedScan:
    angles = np.linspace(-np.pi, np.pi, 720, endpoint=False)
    directions = np.stack([np.cos(angles + pose[2]), np.sin(angles + pose[2])], axis=-1)
    ranges = np.full(len(angles), np.inf)
    for corners in ROOM:
        for a, b in zip(corners, corners[1:] + corners[:1], strict=True):
            edge, to_a = np.subtract(b, a), np.subtract(a, pose[:2])
            cross = directions[:, 0] * edge[1] - directions[:, 1] * edge[0]
            with np.errstate(divide="ignore", invalid="ignore"):
                t = (to_a[0] * edge[1] - to_a[1] * edge[0]) / cross
                u = (to_a[0] * directions[:, 1] - to_a[1] * directions[:, 0]) / cross
            hit = (t > 0.05) & (u >= 0) & (u <= 1)
            ranges[hit] = np.minimum(ranges[hit], t[hit])
    for body in bodies:
        for side in (-0.1, 0.1):
            to_leg = body + np.array([0.0, side]) - pose[:2]
            along = directions @ to_leg
            off = np.abs(directions[:, 0] * to_leg[1] - directions[:, 1] * to_leg[0])
            hit = (off < 0.07) & (along > 0.1)
            near = along[hit] - np.sqrt(0.07**2 - off[hit] ** 2)
            ranges[hit] = np.minimum(ranges[hit], near)
    ranges += rng.normal(0, 0.01, len(ranges))
    scan = Scan(stamp_ns, "laser", -np.pi, float(angles[1] - angles[0]), 0.05, 20.0, ranges)
    return locate_scan(scan, RigidTransform.from_planar(*pose))


def make_result(frame: int, rng: np.random.Generator) -> FrameResult:
    stamp_ns = START_NS + frame * PERIOD_NS
    pose = np.array([0.1 + 0.0012 * frame, -0.0008 * frame, 0.35 * np.sin(frame / 40)])
    rows = []
    for number, start, step, spans in PEOPLE:
        first = spans[0][0]
        if frame < first:
            continue
        up = any(a + 2 <= frame < b + 3 for a, b in spans)
        since = max((a + 2 for a, _ in spans if frame >= a + 2), default=None)
        away = _place(start, step, frame) - pose[:2]
        spread = 0.05 + 0.12 * np.exp(-(frame - first) / 15)
        ray = away / np.linalg.norm(away)
        across = np.array([-ray[1], ray[0]])
        covariance = np.zeros((4, 4))
        covariance[:2, :2] = spread**2 * (np.outer(ray, ray) + 0.25 * np.outer(across, across))
        covariance[2:, 2:] = np.eye(2) * 0.04
        mean = np.r_[_place(start, step, frame) + rng.normal(0, 0.015, 2) + 0.06 * ray, 0.0, 0.0]
        rows.append(
            {
                "id": number, "mean": mean, "covariance": covariance, "existence": 0.97,
                "confirmed": frame >= first + 4, "raised": up,
                "raised_since_ns": -1 if since is None else START_NS + since * PERIOD_NS,
                "age_s": (frame - first) / 10, "unseen_s": 0.0, "hand": -1,
            }
        )  # fmt: skip
    selected = None
    up_ids = [row["id"] for row in rows if row["raised"] and row["confirmed"]]
    if up_ids:
        selected = min(
            up_ids, key=lambda i: next(r for r in rows if r["id"] == i)["raised_since_ns"]
        )
    tracks = Tracks.none(stamp_ns)
    if rows:
        tracks = Tracks(
            stamp_ns, **{k: np.array([r[k] for r in rows]) for k in rows[0]}, selected_id=selected
        )
    seen = [row for row in rows if row["raised"]]
    measurements = Measurements.none()
    if seen:
        offsets = np.array([row["mean"][:2] - pose[:2] for row in seen])
        measurements = Measurements.polar(
            np.arctan2(offsets[:, 1], offsets[:, 0]) - pose[2],
            np.linalg.norm(offsets, axis=-1), 0.02, 0.1, pose,
        )  # fmt: skip
    bodies = [_place(start, step, frame) for _, start, step, _ in PEOPLE]
    return FrameResult(
        stamp_ns=stamp_ns, hands=Hands.none(), measurements=measurements, tracks=tracks,
        hand_raised=bool(up_ids), customer_pose=None, approach_pose=None, sensor_pose=pose,
        scan=_scan(stamp_ns, pose, bodies, rng),
        notes=() if frame % 100 else (Note(NoteKind.SCAN_TOO_OLD, "no scan within 0.25 s"),),
    )  # fmt: skip


@pytest.fixture(scope="session")
def results() -> list[FrameResult]:
    """320 images at 10 Hz."""
    rng = np.random.default_rng(5)
    return [make_result(frame, rng) for frame in range(FRAMES)]


@pytest.fixture
def result_of() -> Callable[..., FrameResult]:
    """Builds a result from (id, x, y, raised) rows, all confirmed, existence 0.9."""

    def build(stamp_ns: int, *people: tuple, selected: int | None = None, **fields) -> FrameResult:
        count = len(people)
        ids, x, y, raised = (
            (np.array(column) for column in zip(*people, strict=True))
            if count
            else (np.zeros(0),) * 4
        )
        tracks = Tracks(
            stamp_ns=stamp_ns, id=ids,
            mean=np.stack([x, y, np.zeros(count), np.zeros(count)], axis=-1),
            covariance=np.tile(np.diag([0.04, 0.01, 0.1, 0.1]), (count, 1, 1)),
            existence=np.full(count, 0.9), confirmed=np.ones(count), raised=raised,
            raised_since_ns=np.full(count, -1), age_s=np.zeros(count), unseen_s=np.zeros(count),
            hand=np.full(count, -1), selected_id=selected,
        )  # fmt: skip
        values = {
            "hands": Hands.none(), "measurements": Measurements.none(), "customer_pose": None,
            "approach_pose": None, "sensor_pose": None, "scan": None,
            "hand_raised": bool(np.any(raised)),
        }  # fmt: skip
        return FrameResult(stamp_ns=stamp_ns, tracks=tracks, **{**values, **fields})

    return build
