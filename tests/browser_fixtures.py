"""A browser and the editor's page on a still, for every test that asks for them by name."""

from collections.abc import Iterator

import pytest
from playwright.sync_api import Browser, Page

from tests.browsing import launched, opened_page
from tests.editing import Served, served, write_job


@pytest.fixture(scope="module")
def browser() -> Iterator[Browser]:
    """A browser without a window."""
    with launched() as found:
        yield found


@pytest.fixture(scope="module")
def server(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Served]:
    """A server with a still."""
    with served(write_job(tmp_path_factory.mktemp("job"))) as found:
        yield found


@pytest.fixture
def page(browser: Browser, server: Served) -> Iterator[Page]:
    """The page, open, with all edits of earlier tests undone; what it complains of fails."""
    with opened_page(browser, server) as found:
        yield found
