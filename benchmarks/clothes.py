"""How well do clothes tell people apart? The numbers behind `tracker/tracking/appearance.py`.

    python benchmarks/clothes.py [--rooms 60] [--seed 7] [--photos FOLDER]

Guests in clothes of random colors are painted twice: at other places, before another wall, in
other light and by another white balance. Distances between histograms of the same guest, and of
different guests, have two distributions, and their ratio is what a distance is worth. With a
folder of photos, real hands are found in each picture and in changed copies of it (scale, shift,
light, white balance), and the same figures are printed for them, and for both together.
"""

from __future__ import annotations

import argparse
import colorsys
from itertools import combinations
from pathlib import Path

import cv2
import numpy as np
from scipy.optimize import minimize

from tracker import CameraImage, Config, Hands
from tracker.perception.clothes import clothes_histograms
from tracker.simulation import scene_from_mapping
from tracker.simulation.arm import raised_hand_landmarks
from tracker.simulation.camera_view import CameraView, hands_in_view, is_from_behind, look_of
from tracker.simulation.motion import people_at
from tracker.simulation.projection import Viewpoint
from tracker.simulation.stream import map_from_camera
from tracker.tracking.appearance import hellinger

GUESTS = 4
#: Spread of each landmark, in palm lengths: the model's, and people who hold a hand otherwise.
LANDMARK_STD = 0.1
Seen = dict[tuple[int, int], list[np.ndarray]]  # histograms by (room, person)


def color(rng: np.random.Generator) -> str:
    """Of a shirt: one in three is black, gray or white, the others have any hue."""
    gray = rng.random() < 1 / 3
    saturation = rng.uniform(0.0, 0.08) if gray else rng.uniform(0.2, 0.9)
    rgb = colorsys.hsv_to_rgb(rng.random(), saturation, rng.uniform(0.15, 0.95))
    return "#" + "".join(f"{round(255 * channel):02x}" for channel in rgb)


def in_other_light(bgr: np.ndarray, rng: np.random.Generator) -> np.ndarray:
    """Up to 1.6 times darker or lighter, white balance off by 6 % a channel."""
    gain = 1.6 ** rng.uniform(-1.0, 1.0) * (1.0 + 0.06 * rng.standard_normal(3))
    return np.clip(bgr * gain, 0, 255).astype(np.uint8)


def rendered(rooms: int, rng: np.random.Generator) -> Seen:
    """Histograms of guests in rooms, each room painted twice."""
    seen: Seen = {}
    for room in range(rooms):
        looks = [
            {"shirt": color(rng), "trousers": color(rng), "stature_m": rng.uniform(1.55, 1.9)}
            for _ in range(GUESTS)
        ]
        for _ in range(2):
            bearings = np.linspace(-0.5, 0.5, GUESTS)[rng.permutation(GUESTS)]
            ranges = rng.uniform(1.2, 4.5, GUESTS)
            people = [
                {
                    "id": 1 + row, "look": look, "hand": str(rng.choice(["left", "right"])),
                    "seat_m": 0.5 if rng.random() < 0.5 else None,
                    "path": [{"x_m": r * np.cos(b), "y_m": r * np.sin(b)}],
                    "raises": [{"from_s": 0.0, "until_s": 1.0}],
                }
                for row, (look, b, r) in enumerate(zip(looks, bearings, ranges, strict=True))
            ]  # fmt: skip
            wall = {"corners_m": [[5.5, -6], [5.5, 6]], "color": color(rng), "panel": color(rng)}
            scene = scene_from_mapping({"duration_s": 1.0, "people": people, "walls": [wall]})
            state = people_at(scene, 0.5)
            view = Viewpoint.of(scene.camera, map_from_camera(scene, 0.5))
            picture = in_other_light(CameraView(scene, rng).render(view, state), rng)
            in_view = hands_in_view(scene, view, state)
            landmarks = np.zeros((GUESTS, 21, 2))
            for row, person in enumerate(scene.people):
                behind = is_from_behind(view, state, row)
                sheet = raised_hand_landmarks(look_of(person), from_behind=behind)
                ahead, left = view.forward_left(state.xy_m[row])
                places = np.stack([np.full(21, ahead), left - sheet[:, 0]], axis=-1)
                landmarks[row] = view.pixels(places, sheet[:, 1])
                palm = np.linalg.norm(landmarks[row, 9] - landmarks[row, 0])
                landmarks[row] += LANDMARK_STD * palm * rng.standard_normal((21, 2))
            for row, histogram in enumerate(histograms_of(picture, landmarks)):
                if in_view[row] and np.isfinite(histogram).all():
                    seen.setdefault((room, row), []).append(histogram)
    return seen


def histograms_of(bgr: np.ndarray, landmarks_px: np.ndarray) -> np.ndarray:
    one = np.ones(len(landmarks_px))
    return clothes_histograms(bgr, Hands(landmarks_px, one, one, one.astype(bool), one))


def photographed(folder: Path, rng: np.random.Generator) -> Seen:
    """Histograms of the raised hands in photos and in changed copies of them."""
    from tracker.perception import HandFinder

    finder = HandFinder(Config(downscale_factor=1, model_complexity=1))

    def raised(bgr: np.ndarray) -> Hands:
        finder.reset()
        hands = finder.find(CameraImage(0, "", np.ascontiguousarray(bgr)))
        return hands[hands.raised]

    seen: Seen = {}
    for number, path in enumerate(sorted(folder.iterdir())):
        bgr = cv2.imread(str(path))
        hands = raised(bgr)
        for row, histogram in enumerate(clothes_histograms(bgr, hands)):
            if np.isfinite(histogram).all():
                seen.setdefault((number, row), []).append(histogram)
        for _ in range(3):
            scale, shift = rng.uniform(0.5, 1.2), rng.uniform(-20.0, 20.0, 2)
            size = [round(scale * side) for side in bgr.shape[1::-1]]
            matrix = np.array([[scale, 0.0, shift[0]], [0.0, scale, shift[1]]])
            copy = in_other_light(cv2.warpAffine(bgr, matrix, size, flags=cv2.INTER_AREA), rng)
            again = raised(copy)
            if len(again) == 0 or len(hands) == 0:
                continue
            places = hands.wrist_px * scale + shift
            apart = np.linalg.norm(again.wrist_px[:, None] - places, axis=-1)
            for row, histogram in enumerate(clothes_histograms(copy, again)):
                owner = int(apart[row].argmin())
                near = apart[row, owner] < 0.5 * again.length_px[row]
                if near and np.isfinite(histogram).all() and (number, owner) in seen:
                    seen[number, owner].append(histogram)
    return seen


def distances(seen: Seen) -> tuple[np.ndarray, np.ndarray]:
    """Between two looks at the same person, and at different people."""
    same = [hellinger(a, b) for looks in seen.values() for a, b in combinations(looks, 2)]
    other = [
        hellinger(a, b)
        for looks, more in combinations(seen.values(), 2)
        for a in looks
        for b in more
    ]
    return np.array(same), np.array(other)


def alike(one: np.ndarray, other: np.ndarray, rng: np.random.Generator) -> np.ndarray:
    """Both sets as one, the smaller drawn as often as the larger."""
    count = max(len(one), len(other))
    return np.concatenate([np.resize(rng.permutation(part), count) for part in (one, other)])


def log_ratio(same: np.ndarray, other: np.ndarray) -> tuple[float, float]:
    """Intercept and slope of the log-ratio by logistic regression, both kinds weighed alike."""

    def loss(line: np.ndarray) -> float:
        one, two = line[0] - line[1] * same, line[0] - line[1] * other
        return float(np.logaddexp(0.0, -one).mean() + np.logaddexp(0.0, two).mean())

    found = minimize(loss, np.array([3.0, 6.0])).x
    return float(found[0]), float(found[1])


def describe(name: str, same: np.ndarray, other: np.ndarray) -> None:
    """Print both distributions, the line, and what single distances are worth in the data."""
    print(f"{name}: {len(same)} pairs of one person, {len(other)} of two")
    for what, values in (("one person", same), ("two people", other)):
        print(
            f"  distances of {what}:", np.quantile(values, [0.05, 0.25, 0.5, 0.75, 0.95]).round(2)
        )
    at_zero, slope = log_ratio(same, other)
    print(f"  log-ratio {at_zero:.2f} - {slope:.2f} distance, beside that of the shares:")
    for low in np.arange(0.0, 1.0, 0.1):
        one, two = (((v >= low) & (v < low + 0.1)).mean() for v in (same, other))
        shares = f"{np.log(one / two):5.2f}" if one and two else "    -"
        print(f"    {low + 0.05:.2f} {at_zero - slope * (low + 0.05):5.2f} {shares}")
    nearer = (same[:, None] < other).mean()
    print(f"  the same person is the nearer one in {nearer:.3f} of all comparisons")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--rooms", type=int, default=60)
    parser.add_argument("--seed", type=int, default=7)
    parser.add_argument("--photos", type=Path, help="folder with pictures of raised hands")
    words = parser.parse_args()
    rng = np.random.default_rng(words.seed)
    guests = distances(rendered(words.rooms, rng))
    describe("rendered guests", *guests)
    if words.photos is not None:
        photos = distances(photographed(words.photos, rng))
        describe("photos", *photos)
        describe("both alike", *(alike(*kind, rng) for kind in zip(guests, photos, strict=True)))


if __name__ == "__main__":
    main()
