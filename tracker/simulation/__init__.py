"""Scenes of walking people and a moving robot, played as the stream its sensors would give."""

from tracker.simulation.scene import (
    Scene,
    load_scene,
    scene_from_mapping,
    scene_names,
    with_depth_camera,
)
from tracker.simulation.stream import simulate, topic_of, write_simulation

__all__ = [
    "Scene",
    "load_scene",
    "scene_from_mapping",
    "scene_names",
    "simulate",
    "topic_of",
    "with_depth_camera",
    "write_simulation",
]
