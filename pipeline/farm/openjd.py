"""A job as a template of Open Job Description (2023-09, with the extension TASK_CHUNKING)."""

import json

from pipeline.farm.farm_job import FarmJob
from warp_kernels.errors import OptionError

CHUNK_SECONDS = 600
"""How long the parts that a machine takes at once shall last [s]: long beside the start of a
program, short beside what is lost with a machine."""
VERSION = "jobtemplate-2023-09"
"""Of the specification."""
LONGEST_NAME = 128
"""Letters that the name of a job may have."""

SOLVE = """\
set -euo pipefail
ranges=({ranges})
program=$1 chunk=$2 begin=$3
shift 3
for ((part = ${{chunk%-*}}; part <= ${{chunk#*-}}; part++)); do
    range=${{ranges[part]}}
    "$program" "$1" "$2" -o "$begin.$range.mtrk" --frames "$range" "${{@:3}}"
done
"""
"""Solves the parts from the first to the last number of a chunk, such as 3-5."""

JOIN = """\
set -euo pipefail
ranges=({ranges})
program=$1 begin=$2 output=$3
shift 3
parts=()
for range in "${{ranges[@]}}"; do parts+=("$begin.$range.mtrk"); done
"$program" join "${{parts[@]}}" -o "$output" "$@"
"""
"""Joins all parts."""


def as_openjd(job: FarmJob) -> str:
    """A template as JSON. Paths are arguments, so no shell looks into them.

    Args:
        job: The job.

    Raises:
        OptionError: If a word would be taken for an expression of the template.
    """
    begin = str(job.track.with_suffix(""))
    words = job.solving("", "")
    solving = [*words[:2], *words[words.index("--resume") :]]
    joining = job.joining([])
    for word in (*solving, *joining):
        if "{{" in word:
            raise OptionError(
                f"{word}: Open Job Description takes {{{{ for an expression; rename it"
            )
    ranges = " ".join(map(str, job.ranges))
    template = {
        "specificationVersion": VERSION,
        "extensions": ["TASK_CHUNKING"],
        "name": " ".join(f"trimotion {job.name}".split())[:LONGEST_NAME],
        "description": f"Solves a film in {len(job.ranges)} parts and joins them.",
        "parameterDefinitions": [
            _parameter("Program", "STRING", "trimotion", "the program, as the machines find it"),
            _parameter("ChunkSeconds", "INT", CHUNK_SECONDS, "how long a chunk shall take [s]"),
        ],
        "steps": [
            {
                "name": "Solve",
                "parameterSpace": {"taskParameterDefinitions": [_parts(len(job.ranges))]},
                "script": _script(
                    SOLVE.format(ranges=ranges), "{{Task.Param.Part}}", begin, *solving
                ),
            },
            {
                "name": "Join",
                "dependencies": [{"dependsOn": "Solve"}],
                "script": _script(JOIN.format(ranges=ranges), begin, joining[2], *joining[3:]),
            },
        ],
    }
    return json.dumps(template, indent=2)


def _parameter(name: str, kind: str, default: str | int, text: str) -> dict[str, object]:
    more = {"minValue": 1} if kind == "INT" else {"minLength": 1}
    return {"name": name, "type": kind, "default": default, "description": text, **more}


def _parts(count: int) -> dict[str, object]:
    """Numbers of the parts; a chunk is some that follow each other."""
    return {
        "name": "Part",
        "type": "CHUNK[INT]",
        "range": f"0-{count - 1}",
        "chunks": {
            "defaultTaskCount": 1,
            "targetRuntimeSeconds": "{{Param.ChunkSeconds}}",
            "rangeConstraint": "CONTIGUOUS",
        },
    }


def _script(text: str, *arguments: str) -> dict[str, object]:
    """A script for bash, given the program and more."""
    words = ["{{Task.File.Run}}", "{{Param.Program}}", *arguments]
    return {
        "actions": {"onRun": {"command": "bash", "args": words}},
        "embeddedFiles": [{"name": "Run", "type": "TEXT", "filename": "run.sh", "data": text}],
    }
