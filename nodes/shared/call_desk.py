"""Commands in, answers and the waiting list out; the list can be stored in a file."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from nodes.shared.outputs import Publish, publish_waiting_list
from nodes.shared.topics import Output
from tracker.config import Config
from tracker.containers import FloatArray
from tracker.messages import types
from tracker.messages.types import build, serialize
from tracker.pipeline import Pipeline
from tracker.service import Answer, Command
from tracker.service.kept_calls import KeptCalls


class CallDesk:
    """The node's side of the waiting list; used only by the worker thread.

    Args:
        pipeline: Its tracker keeps the list; a list of the run before is given to it.
        config: `waiting_list_file`.
        publish: Hands a message to the wire.
        warn: Told of a file that cannot be read or written.
    """

    def __init__(
        self, pipeline: Pipeline, config: Config, publish: Publish, warn: Callable[[str], None]
    ) -> None:
        self._pipeline, self._publish = pipeline, publish
        self._robot_xy_m: FloatArray | None = None
        self._file: KeptCalls | None = None
        if config.waiting_list_file:
            self._file = KeptCalls(Path(config.waiting_list_file), warn)
            kept = self._file.read()
            if kept is not None:
                pipeline.restore(kept)

    @property
    def selected_id(self) -> int | None:
        """Number of the selected customer; may be asked from any thread."""
        return self._pipeline.tracker.calls.now.selected_id

    def show(self, robot_xy_m: FloatArray | None = None) -> None:
        """Publish the list, once the robot has been located.

        Args:
            robot_xy_m: Shape (2,): where the camera is now; None where that is unknown.
        """
        if robot_xy_m is not None:
            self._robot_xy_m = robot_xy_m
        if self._robot_xy_m is None:
            return
        calls = self._pipeline.tracker.calls.now
        publish_waiting_list(calls, self._robot_xy_m, self._pipeline.config, self._publish)
        if self._file is not None:
            self._file.keep(calls)

    def obey(self, command: Command) -> Answer:
        """Execute a command, and publish the answer."""
        answer = self._pipeline.tracker.calls.obey(command)
        self.answer(str(command), answer)
        self.show()
        return answer

    def answer(self, command: str, answer: Answer) -> None:
        """Publish the answer to a command."""
        word = "done" if answer.is_done else "refused"
        said = build(types.STRING, data=f"{command}: {word}: {answer.text}")
        self._publish(Output.ANSWERS, serialize(said))
