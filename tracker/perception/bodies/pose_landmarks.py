"""Where are the joints of each person, and is it a person at all? MediaPipe's pose landmarks."""

from __future__ import annotations

import cv2
import numpy as np
import onnxruntime

from tracker.containers import ImageArray
from tracker.perception.bodies.bodies import Bodies
from tracker.perception.pictures import cut_out
from tracker.perception.regions import Regions, image_from_input
from tracker.perception.single_shot import probability

INPUT_PX = 256
#: BlazePose's rows of the joints, in the order of `Joint`.
_JOINT_ROWS = [0, 2, 5, 7, 8, 11, 12, 13, 14, 15, 16, 23, 24, 25, 26, 27, 28]
#: Its rows that say where to look next: the middle of the hips and the circle around the person.
_ALIGNMENT_ROWS = [33, 34]


class PoseReader:
    """The pose landmark model on one person after the other."""

    def __init__(self, session: onnxruntime.InferenceSession) -> None:
        self._session = session

    def read(self, bgr: ImageArray, regions: Regions) -> Bodies:
        """The people in each region of a picture of shape (height, width, 3).

        What lies outside of the picture repeats its edge.
        """
        to_image = image_from_input(regions, INPUT_PX)
        landmarks = np.zeros((len(regions), 39, 5))
        score = np.zeros(len(regions))
        for row, matrix in enumerate(to_image):
            crop = cut_out(bgr, matrix, INPUT_PX, cv2.BORDER_REPLICATE)
            points, presence = self._session.run(["landmarks", "presence"], {"image": crop})
            landmarks[row], score[row] = points.reshape(39, 5), presence[0, 0]
        points_px = landmarks[..., :2] @ to_image[:, :, :2].transpose(0, 2, 1)
        points_px += to_image[:, None, :, 2]
        # Both: hidden behind something, or outside of the picture.
        visible = probability(landmarks[..., 3]) * probability(landmarks[..., 4])
        return Bodies(
            points_px[:, _JOINT_ROWS],
            visible[:, _JOINT_ROWS],
            score,
            np.zeros(len(regions)),
            points_px[:, _ALIGNMENT_ROWS],
        )
