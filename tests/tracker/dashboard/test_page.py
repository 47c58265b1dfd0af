"""The page in a real browser."""

import re
import shutil
import threading
import time

import cv2
import numpy as np
import pytest

pytest.importorskip("starlette", reason="the extra live is not installed")
pytest.importorskip("uvicorn", reason="the extra live is not installed")
pytest.importorskip("websockets", reason="the extra live is not installed")
pytest.importorskip("playwright", reason="playwright is not installed, which steers the browser")

from playwright import sync_api as playwright

from tracker.dashboard import DashboardServer

CHROMIUM = next(filter(None, map(shutil.which, ("chromium", "chromium-browser", "chrome"))), None)

pytestmark = [pytest.mark.slow, pytest.mark.filterwarnings("ignore::DeprecationWarning")]


@pytest.fixture(scope="module")
def browser():
    with playwright.sync_playwright() as steered:
        try:
            made = steered.chromium.launch(executable_path=CHROMIUM, args=["--no-sandbox"])
        except playwright.Error as error:
            pytest.skip(f"no Chromium can be started here: {str(error).splitlines()[0]}")
        yield made
        made.close()


@pytest.fixture
def url(watched):
    """The page of a pipeline that goes on in a thread, in a room with a map."""
    watched.mount()
    is_over = threading.Event()

    def go_on():
        while not is_over.wait(0.1):
            watched.run(1)

    thread = threading.Thread(target=go_on)
    with DashboardServer(watched.dashboard) as server:
        thread.start()
        time.sleep(0.5)
        yield server.url
        is_over.set()
        thread.join()


@pytest.fixture(params=[(1400, 900, "light"), (390, 844, "dark")], ids=["desktop", "phone"])
def page(browser, url, request):
    width, height, scheme = request.param
    context = browser.new_context(viewport={"width": width, "height": height}, color_scheme=scheme)
    made = context.new_page()
    made.complaints, made.fetched = [], []
    made.on("response", lambda answer: made.fetched.append((answer.url, answer.status)))
    made.on("console", lambda said: made.complaints.append(said.text))
    made.on("pageerror", lambda error: made.complaints.append(str(error)))
    made.goto(url)
    made.wait_for_selector("#callers li", timeout=30_000)
    yield made
    assert made.complaints == []
    context.close()


def test_the_page_shows_who_waits_and_nothing_overflows(page):
    assert "called" in page.inner_text("#callers li")
    assert page.inner_text("#raised") == "hand up: #1"
    # The page's policy forbids what playwright's own waiting for a function does.
    for _ in range(100):
        if page.evaluate("document.querySelector('#picture').naturalWidth") == 640:
            break
        time.sleep(0.05)
    else:
        pytest.fail("no picture was shown")
    assert page.evaluate("document.documentElement.scrollWidth <= window.innerWidth")
    assert page.locator("#timeline rect").count() >= 2


def test_the_map_is_fetched_once_and_drawn(page):
    card = page.evaluate("getComputedStyle(document.querySelector('section')).backgroundColor")
    card_bgr = np.array([int(part) for part in re.findall(r"\d+", card)[:3]][::-1])
    wall_bgr = 0.55 * np.array([140, 130, 122]) + 0.45 * card_bgr
    for _ in range(100):
        png = np.frombuffer(page.locator("#map").screenshot(), np.uint8)
        picture = cv2.imdecode(png, cv2.IMREAD_COLOR)
        shown = np.abs(picture - wall_bgr).max(axis=-1) < 3.0
        if shown.sum() > 20:
            break
        time.sleep(0.1)
    else:
        pytest.fail("no wall of the map was drawn")
    assert [status for url, status in page.fetched if "/map.png" in url] == [200]


def test_a_customer_is_served_by_the_keyboard_alone(page):
    page.locator("button", has_text="serve").first.focus()
    page.keyboard.press("Enter")
    page.wait_for_selector("#callers li[data-state=being_served]")
    assert "customer 1 is being served" in page.inner_text("#said")
    page.keyboard.press("Tab")
    page.locator("button", has_text="served").focus()
    page.keyboard.press("Enter")
    page.wait_for_selector("#callers li[data-state=served]")


def test_a_parameter_is_found_and_changed(page, watched):
    page.fill("#search", "images per second")
    slider = page.locator("#p-processing_rate")
    slider.focus()
    page.keyboard.press("ArrowRight")
    playwright.expect(page.locator("#said")).to_contain_text("processing_rate is", timeout=30_000)
    assert watched.pipeline.config.processing_rate > 10.0


def test_words_have_contrast_in_light_and_dark(page):
    ratio = page.evaluate("""() => {
      const light = (text) => {
        const [r, g, b] = text.match(/[\\d.]+/g).slice(0, 3).map((one) => {
          const part = one / 255;
          return part <= .04045 ? part / 12.92 : ((part + .055) / 1.055) ** 2.4;
        });
        return .2126 * r + .7152 * g + .0722 * b;
      };
      const back = light(getComputedStyle(document.querySelector("section")).backgroundColor);
      return Math.min(...[...document.querySelectorAll("h2, small, p, li, .what, #raised")]
        .filter((one) => one.offsetParent)
        .map((one) => light(getComputedStyle(one).color))
        .map((one) => (Math.max(one, back) + .05) / (Math.min(one, back) + .05)));
    }""")
    assert ratio >= 4.5  # WCAG 2.2, AA
