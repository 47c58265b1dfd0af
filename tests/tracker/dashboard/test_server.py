"""The server as browsers, other sites and strangers meet it."""

import json
import threading
import time
import urllib.request
from urllib.error import HTTPError
from urllib.parse import urlsplit

import pytest

pytest.importorskip("starlette", reason="the extra live is not installed")
pytest.importorskip("uvicorn", reason="the extra live is not installed")
pytest.importorskip("websockets", reason="the extra live is not installed")

from websockets.exceptions import ConnectionClosed, InvalidStatus
from websockets.sync.client import connect

from tracker.dashboard import DashboardServer
from tracker.errors import OutputError

# uvicorn's own way to WebSockets warns of itself.
pytestmark = pytest.mark.filterwarnings("ignore::DeprecationWarning")


@pytest.fixture
def server(watched):
    with DashboardServer(watched.dashboard) as made:
        wait_for(made.url)
        yield made


def wait_for(url):
    for _ in range(100):
        try:
            return urllib.request.urlopen(url, timeout=5)
        except HTTPError:
            raise
        except OSError:
            time.sleep(0.05)
    raise AssertionError("the server did not start")


def socket_of(url, **options):
    parts = urlsplit(url)
    query = f"?{parts.query}" if parts.query else ""
    origin = options.pop("origin", f"http://{parts.netloc}")
    return connect(f"ws://{parts.netloc}/frames{query}", origin=origin, **options)


def frame(socket):
    socket.send(json.dumps("next"))
    return json.loads(socket.recv(10)), socket.recv(10)


def test_the_page_has_a_policy_and_loads_nothing_from_elsewhere(server):
    answer = urllib.request.urlopen(server.url)
    policy = answer.headers["Content-Security-Policy"]
    assert "default-src 'none'" in policy
    assert "unsafe" not in policy
    page = answer.read().decode()
    assert "//" not in page.replace("<!doctype", "")
    for name in ("app.js", "room.js", "style.css"):
        assert urllib.request.urlopen(server.url + name).status == 200


def test_a_browser_gets_a_frame_whenever_it_asks(server, watched):
    watched.run(10)
    with socket_of(server.url) as socket:
        hello = json.loads(socket.recv(10))
        assert hello["title"] == "test <camera>"
        state, jpeg = frame(socket)
        assert state["callers"][0]["id"] == 1
        assert jpeg[:2] == b"\xff\xd8"
        socket.send(json.dumps({"do": "serve 1"}))
        time.sleep(0.3)
        watched.run(2)  # it is followed between two frames
        assert frame(socket)[0]["callers"][0]["state"] == "being_served"


def test_a_browser_that_does_not_ask_gets_nothing_and_holds_nobody_up(server, watched):
    watched.run(2)
    with socket_of(server.url) as stopped, socket_of(server.url) as quick:
        stopped.recv(10), quick.recv(10)
        frame(stopped)
        began = time.perf_counter()
        for _ in range(20):
            watched.run(1)
            frame(quick)
        assert time.perf_counter() - began < 20.0
        with pytest.raises(TimeoutError):
            stopped.recv(0.2)
        state, _ = frame(stopped)
        assert state["frame"] == watched.dashboard.number


def test_the_map_is_there_once_one_has_come(server, watched):
    with pytest.raises(HTTPError, match="404"):
        urllib.request.urlopen(f"{server.url}map.png")
    watched.mount()
    watched.run(1)
    answer = urllib.request.urlopen(f"{server.url}map.png?number=1")
    assert (answer.headers["Content-Type"], answer.read(4)) == ("image/png", b"\x89PNG")


def test_another_site_cannot_open_the_socket(server):
    with pytest.raises((InvalidStatus, ConnectionClosed)):
        with socket_of(server.url, origin="http://evil.example") as socket:
            socket.recv(5)


def test_a_name_that_was_bound_to_the_loopback_by_others_gets_nothing(server):
    request = urllib.request.Request(server.url, headers={"Host": "evil.example"})
    with pytest.raises(HTTPError, match="403"):
        urllib.request.urlopen(request)


def test_beyond_the_loopback_a_token_is_needed(watched):
    with DashboardServer(watched.dashboard, "0.0.0.0") as server:
        url = server.url.replace("0.0.0.0", "127.0.0.1")
        assert wait_for(url).status == 200
        with pytest.raises(HTTPError, match="403"):
            urllib.request.urlopen(url.partition("?")[0])
        with pytest.raises(HTTPError, match="403"):
            urllib.request.urlopen(url.partition("?")[0] + "map.png")
        with pytest.raises((InvalidStatus, ConnectionClosed)):
            with socket_of(url.partition("?")[0]) as socket:
                socket.recv(5)
        with socket_of(url) as socket:
            assert json.loads(socket.recv(10))["can_steer"]


def test_requests_of_no_sense_end_the_connection_and_nothing_else(server, watched):
    watched.run(2)
    for text in ("{", "[" * 100, '{"do": 1}', "x" * 10_000):
        with socket_of(server.url) as socket:
            socket.recv(10)
            socket.send(text)
    with socket_of(server.url) as socket:
        socket.recv(10)
        assert frame(socket)[0]["frame"] == 2


def test_a_port_that_is_taken_is_said(server, watched):
    with pytest.raises(OutputError, match="Take another port"):
        DashboardServer(watched.dashboard, port=urlsplit(server.url).port)


def test_closing_ends_the_thread(watched):
    server = DashboardServer(watched.dashboard)
    wait_for(server.url)
    server.close()
    assert not [one for one in threading.enumerate() if one.name == "page"]
