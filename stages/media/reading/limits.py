"""How much of a file is believed: one that asks for more is a mistake or an attack."""

from dataclasses import dataclass, fields

from warp_kernels.errors import OptionError


@dataclass(frozen=True)
class Limits:
    """The most that a source may have."""

    pixels: int = 100_000_000
    """Of a picture; the triangles of one of more than 8,192 on a side cannot be found anyway."""
    frames: int = 1_000_000
    """Of what is converted: eleven hours at 25 frames per second."""
    streams: int = 1000
    """In a file; photos may have hundreds, one for each of their tiles."""

    @classmethod
    def parse(cls, text: str | None) -> "Limits":
        """Read `pixels=N,frames=N,streams=N`, or some of these.

        Args:
            text: What the user wrote; None for nothing.

        Raises:
            OptionError: If it is something else, or beyond what can be.
        """
        given: dict[str, int] = {}
        for part in [] if text is None else text.split(","):
            name, _, value = part.strip().partition("=")
            if name not in HIGHEST or name in given or not (value.isascii() and value.isdecimal()):
                form = ",".join(f"{field.name}=N" for field in fields(cls))
                raise OptionError(f"--limits {text}: write {form}, or some of these")
            given[name] = int(value[:20])
            if not 1 <= given[name] <= HIGHEST[name]:
                raise OptionError(
                    f"--limits {name}={value}: must lie between 1 and {HIGHEST[name]}"
                )
        return cls(**given)


HIGHEST = {"pixels": 1 << 28, "frames": 1 << 40, "streams": 100_000}
"""What limits may be raised to; FFmpeg opens no larger picture."""
