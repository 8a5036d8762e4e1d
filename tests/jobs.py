"""Jobs for tests: the options of all parts as one flat list."""

from dataclasses import fields, replace
from pathlib import Path
from typing import Any

from pipeline.options.job import Job
from pipeline.options.solve_options import SolveOptions

PARTS = ("solve", "look", "output", "run")


def job_of(source: Path, output: Path | None = None, **options: Any) -> Job:
    """A job whose options are given by the names of their fields, whatever part they belong to."""
    return changed(Job(SolveOptions(source)), path=output, **options)


def changed(job: Job, **options: Any) -> Job:
    """A job with other options."""
    for part in PARTS:
        known = getattr(job, part)
        mine = {f.name: options.pop(f.name) for f in fields(known) if f.name in options}
        job = replace(job, **{part: replace(known, **mine)})
    assert not options, options
    return job
