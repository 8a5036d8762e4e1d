"""Jobs of farms do what one run does: each is run by its engine, or by what stands for it."""

import json
import os
import shutil
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path

import pytest

from pipeline.cli import main
from pipeline.farm.farm_job import FarmJob
from pipeline.farm.formats import ENGINES
from pipeline.farm.slurm import MOST_TASKS, as_slurm
from stages.media import FrameRange
from tests.tracks import COUNT, CUT, QUICK_FLAGS, rows_of, write_clip
from warp_kernels.errors import OptionError

ODD = "a b'c\"d $(exit 9) `x` é\\;#"
"""What no shell may look into."""

TRIMOTION = """#!/bin/sh
number=$(ls "$RECORD" | wc -l)
printf '%s\\0' "$@" > "$RECORD/$number"
"""
SBATCH = """#!/bin/bash
set -eu
printf '%s\\0' "$@" > "$RECORD.job.$(ls "$RECORD".job.* 2>/dev/null | wc -l)"
array=-
while [ "${1#-}" != "$1" ]; do
    case $1 in --array=*) array=${1#--array=} ;; esac
    shift
done
cp "$1" "$RECORD.spooled"
shift
if [ "$array" = - ]; then bash "$RECORD.spooled" "$@"; else
    for ((task = ${array%-*}; task <= ${array#*-}; task++)); do
        SLURM_ARRAY_TASK_ID=$task SLURM_CPUS_PER_TASK=1 bash "$RECORD.spooled" "$@"
    done
fi
echo "41;cluster"
"""
"""They stand for the programs: the first keeps what it is told, the second does it at once."""

FLAMENCO = """
const author = {
  Task: (name, type) => ({ name, type, commands: [], after: [],
    addCommand(command) { this.commands.push(command); },
    addDependency(task) { this.after.push(task.name); } }),
  Command: (name, parameters) => ({ name, parameters }),
};
const tasks = [];
const settings = {};
for (const setting of JOB_TYPE.settings) settings[setting.key] = setting.default;
compileJob({ name: "film", settings, addTask(task) { tasks.push(task); } });
console.log(JSON.stringify({ label: JOB_TYPE.label, tasks }));
"""
"""What Flamenco's Manager gives a job type."""


@pytest.fixture(scope="module")
def clip(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A clip whose name no shell may look into."""
    return write_clip(tmp_path_factory.mktemp("farm") / f"{ODD}.mp4")


@pytest.fixture(scope="module")
def whole(clip: Path) -> dict:
    """The rows of one run."""
    track = clip.with_name("whole.mtrk")
    assert main(["solve", str(clip), "-o", str(track), *QUICK_FLAGS, "-q"]) == 0
    return rows_of(track)


@pytest.fixture
def farm(tmp_path: Path) -> dict[str, str]:
    """The environment of a farm whose program only keeps what it is told."""
    for name, text in (("trimotion", TRIMOTION), ("sbatch", SBATCH)):
        program = tmp_path / "bin" / name
        program.parent.mkdir(exist_ok=True)
        program.write_text(text)
        program.chmod(0o755)
    record = tmp_path / "record"
    record.mkdir()
    path = f"{tmp_path / 'bin'}{os.pathsep}{os.environ['PATH']}"
    return {**os.environ, "PATH": path, "RECORD": str(record)}


def job_for(engine: str, clip: Path, track: Path, capsys, *options: str) -> str:
    """What `plan` prints."""
    given = ["--format", engine, "-o", str(track), *QUICK_FLAGS, *options]
    assert main(["plan", str(clip), *given]) == 0
    return capsys.readouterr().out


def told(farm: dict[str, str]) -> list[list[str]]:
    """What the program was told, call by call."""
    files = sorted(Path(farm["RECORD"]).iterdir(), key=lambda file: int(file.name))
    return [words_in(file) for file in files]


def words_in(file: Path) -> list[str]:
    """What one call was told."""
    return file.read_bytes().decode().split("\0")[:-1]


def assert_whole(calls: Sequence[list[str]], track: Path, whole: dict) -> None:
    """What was told comes to the same bits as one run, and once more as well."""
    assert [call[0] for call in calls] == ["solve", "solve", "join"]
    for call in (*calls[:1], *calls):  # the first part twice: it is there, and stays
        assert main([*call, "-q"]) == 0
    assert rows_of(track) == whole


def test_slurm(clip: Path, whole: dict, tmp_path: Path, farm: dict[str, str], capsys) -> None:
    """An array, then a job that waits for it; options go to both; odd names stay names."""
    track = tmp_path / f"{ODD}.mtrk"
    script = tmp_path / "film.sh"
    script.write_text(job_for("slurm", clip, track, capsys))
    subprocess.run(["bash", script, "--partition=cpu"], env=farm, check=True, cwd="/")
    array, join = (words_in(Path(f"{farm['RECORD']}.job.{number}")) for number in (0, 1))
    assert {"--array=0-1", "--partition=cpu"} < set(array)
    assert {"--dependency=afterok:41", "--partition=cpu"} < set(join)
    calls = told(farm)
    assert calls[0][-2:] == ["--threads", "1"]  # as many as the array's task has
    assert_whole(calls, track, whole)


def test_slurm_takes_more_parts_than_an_array_has(farm: dict[str, str], tmp_path: Path) -> None:
    """Every part is taken once."""
    count = MOST_TASKS + 2
    ranges = tuple(FrameRange(n, n) for n in range(count))
    script = tmp_path / "film.sh"
    script.write_text(as_slurm(FarmJob(Path("/film.mp4"), Path("/film.mtrk"), ranges, threads=3)))
    text = script.read_text()
    assert f"--array=0-{MOST_TASKS - 1} --cpus-per-task=3" in text
    for task, expected in ((1, ["1-1", f"{MOST_TASKS + 1}-{MOST_TASKS + 1}"]), (9, ["9-9"])):
        shutil.rmtree(farm["RECORD"])
        Path(farm["RECORD"]).mkdir()
        environment = {**farm, "SLURM_ARRAY_TASK_ID": str(task)}
        subprocess.run(["bash", script, "solve"], env=environment, check=True)
        assert [call[call.index("--frames") + 1] for call in told(farm)] == expected


def test_openjd(clip: Path, whole: dict, tmp_path: Path, farm: dict[str, str], capsys) -> None:
    """By its own runner: all chunks, then the step that depends on them."""
    pytest.importorskip("openjd.cli", reason="openjd-cli is not installed")
    track, template = tmp_path / f"{ODD}.mtrk", tmp_path / "film.json"
    template.write_text(job_for("openjd", clip, track, capsys))
    command = [sys.executable, "-m", "openjd", "run", template, "--step", "Join"]
    done = subprocess.run(
        [*command, "--run-dependencies"], env=farm, check=False, capture_output=True, text=True
    )
    assert done.returncode == 0, done.stdout + done.stderr
    assert_whole(told(farm), track, whole)


def test_openjd_chunks(clip: Path, tmp_path: Path, farm: dict[str, str], capsys) -> None:
    """A machine may take several parts at once."""
    template = json.loads(job_for("openjd", clip, tmp_path / "t.mtrk", capsys))
    assert template["extensions"] == ["TASK_CHUNKING"]
    solve = template["steps"][0]
    assert solve["parameterSpace"]["taskParameterDefinitions"][0]["type"] == "CHUNK[INT]"
    script = tmp_path / "run.sh"
    script.write_text(solve["script"]["embeddedFiles"][0]["data"])
    meant = {"{{Task.File.Run}}": str(script), "{{Task.Param.Part}}": "0-1"}
    words = [meant.get(word, word) for word in solve["script"]["actions"]["onRun"]["args"]]
    words[1] = "trimotion"
    subprocess.run(["bash", *words], env=farm, check=True)
    assert [call[call.index("--frames") + 1] for call in told(farm)] == [
        f"0-{CUT - 1}",
        f"{CUT}-{COUNT - 1}",
    ]


def test_openjd_expressions_are_refused(tmp_path: Path) -> None:
    """Two braces in a name would be replaced there."""
    job = FarmJob(Path("/a{{b}}.mp4"), tmp_path / "t.mtrk", (FrameRange(0, 1),))
    with pytest.raises(OptionError, match="rename it"):
        ENGINES["openjd"](job)


def test_flamenco(clip: Path, whole: dict, tmp_path: Path, capsys) -> None:
    """By a JavaScript engine that gives it what the Manager gives."""
    node = shutil.which("node")
    if node is None:
        pytest.skip("no node to run JavaScript")
    track, script = tmp_path / f"{ODD}.mtrk", tmp_path / "film.js"
    script.write_text(job_for("flamenco", clip, track, capsys) + FLAMENCO)
    done = subprocess.run([node, script], check=True, capture_output=True, text=True)
    made = json.loads(done.stdout)
    assert made["label"] == f"Trimotion: {ODD}"
    tasks = made["tasks"]
    assert tasks[-1]["after"] == [task["name"] for task in tasks[:-1]]
    commands = [command for task in tasks for command in task["commands"]]
    assert {command["name"] for command in commands} == {"exec"}
    assert {command["parameters"]["exe"] for command in commands} == {"trimotion"}
    assert_whole([command["parameters"]["args"] for command in commands], track, whole)


def test_options_go_along(clip: Path, tmp_path: Path, capsys, monkeypatch) -> None:
    """Those of a preset too; names of files are absolute, and an option may be said twice."""
    monkeypatch.chdir(tmp_path)
    preset, cuts = tmp_path / "my.toml", tmp_path / "cuts"
    preset.write_text('regularity = 0.25\nstyle = ["flat"]\n')
    cuts.write_text("6\n")
    (tmp_path / "center").mkdir()
    options = ["--preset", "my.toml", "--cuts", "cuts", "--focus", "center", "--focus", "motion"]
    line = job_for("slurm", clip, Path("t.mtrk"), capsys, *options, "--overwrite")
    assert "--regularity=0.25" in line
    assert f"--cuts={cuts}" in line
    assert "--focus=center --focus=motion" in line
    assert f"-o {tmp_path / 't.mtrk'} --overwrite" in line
    assert "flat" not in line


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (["--format", "grid"], "slurm"),
        (["--format", "slurm", "-o", "film.mp4"], "mtrk"),
        (["--format", "slurm", "--triangles", "-3"], "--triangles"),
        (["--jobs", "3"], "--jobs"),
    ],
)
def test_mistakes_are_one_line(clip: Path, options: list[str], message: str, capsys) -> None:
    """Before anything is printed for a machine."""
    assert main(["plan", str(clip), *options]) == 2
    captured = capsys.readouterr()
    assert captured.out == ""
    assert captured.err.count("\n") == 1
    assert message in captured.err


def test_a_pipe_is_no_source_of_a_farm(capsys) -> None:
    """Other machines cannot read it."""
    assert main(["plan", "-", "--format", "openjd"]) == 2
    assert "no farm can read this pipe" in capsys.readouterr().err
