"""The files of the page, all read when the program starts: no request ever names a file."""

from pathlib import Path

from starlette.exceptions import HTTPException
from starlette.requests import Request
from starlette.responses import Response

FOLDER = Path(__file__).parents[1] / "page"
"""Where the page lies."""
KINDS = {
    ".html": "text/html; charset=utf-8",
    ".css": "text/css; charset=utf-8",
    ".js": "text/javascript; charset=utf-8",
    ".svg": "image/svg+xml",
}
"""What is served, by ending."""


class PageFiles:
    """Answers requests for files of the page.

    Args:
        folder: Where they lie.
    """

    def __init__(self, folder: Path = FOLDER) -> None:
        self._files = {
            f"/{path.relative_to(folder).as_posix()}": (path.read_bytes(), KINDS[path.suffix])
            for path in sorted(folder.rglob("*"))
            if path.suffix in KINDS
        }
        self._files["/"] = self._files["/index.html"]

    async def answer(self, request: Request) -> Response:
        """Give a file.

        Raises:
            HTTPException: If there is none of that name.
        """
        found = self._files.get(request.url.path)
        if found is None:
            raise HTTPException(404, "the page has no such file")
        return Response(found[0], media_type=found[1])
