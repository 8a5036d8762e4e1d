"""Whether a report can be written, found out before any work is done."""

import os
from pathlib import Path

from pipeline.options.output import Output
from pipeline.options.run import Run
from stages.media.writing.place import check_folder, check_name, is_among
from warp_kernels.errors import OptionError, OutputError

ENDINGS = (".json", ".html")
"""What a report may be."""


def check_report(run: Run, output: Output, source: Path) -> None:
    """Refuse a report that could not be written when all is done.

    Args:
        run: Names the report, if there is one.
        output: What else is written.
        source: What is converted or drawn.

    Raises:
        OptionError: If its ending is unknown, or it is another file of the run.
        OutputError: If it exists and may not be replaced, or its folder takes no file.
    """
    if run.report is None:
        return
    path = Path(run.report)
    if path.name.lower() in ENDINGS:
        named = path.with_name(f"report{path.name}")
        raise OptionError(f"--report {path}: is an ending without a name; write {named}")
    if path.suffix.lower() not in ENDINGS:
        raise OptionError(f"--report {path}: ends with neither {' nor '.join(ENDINGS)}; add one")
    others = [one for one in (source, output.path, output.track) if one]
    if is_among(path, others):
        raise OptionError(f"--report {path}: is read or written as well; choose another name")
    if os.path.lexists(path) and not output.overwrite:
        raise OutputError(path, "exists already", "choose another name or --overwrite")
    check_name(path)
    check_folder(path)
