"""Options from a TOML file: `triangles = 3000`, `style = ["flat", "edges:width=1"]`."""

import tomllib
from pathlib import Path

from pipeline.options.command_line import job_options
from pipeline.options.nearest import nearest
from stages.media.text_file import read_text
from warp_kernels.errors import OptionError


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
        raise OptionError(f"--preset {name}: not a TOML file ({error}); mend it") from error
    options = {option.flag: option for option in job_options()}
    values: dict[str, object] = {}
    for key, value in table.items():
        option = options.get(key.replace("_", "-"))
        if option is None:
            raise OptionError(
                f"--preset {name}: unknown option {key!r}; the options are {', '.join(options)}"
            )
        values[option.dest] = option.value(value, f"--preset {name}: {key}")
    return values
