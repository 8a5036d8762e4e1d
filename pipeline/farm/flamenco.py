"""A job type for Flamenco 3: JavaScript that its Manager runs, a task for every part."""

import json
from string import Template

from pipeline.farm.farm_job import FarmJob

SCRIPT = Template("""\
// Solves a film in $count parts and joins them. Put this file into the folder scripts of the
// Flamenco Manager, restart that, and submit a job of this type. Every worker must see the files
// under the names below. A task that failed or was stopped can be queued again: it goes on.

const JOB_TYPE = {
  label: $label,
  settings: [
    {
      key: "program",
      type: "string",
      default: "trimotion",
      description: "The program, as the workers find it",
    },
  ],
};

const PARTS = $parts;

const JOIN = $join;

function compileJob(job) {
  const join = author.Task("join", "misc");
  for (const part of PARTS) {
    const task = author.Task("solve-" + part.range, "misc");
    task.addCommand(author.Command("exec", { exe: job.settings.program, args: part.args }));
    job.addTask(task);
    join.addDependency(task);
  }
  join.addCommand(author.Command("exec", { exe: job.settings.program, args: JOIN }));
  job.addTask(join);
}
""")


def as_flamenco(job: FarmJob) -> str:
    """A script that is a job type. Texts are of ASCII alone, so nothing ends them early.

    Args:
        job: The job.
    """
    tracks = list(map(str, job.tracks))
    pairs = zip(map(str, job.ranges), tracks, strict=True)
    parts = [{"range": part, "args": job.solving(part, track)} for part, track in pairs]
    return SCRIPT.substitute(
        count=len(parts),
        label=json.dumps(f"Trimotion: {job.name}"),
        parts=json.dumps(parts, indent=2),
        join=json.dumps(job.joining(tracks), indent=2),
    )
