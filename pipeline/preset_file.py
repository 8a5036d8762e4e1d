"""Options from a TOML file: `triangles = 3000`, `style = ["flat", "edges:width=1"]`."""

import tomllib
from argparse import ArgumentTypeError
from pathlib import Path

from pipeline.options import Option, job_options
from pipeline.text_file import read_text
from warp_kernels.errors import OptionError

SHIPPED = Path(__file__).parent / "presets"
"""Folder of the presets that are known by name alone."""


def shipped_presets() -> list[str]:
    """Names of the presets that come with the program."""
    return sorted(path.stem for path in SHIPPED.glob("*.toml"))


def read_preset(name: str) -> dict[str, object]:
    """Read a preset.

    Args:
        name: A TOML file, or the name of a shipped preset.

    Returns:
        Values by field name, as the command line would give them.

    Raises:
        OptionError: If it cannot be read, or holds anything that is not an option.
    """
    path = SHIPPED / f"{name}.toml" if name in shipped_presets() else Path(name)
    try:
        table = tomllib.loads(read_text(path))
    except OSError as error:
        raise OptionError(
            f"--preset {name}: cannot be read ({str(error.strerror).lower()}); give a TOML file "
            f"or one of {', '.join(shipped_presets())}"
        ) from error
    except ValueError as error:
        raise OptionError(f"--preset {name}: not a TOML file ({error}); mend it") from error
    options = {option.flag: option for option in job_options()}
    values: dict[str, object] = {}
    for key, value in table.items():
        option = options.get(key.replace("_", "-"))
        if option is None:
            raise OptionError(
                f"--preset {name}: unknown option {key!r}; the options are {', '.join(options)}"
            )
        values[option.dest] = _value_of(option, value, f"--preset {name}: {key}")
    return values


def _value_of(option: Option, value: object, what: str) -> object:
    """A value of the file, as the command line would give it."""
    if option.is_switch:
        if not isinstance(value, bool):
            raise OptionError(f"{what} = {value!r}: write true or false")
        return option.switched if value else not option.switched
    if option.is_repeatable:
        entries = value if isinstance(value, list) else [value]
        return [_single(option, entry, what) for entry in entries]
    return _single(option, value, what)


def _single(option: Option, value: object, what: str) -> object:
    """One value, read by the same function as on the command line."""
    if isinstance(value, bool) or not isinstance(value, str | int | float):
        raise OptionError(f"{what} = {value!r}: write a number or a text in quotes")
    try:
        result = option.read(str(value))
    except ArgumentTypeError as error:
        raise OptionError(f"{what}: {error}") from error
    if option.choices is not None and result not in option.choices:
        raise OptionError(f"{what} = {value!r}: choose from {', '.join(option.choices)}")
    return result
