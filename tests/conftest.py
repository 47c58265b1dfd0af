"""What tests in several folders share."""

import os
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, contextmanager
from pathlib import Path

import pytest
from hypothesis import settings

from tracker.errors import ModelFileError
from tracker.perception.models import ModelStore, ensure_models

# Seeded, and without a deadline that a busy machine would miss.
settings.register_profile("tests", deadline=None, derandomize=True)
settings.load_profile("tests")


@pytest.fixture(scope="session")
def skip_when_offline() -> Callable[[], AbstractContextManager[None]]:
    """Around a download: without a network the test is skipped, but never in CI."""

    @contextmanager
    def guard() -> Iterator[None]:
        try:
            yield
        except ModelFileError as error:
            if "no connection" not in str(error) or os.environ.get("CI"):
                raise
            pytest.skip(str(error))

    return guard


@pytest.fixture(scope="session")
def model_store(skip_when_offline: Callable[[], AbstractContextManager[None]]) -> ModelStore:
    """The user's model files; the first run fetches them."""
    store = ModelStore()
    with skip_when_offline():
        ensure_models(store)
    return store


@pytest.fixture(scope="session")
def section_12() -> Path:
    """The example of the specification's section 12, as a parameter file."""
    return Path(__file__).with_name("specification_section_12.yaml")
