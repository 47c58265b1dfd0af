"""The node's page in a browser, where `dashboard_port` asks for one."""

from __future__ import annotations

from collections.abc import Callable

from nodes.shared.call_desk import CallDesk
from tracker.config import Config
from tracker.containers import CameraImage, FrameResult
from tracker.dashboard import Dashboard, DashboardServer
from tracker.service import Answer, Command


class NodePage:
    """Serves the page; its buttons and sliders do what topics and parameters do.

    Args:
        config: `dashboard_host` and `dashboard_port`.
        title: The node's name.
        calls: Follows commands; used by the worker alone.
        configure: Changes parameters.

    Attributes:
        url: Where the page is.

    Raises:
        ConfigError: The extra `live` is not installed.
        OutputError: The port is taken.
    """

    def __init__(
        self, config: Config, title: str, calls: CallDesk, configure: Callable[[Config], None]
    ) -> None:
        self._calls, self._configure = calls, configure
        self._dashboard = Dashboard(config, title, self)
        self._server = DashboardServer(
            self._dashboard, config.dashboard_host, config.dashboard_port
        )
        self.url = self._server.url

    def watch(self, image: CameraImage, result: FrameResult, busy_s: float) -> None:
        """Take in one frame."""
        self._dashboard.watch(image, result, busy_s)

    def follow(self, config: Config) -> None:
        """Take over parameters that were changed elsewhere."""
        self._dashboard.follow(config)

    def follow_orders(self) -> None:
        """Do what the page has asked for."""
        self._dashboard.follow_orders()

    def obey(self, command: Command) -> Answer:
        """Execute a command about the waiting list."""
        return self._calls.obey(command)

    def configure(self, config: Config) -> None:
        """Change parameters while running."""
        self._configure(config)

    def close(self) -> None:
        """Stop serving."""
        self._server.close()
