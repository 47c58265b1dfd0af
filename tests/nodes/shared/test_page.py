"""The page of a node: what its buttons and sliders do is what topics and parameters do."""

import json
import socket
import time
import urllib.request
from urllib.error import HTTPError, URLError

import pytest

pytest.importorskip("starlette", reason="the extra live is not installed")
pytest.importorskip("uvicorn", reason="the extra live is not installed")
pytest.importorskip("websockets", reason="the extra live is not installed")

from websockets.sync.client import connect

from nodes.shared.topics import Output
from tracker import Config
from tracker.errors import OutputError

# uvicorn's own way to WebSockets warns of itself.
pytestmark = pytest.mark.filterwarnings("ignore::DeprecationWarning")

START_NS = 1_000_000_000_000
PERIOD_NS = 100_000_000


@pytest.fixture
def port():
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        return free.getsockname()[1]


@pytest.fixture
def served(make_wire, port):
    wire = make_wire(Config(dashboard_port=port))
    wire.mounting()
    wait_for(f"http://127.0.0.1:{port}/")
    return wire


def wait_for(url):
    for _ in range(200):
        try:
            return urllib.request.urlopen(url, timeout=5)
        except HTTPError:
            raise
        except URLError:
            time.sleep(0.05)
    raise AssertionError("no page came")


def show(wire, numbers):
    for number in numbers:
        stamp_ns = START_NS + number * PERIOD_NS
        wire.base(stamp_ns - 1_000_000)
        wire.base(stamp_ns + 1_000_000)
        wire.scan(stamp_ns)
        wire.image(stamp_ns)
        wire.settle()


def frame(browser):
    browser.send(json.dumps("next"))
    return json.loads(browser.recv(10)), browser.recv(10)


def browser_of(port):
    return connect(f"ws://127.0.0.1:{port}/frames", origin=f"http://127.0.0.1:{port}")


def test_a_button_is_a_command_that_is_answered_on_the_topic(served, port):
    show(served, range(8))
    with browser_of(port) as browser:
        assert json.loads(browser.recv(10))["title"] == "hand_detector"
        state, jpeg = frame(browser)
        assert state["callers"][0]["state"] == "waiting"
        assert jpeg[:2] == b"\xff\xd8"
        browser.send(json.dumps({"do": "serve 1"}))
        served.until(lambda: served.diagnose() and served.messages(Output.ANSWERS))
    (answer,) = served.messages(Output.ANSWERS)
    assert answer.data == "serve 1: done: customer 1 is being served"
    (anna,) = served.messages(Output.WAITING_LIST)[-1].detections
    assert anna.results[0].hypothesis.class_id == "being_served"


def test_a_slider_is_a_parameter_and_a_parameter_moves_the_slider(served, port):
    show(served, range(3))
    with browser_of(port) as browser:
        browser.recv(10)
        browser.send(json.dumps({"set": ["processing_rate", 5.0]}))
        served.until(lambda: served.diagnose() and served.core.config.processing_rate == 5.0)
    served.core.configure(served.core.config.replace(processing_rate=7.0))
    with browser_of(port) as browser:
        parameters = {item["name"]: item for item in json.loads(browser.recv(10))["parameters"]}
    assert parameters["processing_rate"]["value"] == 7.0


def test_the_log_names_the_page_and_with_the_node_it_goes(served, port):
    url = f"http://127.0.0.1:{port}/"
    assert ("info", f"The page: {url}") in served.logged
    served.core.stop()
    with pytest.raises(URLError):
        urllib.request.urlopen(url, timeout=5)


def test_without_a_port_nothing_is_served(make_wire):
    assert not any("The page" in text for _, text in make_wire().logged)


def test_a_node_whose_port_is_taken_does_not_start(served, make_wire, port):
    with pytest.raises(OutputError, match="Take another port"):
        make_wire(Config(dashboard_port=port))
