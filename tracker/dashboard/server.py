"""Serves the page and its WebSocket, in a thread of its own.

A browser asks for the next frame when it has drawn the last one, so that a slow one, or one that
has stopped, misses frames and holds up nobody.
"""

from __future__ import annotations

import asyncio
import hmac
import json
import secrets
import socket
import threading
from pathlib import Path
from typing import Any
from urllib.parse import urlsplit

from tracker.closing import Closing
from tracker.dashboard.dashboard import Dashboard
from tracker.errors import ConfigError, OutputError

_PAGE = Path(__file__).parent / "page"
_FILES = {"/": "index.html", "/app.js": "app.js", "/room.js": "room.js", "/style.css": "style.css"}
_KINDS = {".html": "text/html", ".js": "text/javascript", ".css": "text/css"}
_LOOPBACK = {"127.0.0.1", "localhost", "::1"}

#: Nothing but the page's own files and socket; pictures come as blobs.
_POLICY = (
    "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' blob: data:; "
    "connect-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'"
)
_HEADERS = {
    "Content-Security-Policy": _POLICY,
    "X-Content-Type-Options": "nosniff",
    "Referrer-Policy": "no-referrer",
    "Cache-Control": "no-store",
}
#: How often the newest frame is looked for; a request of the page is short.
_POLL_S, _REQUEST_BYTES = 0.02, 4096


class DashboardServer(Closing):
    """Serves a dashboard until it is closed; a context manager.

    Args:
        dashboard: What is shown.
        host: Where to listen; anything but the loopback interface asks for a token.
        port: Which port; 0 takes any that is free.

    Attributes:
        url: Where the page is, with its token.

    Raises:
        ConfigError: The extra `live` is not installed.
        OutputError: The port is taken, or the host is none of this machine.
    """

    def __init__(self, dashboard: Dashboard, host: str = "127.0.0.1", port: int = 0) -> None:
        try:
            import starlette  # noqa: F401
            import uvicorn
            import websockets  # noqa: F401  # uvicorn would answer no WebSocket without
        except ImportError as error:
            raise ConfigError(
                f"The page needs the extra `live` ({error.name} is not installed): run 'pip "
                "install -e \".[live]\"' in the project's folder"
            ) from error
        self._dashboard = dashboard
        self._token = "" if host in _LOOPBACK else secrets.token_urlsafe(16)
        self._socket = _listen(host, port)
        port = self._socket.getsockname()[1]
        shown = f"[{host}]" if ":" in host else host
        query = f"/?token={self._token}" if self._token else "/"
        self.url = f"http://{shown}:{port}{query}"
        config = uvicorn.Config(
            self._app(), log_level="warning", lifespan="off", ws_max_size=_REQUEST_BYTES,
            timeout_graceful_shutdown=1, ws_ping_interval=20.0, ws_ping_timeout=20.0,
        )  # fmt: skip
        self._server = uvicorn.Server(config)
        self._thread = threading.Thread(
            target=self._server.run, kwargs={"sockets": [self._socket]}, name="page", daemon=True
        )
        self._thread.start()

    def close(self) -> None:
        """Stop serving."""
        self._server.should_exit = True
        self._thread.join(5.0)
        self._socket.close()

    def _app(self) -> Any:
        from starlette.applications import Starlette
        from starlette.routing import Route, WebSocketRoute

        routes = [Route(path, self._file) for path in _FILES]
        routes.append(Route("/map.png", self._map))
        return Starlette(routes=[*routes, WebSocketRoute("/frames", self._frames)])

    async def _file(self, request: Any) -> Any:
        from starlette.responses import Response

        if not self._is_allowed(request, needs_token=request.url.path == "/"):
            return Response("This page needs the token of its address.", 403, headers=_HEADERS)
        path = _PAGE / _FILES[request.url.path]
        kind = _KINDS[path.suffix]
        return Response(path.read_bytes(), media_type=kind, headers=_HEADERS)

    async def _map(self, request: Any) -> Any:
        from starlette.responses import Response

        if not self._is_allowed(request, needs_token=True):
            return Response("The map needs the token of the page.", 403, headers=_HEADERS)
        png = await asyncio.to_thread(self._dashboard.map_png)
        if png is None:
            return Response("There is no map yet.", 404, headers=_HEADERS)
        return Response(png, media_type="image/png", headers=_HEADERS)

    async def _frames(self, websocket: Any) -> None:
        from starlette.websockets import WebSocketDisconnect

        origin = urlsplit(websocket.headers.get("origin", "")).netloc
        is_same = origin == websocket.headers.get("host", "")
        if not (is_same and self._is_allowed(websocket, needs_token=True)):
            await websocket.close(1008)
            return
        await websocket.accept()
        ready = asyncio.Event()
        sending = asyncio.create_task(self._send(websocket, ready))
        try:
            while True:
                request = json.loads(await websocket.receive_text())
                if request == "next":
                    ready.set()
                elif isinstance(request, dict):
                    self._dashboard.ask(request)
        except (WebSocketDisconnect, ValueError, KeyError, RuntimeError):
            pass
        finally:
            sending.cancel()

    async def _send(self, websocket: Any, ready: asyncio.Event) -> None:
        """One frame for each time that the browser is ready, and never an old one."""
        dashboard = self._dashboard
        hello = {
            "title": dashboard.title,
            "can_steer": dashboard.steering is not None,
            "parameters": dashboard.parameters(),
        }
        await websocket.send_text(json.dumps(hello))
        sent = 0
        while True:
            await ready.wait()
            while dashboard.number == sent:
                await asyncio.sleep(_POLL_S)
            shown = await asyncio.to_thread(dashboard.show)
            if shown is None:
                continue
            sent = shown.number
            ready.clear()
            await websocket.send_text(json.dumps(shown.state))
            await websocket.send_bytes(shown.jpeg)

    def _is_allowed(self, request: Any, *, needs_token: bool) -> bool:
        """Refuse pages of other sites and, except on this computer, requests without the token."""
        if self._token:
            given = request.query_params.get("token", "")
            return not needs_token or hmac.compare_digest(given.encode(), self._token.encode())
        host = urlsplit(f"//{request.headers.get('host', '')}").hostname
        return host in _LOOPBACK


def _listen(host: str, port: int) -> socket.socket:
    family = socket.AF_INET6 if ":" in host else socket.AF_INET
    listening = socket.socket(family, socket.SOCK_STREAM)
    try:
        listening.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        listening.bind((host, port))
    except (OSError, OverflowError) as error:
        listening.close()
        raise OutputError(
            f"The dashboard cannot listen on {host}, port {port} ({error}). Take another port."
        ) from error
    return listening
