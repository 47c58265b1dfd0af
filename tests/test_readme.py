import contextlib
import io
import re
from pathlib import Path

import pytest

README = Path(__file__).parents[1] / "README.md"


def test_the_python_of_the_readme_runs_and_tracks_both_people():
    (code,) = re.findall(r"```python\n(.*?)```", README.read_text(encoding="utf-8"), re.DOTALL)
    printed = io.StringIO()
    with contextlib.redirect_stdout(printed):
        exec(compile(code, str(README), "exec"), {})
    assert printed.getvalue().startswith("[1 2] [ True  True] 1")


PAGES = [README, *sorted((README.parent / "docs").glob("*.md"))]


def anchors(page):
    """The part of an address behind `#`, of every heading of a page."""
    headings = re.findall(r"^#+ (.*)$", page.read_text(encoding="utf-8"), re.MULTILINE)
    return {re.sub(r"[^\w -]", "", each.lower()).replace(" ", "-") for each in headings}


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_every_link_of_a_page_leads_to_a_file_and_a_heading_that_are_there(page):
    links = re.findall(r"\]\(([^)]+?)\)", page.read_text(encoding="utf-8"))
    for link in links:
        if "://" not in link:
            name, _, anchor = link.partition("#")
            there = page.parent / name if name else page
            assert there.exists(), link
            assert not anchor or anchor in anchors(there), link


def test_the_readme_is_read_in_a_few_minutes_and_links_to_the_documentation():
    text = README.read_text(encoding="utf-8")
    assert len(text.splitlines()) <= 150
    assert text.count("](docs/") >= 10


def test_no_page_speaks_of_an_address_that_nobody_has():
    files = [*PAGES, README.parent / "CHANGELOG.md", README.parent / "CONTRIBUTING.md"]
    assert not [path.name for path in files if "ADDRESS-OF" in path.read_text(encoding="utf-8")]
