"""Buttons and sliders of the page, followed by the pipeline itself."""

from __future__ import annotations

from tracker.config import Config
from tracker.pipeline import Pipeline
from tracker.service import Answer, Command


class PipelineSteering:
    """Follows commands between two frames; see `dashboard.Steering`."""

    def __init__(self, pipeline: Pipeline) -> None:
        self._pipeline = pipeline

    def obey(self, command: Command) -> Answer:
        """Follow a command about the waiting list."""
        return self._pipeline.tracker.calls.obey(command)

    def configure(self, config: Config) -> None:
        """Change parameters while running."""
        self._pipeline.configure(config)
