"""A job for Slurm: an array of parts, and a job that waits for it and joins them."""

import shlex
from string import Template

from pipeline.farm.farm_job import FarmJob

MOST_TASKS = 1000
"""Most tasks of an array; Slurm's own default for MaxArraySize is one more. Further parts are
taken by the same tasks, one after the other."""

SCRIPT = Template("""\
#!/bin/bash
# Solves a film in $count parts as an array of Slurm, and joins them when all are done:
#
#     bash SCRIPT [options of sbatch, such as --partition=NAME --cpus-per-task=8 --time=2:00:00]
#
# The same line again goes on with what failed or was stopped, and finds the rest done.
# Every machine must see the files under the names below, and have trimotion on its PATH.
set -euo pipefail

ranges=($ranges)
part_of() { printf '%s.%s.mtrk' $begin "$$1"; }

solve() {
    trimotion $solve
}

join() {
    local parts=() range
    for range in "$${ranges[@]}"; do parts+=("$$(part_of "$$range")"); done
    trimotion $join
}

case "$${1-}" in
    solve)
        for ((part = SLURM_ARRAY_TASK_ID; part < $${#ranges[@]}; part += $tasks)); do
            solve "$${ranges[part]}"
        done
        ;;
    join) join ;;
    *)
        name=$name
        array=$$(sbatch --parsable --job-name="$$name" --array=0-$last$cpus "$$@" "$$0" solve)
        sbatch --parsable --job-name="$$name join" --dependency="afterok:$${array%%;*}" \\
            --kill-on-invalid-dep=yes "$$@" "$$0" join
        ;;
esac
""")
"""One script is three: it submits, and it is what is submitted, twice."""


def as_slurm(job: FarmJob) -> str:
    """A script for bash that submits a job.

    Args:
        job: The job.
    """
    count = len(job.ranges)
    tasks = min(count, MOST_TASKS)
    solve = _quoted(job.solving("@RANGE", "@TRACK"), RANGE='"$1"', TRACK='"$(part_of "$1")"')
    if not job.threads:
        solve += ' --threads "${SLURM_CPUS_PER_TASK:-1}"'
    return SCRIPT.substitute(
        count=count,
        ranges=" ".join(map(str, job.ranges)),
        begin=shlex.quote(str(job.track.with_suffix(""))),
        solve=solve,
        join=_quoted(job.joining(["@TRACKS"]), TRACKS='"${parts[@]}"'),
        tasks=tasks,
        name=shlex.quote(f"trimotion {job.name}"),
        last=tasks - 1,
        cpus=f" --cpus-per-task={job.threads}" if job.threads else "",
    )


def _quoted(words: list[str], **places: str) -> str:
    """Words for bash; those that are `@NAME` become what stands for them there."""
    return " ".join(
        places[word[1:]] if word.startswith("@") and word[1:] in places else shlex.quote(word)
        for word in words
    )
