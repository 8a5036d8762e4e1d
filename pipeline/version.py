"""Which version of the program this is."""

from functools import cache
from importlib import metadata

LIBRARIES = ("warp-lang", "numpy", "scipy", "opencv-contrib-python-headless", "av")
"""Libraries on which the bits of a result depend."""


@cache
def program_version() -> str:
    """The installed version; finding it takes a while."""
    try:
        return metadata.version("trimotion")
    except metadata.PackageNotFoundError:
        return "(not installed)"


@cache
def library_versions() -> dict[str, str]:
    """Versions of the libraries that are installed under their usual names."""
    versions = {}
    for name in LIBRARIES:
        try:
            versions[name] = metadata.version(name)
        except metadata.PackageNotFoundError:
            continue
    return versions
