"""Which version of the program this is."""

from importlib import metadata


def program_version() -> str:
    """The installed version; finding it takes a while."""
    try:
        return metadata.version("trimotion")
    except metadata.PackageNotFoundError:
        return "(not installed)"
