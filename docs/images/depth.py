"""Draws docs/images/depth.png: a camera picture, the depth image, and what that shows from above.

Run: python docs/images/depth.py
"""

from pathlib import Path

import cv2
import numpy as np

from tracker import Config
from tracker.camera import CameraModel
from tracker.containers import CameraImage, DepthImage, depth_in_meters
from tracker.ranging.depth import depth_points, find_bodies
from tracker.simulation import load_scene, simulate, with_depth_camera
from tracker.simulation.stream import map_from_camera

AT_S, SIZE_PX, PX_PER_M = 13.5, 480, 130.0


def main():
    """Draw it."""
    scene = with_depth_camera(load_scene("restaurant")).model_copy(update={"duration_s": AT_S})
    camera = scene.camera
    model = CameraModel(camera.fx, camera.fy, camera.cx, camera.cy, width=640, height=480)
    for _, event in simulate(scene, 1):
        if isinstance(event, CameraImage):
            color = event
        elif isinstance(event, DepthImage):
            depth = event
    since_s = depth.stamp_ns / 1e9 - scene.start_s
    points = depth_points(depth, model, map_from_camera(scene, since_s))
    bodies = find_bodies(points, Config())
    depth_m = depth_in_meters(depth.read())
    gray = np.clip(255 - 45 * np.nan_to_num(depth_m, nan=9.0), 0, 255).astype(np.uint8)
    shown = cv2.applyColorMap(gray, cv2.COLORMAP_VIRIDIS)
    shown[np.isnan(depth_m)] = 0
    above = np.full((SIZE_PX, SIZE_PX, 3), 255, np.uint8)

    def pixel(xy_m):
        return int(SIZE_PX / 2 - PX_PER_M * xy_m[1]), int(SIZE_PX - 20 - PX_PER_M * xy_m[0])

    for xy_m in bodies.slice.xy_m[bodies.slice.valid]:
        cv2.circle(above, pixel(xy_m), 2, (120, 90, 60), -1, cv2.LINE_AA)
    for xy_m in bodies.people.xy_m:
        cv2.circle(above, pixel(xy_m), 22, (40, 120, 230), 2, cv2.LINE_AA)
    cv2.circle(above, pixel(bodies.pose[:2]), 7, (0, 0, 0), -1, cv2.LINE_AA)
    picture = np.hstack([color.bgr, shown, above])
    small = cv2.resize(picture, None, fx=0.6, fy=0.6, interpolation=cv2.INTER_AREA)
    cv2.imwrite(str(Path(__file__).with_suffix(".png")), small)


if __name__ == "__main__":
    main()
