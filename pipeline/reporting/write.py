"""Write a report, whole or not at all."""

import json
from pathlib import Path

from pipeline.options.job import Job
from pipeline.reporting.telling import Telling
from stages.media.writing.commit import write_file


def write_report(telling: Telling, job: Job, track: Path | None) -> None:
    """Write the report of a finished run, if one is wanted.

    Args:
        telling: What came of it.
        job: What was done; names the report.
        track: The track that was solved or drawn, or None.

    Raises:
        OutputError: If the disk or the folder refuses.
    """
    if job.run.report is None:
        return
    path, told = Path(job.run.report), telling.as_dict()
    if path.suffix.lower() == ".json":
        text = json.dumps(told, indent=1) + "\n"
    else:
        from pipeline.reporting.page import page
        from pipeline.reporting.strip import strip_of

        text = page(told, strip_of(job, track, [one["frame"] for one in told["frames"]]))
    write_file(path, text.encode())
