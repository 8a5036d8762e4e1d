"""The library that writes USD; it is an extra."""

from warp_kernels.errors import OptionError


def require_usd(ending: str) -> None:
    """Refuse where the library is missing.

    Args:
        ending: Ending of the output.

    Raises:
        OptionError: If it is not installed.
    """
    try:
        import pxr  # noqa: F401
    except ImportError as error:
        raise OptionError(
            f"{ending}: needs the package usd-core; pip install 'trimotion[usd]', or use .glb"
        ) from error
