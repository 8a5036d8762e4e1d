"""Options from a TOML file: `triangles = 3000`, `style = ["flat", "edges:width=1"]`."""

import difflib
import re
import tomllib
from collections.abc import Collection, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path

from pipeline.options.command_line import COMMAND_OPTIONS, job_options
from pipeline.options.nearest import nearest
from stages.media.text_file import read_text, reason_of
from warp_kernels.errors import OptionError, TrimotionError

_RANGE = {"frames": ("frames",), "times": ("start", "end")}
"""How messages begin that are about a whole range, and the options that make it."""


def shipped_presets() -> dict[str, Path]:
    """The presets that come with the program, by name."""
    found = (Path(__file__).parents[1] / "presets").glob("*.toml")
    return {path.stem: path for path in sorted(found)}


def read_preset(name: str) -> dict[str, object]:
    """Read a preset, a TOML file or the name of a shipped one: values by field name.

    Raises:
        OptionError: If it cannot be read, or holds anything that is not an option.
    """
    shipped = shipped_presets()
    try:
        table = tomllib.loads(read_text(shipped.get(name, Path(name))))
    except OSError as error:
        raise OptionError(
            f"--preset {name}: cannot be read ({str(error.strerror).lower()}); "
            f"{nearest(name, shipped, 'give a TOML file or one of')}"
        ) from error
    except (ValueError, RecursionError) as error:
        reason = reason_of(error) if isinstance(error, UnicodeDecodeError) else error
        raise OptionError(f"--preset {name}: not a TOML file ({reason}); mend it") from error
    options = {option.flag: option for option in job_options()}
    values: dict[str, object] = {}
    for key, value in table.items():
        option = options.get(key.replace("_", "-"))
        if option is None:
            similar = difflib.get_close_matches(key.replace("_", "-"), options, n=1)
            remedy = f"did you mean {similar[0]}?" if similar else "trimotion help animate has all"
            raise OptionError(f"--preset {name}: unknown option {key!r}; {remedy}")
        values[option.dest] = option.value(value, f"--preset {name}: {key}")
    return values


@contextmanager
def blamed(given: Mapping[str, object]) -> Iterator[None]:
    """Let errors about a value of a preset name the preset: nobody typed that option.

    Args:
        given: What the user gave, by field name, `preset` among it.

    Raises:
        TrimotionError: What the block raises.
    """
    try:
        yield
    except TrimotionError as error:
        text, name = str(error), given.get("preset")
        if isinstance(name, str) and not text.startswith("--preset"):
            held = read_preset(name)
            if _is_about(text, {dest: held[dest] for dest in held if dest not in given}):
                error.args = (f"--preset {name}: {text}",)
        raise


def _is_about(text: str, held: Mapping[str, object]) -> bool:
    """Whether a message is about one of these values, by its option or because it is a file."""
    problem, first = text.split(";")[0], re.split(r"[ :]", text)[0]
    if any(dest in held for dest in _RANGE.get(first, ())):
        return True
    flags = {option.flag for option in job_options() if option.dest in held}
    named = set(re.findall(r"--([a-z][a-z-]*)", problem)) | {first}
    files = {value for value in held.values() if isinstance(value, str)}
    return bool(flags & named) or problem.split(": ")[0] in files


def without_effect(command: str, name: str, held: Collection[str]) -> str | None:
    """What to say about options of a preset that a command does not have.

    Args:
        command: The command.
        name: The preset.
        held: Fields that it gives.

    Returns:
        None if there are none.
    """
    has = COMMAND_OPTIONS[command]
    left = [option.flag for option in job_options() if option.dest in held and not has(option)]
    if not left:
        return None
    why = "solves" if command == "render" else "draws"
    return f"--preset {name}: {command} {why} nothing, so it leaves out {', '.join(left)}"
