"""The same node as a lifecycle node: configure loads the models, activate subscribes."""

from __future__ import annotations

import sys
from typing import Any

from rclpy.lifecycle import LifecycleNode, LifecycleState, TransitionCallbackReturn

from nodes.hand_detector import FROM_OVERRIDES, run
from nodes.ros.memory import give_back
from nodes.ros.parameters import RosParameters
from nodes.ros.wiring import RosWiring
from tracker.config import NODE_NAME
from tracker.errors import TrackerError


class LifecycleHandDetector(LifecycleNode):
    """`HandDetector` for lifecycle managers such as Nav2's.

    rclpy manages publishers only, so subscriptions are made on activation and taken down on
    deactivation; a raised hand is taken back then.

    Args:
        node_name: Its name, unless a remapping gives another one.
        options: As of every rclpy lifecycle node.

    Raises:
        ConfigError: A parameter is unknown or out of range.
    """

    def __init__(self, node_name: str = NODE_NAME, **options: Any) -> None:
        super().__init__(node_name, **options | FROM_OVERRIDES)
        self._wiring: RosWiring | None = None
        try:
            self._declared = RosParameters(self, is_managed=True)
        except TrackerError:
            super().destroy_node()
            raise

    @property
    def is_alive(self) -> bool:
        """Whether the node still works; False after an error in the worker."""
        return self._wiring is None or self._wiring.core.is_alive

    def close(self) -> None:
        """Stop working, in whatever state."""
        # Taken away first: a core that is stopped on purpose is no dead one.
        wiring, self._wiring = self._wiring, None
        if wiring is not None:
            wiring.close()
            del wiring
            give_back()

    def destroy_node(self) -> None:
        """Close, and take the node down."""
        self.close()
        super().destroy_node()

    def on_configure(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Load the models."""
        try:
            self._wiring = RosWiring(self, self._declared)
        except TrackerError as error:
            self.get_logger().error(str(error))
            return TransitionCallbackReturn.FAILURE
        self._wiring.core.enable(False)
        return TransitionCallbackReturn.SUCCESS

    def on_activate(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Listen, and process images."""
        assert self._wiring is not None, "configured before"
        self._wiring.listen()
        self._wiring.core.enable(True)
        return super().on_activate(state)

    def on_deactivate(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Rest; the models stay loaded."""
        assert self._wiring is not None, "configured before"
        self._wiring.stop_listening()
        self._wiring.core.enable(False)
        return super().on_deactivate(state)

    def on_cleanup(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Let the models go."""
        self.close()
        return TransitionCallbackReturn.SUCCESS

    def on_shutdown(self, state: LifecycleState) -> TransitionCallbackReturn:
        """End, from any state."""
        self.close()
        return TransitionCallbackReturn.SUCCESS

    def on_error(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Go back to the beginning."""
        self.close()
        return TransitionCallbackReturn.SUCCESS


def main(args: list[str] | None = None) -> int:
    """Run the lifecycle node until Ctrl-C; returns as `nodes.hand_detector.main`."""
    return run(LifecycleHandDetector, args)


if __name__ == "__main__":
    sys.exit(main())
