"""Recordings of robots, videos and photos as one stream of sensor data; outputs as recordings."""

from tracker.recording.map_file import load_map
from tracker.recording.opening import open_recording
from tracker.recording.recording import Recording, Skipped, Summary
from tracker.recording.topics import Topics
from tracker.recording.writer import RecordingWriter, recording_files

__all__ = [
    "Recording",
    "RecordingWriter",
    "Skipped",
    "Summary",
    "Topics",
    "load_map",
    "open_recording",
    "recording_files",
]
