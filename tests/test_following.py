"""Regions that stay with their triangles: chosen by a mask once, then inherited, until a cut."""

from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import cv2
import numpy as np
import pytest

from pipeline.cli import main
from pipeline.look.region_masks import check_followed
from pipeline.options.members import parse_region
from pipeline.track import TrackReader
from stages.edits import flip_edges, split_triangles
from stages.masks.region import Region
from stages.media import probe
from stages.motion.correspondence import kept_triangles
from stages.motion.inherit_regions import inherited, under_mask
from stages.render import Renderer
from tests import media_samples as samples
from tests.golden_images import write_png
from tests.jobs import changed, job_of
from tests.meshes import HEIGHT, WIDTH, random_mesh, two_triangles
from tests.snapshots import restless_shot, snapshot_with
from tests.tracks import COUNT, CUT, write_clip
from warp_kernels.device.device import Device
from warp_kernels.errors import OptionError
from warp_kernels.styles import STYLES
from warp_kernels.styles.flat import Flat

QUICK = ("--iterations", "2", "--frame-iterations", "4", "--triangles", "60")
RED = "paper:color=#f00,grain=0,sheets=0"
SHAPE = (96, 64)
"""Width and height of the clip [px]."""


@pytest.fixture(scope="module")
def clip(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Give a clip of two shots with a mask of its left half beside it."""
    folder = tmp_path_factory.mktemp("following")
    mask = np.zeros((SHAPE[1], SHAPE[0], 3), np.uint8)
    mask[:, :48] = 255
    write_png(folder / "mask.png", mask)
    for number in (1, 3):
        write_png(folder / f"gap_{number}.png", mask)
    write_png(folder / "small.png", mask[:, 48:])
    samples.write_video(folder / "short.mp4", [mask, mask])
    return write_clip(folder / "in.mp4")


@pytest.fixture(scope="module")
def track(clip: Path) -> Path:
    """Give its track."""
    target = clip.with_name("in.mtrk")
    assert main(["solve", str(clip), "-o", str(target), *QUICK, "--progress", "none"]) == 0
    return target


def frames(command: str, source: Path, folder: Path, *flags: str) -> dict[int, bytes]:
    """What a command writes, by frame."""
    folder.mkdir()
    out = ["-o", str(folder / "f_##.png"), "--progress", "none"]
    assert main([command, str(source), *out, *flags]) == 0
    return {int(path.stem[-2:]): path.read_bytes() for path in sorted(folder.iterdir())}


def region(clip: Path, frame: int, style: str = RED) -> tuple[str, str]:
    """The option that follows the mask from a frame."""
    return "--region", f"{clip.with_name('mask.png')}@{frame}:{style}"


def test_mask_chooses_the_triangles_that_it_shows(device: str) -> None:
    """A mask that was drawn from triangles gives these back."""
    mesh = random_mesh(3, inner=40)
    chosen = np.random.default_rng(0).random(mesh.triangle_count) < 0.4
    snapshot = snapshot_with(mesh, np.repeat(255 * chosen, 3))
    size = (WIDTH, HEIGHT)
    mask = Renderer(Device(device), size, size, (Flat(),)).render(snapshot)[..., 0]
    large = mesh.areas > 8
    assert large.sum() > 60
    np.testing.assert_array_equal(under_mask(mesh, mask)[large], chosen[large])


def test_what_persists_keeps_its_regions_and_what_is_new_inherits() -> None:
    """Over frames that flip, split and collapse, forwards and backwards; all of it stays all."""
    forwards = restless_shot(random_mesh(5), 8)
    for shot in (forwards, forwards[::-1]):
        count = shot[0].mesh.triangle_count
        members = np.stack([np.arange(count) % 3 == 0, np.full(count, True), np.zeros(count)], 1)
        members = members.astype(bool)
        for before, after in pairwise(shot):
            found = inherited(before, after, members)
            kept = kept_triangles(before.mesh, after.mesh)
            np.testing.assert_array_equal(found[kept >= 0], members[kept[kept >= 0]])
            assert (kept < 0).any()
            assert found[:, 1].all()
            assert not found[:, 2].any()
            members = found
        assert 0.1 < members[:, 0].mean() < 0.6


def test_parts_of_a_member_are_members() -> None:
    """A split hands all of it on; where nothing comes or goes nothing is worked out."""
    mesh = random_mesh(2)
    rng = np.random.default_rng(1)
    members = rng.random((mesh.triangle_count, 2)) < 0.5
    colors = rng.integers(0, 256, (mesh.triangle_count, 3))
    before = snapshot_with(mesh, colors)
    after = snapshot_with(mesh.moved(mesh.vertices.copy()), colors[::-1])
    assert inherited(before, after, members) is members
    chosen = np.arange(0, mesh.triangle_count, 4)
    split = split_triangles(mesh, chosen)
    parents = np.arange(split.triangle_count)
    parents[mesh.triangle_count :] = np.tile(chosen, 2)
    after = snapshot_with(split, colors[parents])
    np.testing.assert_array_equal(inherited(before, after, members), members[parents])


def test_what_was_hidden_is_not_taken_for_what_hid_it() -> None:
    """A new triangle belongs to what it looks like, if that lies beneath or beside it."""
    mesh = two_triangles()
    members = np.array([[True], [False]])
    before = snapshot_with(mesh, [(200, 0, 0), (0, 0, 90)])
    flipped = flip_edges(mesh, np.flatnonzero(mesh.twins >= 0)[:1])
    for colors, wanted in (
        ([(190, 9, 0), (0, 0, 99)], [True, False]),
        ([(200, 0, 9), (210, 0, 0)], [True, True]),
    ):
        found = inherited(before, snapshot_with(flipped, colors), members)
        assert found[:, 0].tolist() == wanted


def test_style_is_drawn_on_these_triangles_alone(clip: Path, track: Path, tmp_path: Path) -> None:
    """Every pixel of a member is the style's, every pixel of the others untouched, to the bit."""
    found = frames("render", track, tmp_path / "found", *region(clip, 2))
    plain = frames("render", track, tmp_path / "plain")
    with TrackReader(track) as reader:
        shot = [reader.snapshot(frame) for frame in range(CUT)]
    members = {2: under_mask(shot[2].mesh, cv2.imread(str(clip.with_name("mask.png")))[..., 0])}
    for frame in (3, 4, 5, 1, 0):
        source = frame - 1 if frame > 2 else frame + 1
        members[frame] = inherited(shot[source], shot[frame], members[source][:, None])[:, 0]
    renderer = Renderer(Device("cpu"), SHAPE, SHAPE, (Flat(),))
    for frame, snapshot in enumerate(shot):
        shown, before = decoded(found[frame]), decoded(plain[frame])
        mask = renderer.render(snapshot_with(snapshot.mesh, np.repeat(255 * members[frame], 3)))[
            ..., 0
        ]
        assert (shown[mask == 255] == (255, 0, 0)).all()
        np.testing.assert_array_equal(shown[mask == 0], before[mask == 0])
        assert 0.2 < (mask == 255).mean() < 0.8
    assert {f: found[f] for f in range(CUT, COUNT)} == {f: plain[f] for f in range(CUT, COUNT)}


def test_masks_of_several_frames_take_turns(clip: Path, track: Path, tmp_path: Path) -> None:
    """Each frame shows what is carried there from the nearest of its shot, the earlier of two."""
    for frame in (1, 5, 8):
        mask = np.zeros((SHAPE[1], SHAPE[0], 3), np.uint8)
        mask[:, : 12 * frame] = 255
        write_png(tmp_path / f"m_{frame}.png", mask)
    name = str(tmp_path / "m_%01d.png")
    alone = {
        key: frames("render", track, tmp_path / str(key), "--region", f"{name}@{key}:{RED}")
        for key in (1, 5, 8)
    }
    found = frames("render", track, tmp_path / "all", "--region", f"{name}@8,5,1:{RED}")
    for frame, picture in found.items():
        assert picture == alone[1 if frame <= 3 else 5 if frame < CUT else 8][frame]
    part = frames(
        "render", track, tmp_path / "p", "--frames", "4-7", "--region", f"{name}@8,5,1:{RED}"
    )
    assert part == {frame: found[frame] for frame in part}


def decoded(png: bytes) -> np.ndarray:
    """Pixels of a file, RGB."""
    return cv2.imdecode(np.frombuffer(png, np.uint8), cv2.IMREAD_COLOR)[..., ::-1]


@pytest.mark.parametrize("style", ["hatching", "gradient"])
def test_part_is_that_of_the_whole(style: str, clip: Path, track: Path, tmp_path: Path) -> None:
    """Ranges on either side of the mask's frame, also with fading, smoothing and a still mask."""
    mask = str(clip.with_name("mask.png"))
    look = ("--style", "flat", "--region", f"{mask}:edges", *region(clip, 2, style))
    look += ("--blend", "2", "--smooth", "0.5", *region(clip, 9))
    whole = frames("render", track, tmp_path / "whole", *look)
    for number, wanted in enumerate(("4-5", "0-0", "7-8", "5-6", "10-11")):
        part = frames("render", track, tmp_path / str(number), "--frames", wanted, *look)
        assert part == {name: whole[name] for name in part}


@pytest.mark.parametrize("flags", [(), ("--track", "kept.mtrk")])
def test_animate_draws_what_render_draws(
    flags: tuple[str, ...], clip: Path, track: Path, tmp_path: Path, monkeypatch
) -> None:
    """Also before the mask's frame, and after an interruption."""
    monkeypatch.chdir(tmp_path)
    look = region(clip, 4)
    wanted = frames("render", track, tmp_path / "a", *look)
    if "--track" in flags:
        begun = [str(clip), "-o", "kept.mtrk", "--frames", "0-2", "--progress", "none"]
        assert main(["solve", *begun, *QUICK]) == 0
        flags = (*flags, "--resume")
    assert frames("animate", clip, tmp_path / "b", *QUICK, *look, *flags) == wanted
    left = {path.name for path in tmp_path.iterdir()} - {"a", "b"}
    assert left == ({"kept.mtrk"} if "--track" in flags else set())


def test_name_of_a_mask_may_hold_the_sign(tmp_path: Path) -> None:
    """A file that is there is a mask that stays, whatever its name."""
    there = tmp_path / "m@3"
    there.write_bytes(b"")
    assert parse_region("--region", f"{there}:flat", STYLES).frames == ()
    assert parse_region("--region", f"{there}@5:flat", STYLES).frames == (5,)
    assert parse_region("--region", f"{there}@5:flat", STYLES).mask == str(there)
    assert parse_region("--region", "a@b.png:flat", STYLES).mask == "a@b.png"
    assert parse_region("--region", "a@9,2:flat", STYLES).frames == (2, 9)


@pytest.mark.parametrize("name", ["mask.png", "gap_%01d.png"])
@pytest.mark.parametrize("slip", ["1-2", "-1", "", "1,", "x"])
def test_slips_after_the_sign_are_no_names(name: str, slip: str, clip: Path) -> None:
    """Of a mask that is there they are told how frames are written."""
    with pytest.raises(OptionError, match="MASK@57 or MASK@57,120") as caught:
        parse_region("--region", f"{clip.with_name(name)}@{slip}:flat", STYLES)
    assert f"{name}@{slip}: {slip!r} are no frames" in str(caught.value)


def test_stills_go_by_their_numbers(clip: Path, tmp_path: Path, capsys) -> None:
    """Those that do not begin with 0 can be followed, and no frame beyond them."""
    for number in range(100, 104):
        write_png(tmp_path / f"s_{number}.png", samples.picture(*SHAPE, number))
    stills = tmp_path / "s_###.png"
    found = frames("animate", stills, tmp_path / "a", *QUICK, *region(clip, 101))
    assert len(found) == 4
    assert (decoded(found[1])[:, :20] == (255, 0, 0)).all()
    for frame in (0, 99, 104):
        out = ["-o", str(tmp_path / "b.mp4"), "--progress", "none"]
        assert main(["animate", str(stills), *out, *region(clip, frame)]) == 2
        assert "it has stills 100 to 103" in capsys.readouterr().err


def test_declared_number_of_frames_is_a_hint(clip: Path) -> None:
    """Beyond it frames are counted."""
    mask = Region(str(clip.with_name("mask.png")), Flat(), (COUNT - 1,))
    job = job_of(clip, clip.with_name("out.mp4"), regions=(mask,))
    for count in (None, 3, COUNT):
        info = replace(probe(clip), frame_count=count)
        check_followed(job, info)
        beyond = changed(job, regions=(replace(mask, frames=(COUNT,)),))
        with pytest.raises(OptionError, match="it has frames 0 to 11"):
            check_followed(beyond, info)


def test_mask_of_a_frame_between_times(clip: Path, track: Path, tmp_path: Path) -> None:
    """The first and the last frame of a range of times can be followed from."""
    times = ("--start", "0.04", "--end", "0.12")
    for frame in (1, 3):
        folder = tmp_path / str(frame)
        assert len(frames("animate", clip, folder, *QUICK, *times, *region(clip, frame))) == 3


def test_what_goes_on_may_follow_from_what_is_there(clip: Path, tmp_path: Path) -> None:
    """A frame of the track serves although this run solves later ones alone."""
    kept = str(tmp_path / "kept.mtrk")
    quiet = ("--progress", "none")
    assert main(["solve", str(clip), "-o", kept, "--frames", "0-2", *QUICK, *quiet]) == 0
    flags = ("--track", kept, "--resume", "--frames", "2-4", *region(clip, 1))
    assert list(frames("animate", clip, tmp_path / "a", *QUICK, *flags)) == [2, 3, 4]


def test_nothing_is_drawn_from_stale_memory() -> None:
    """Without shares, or with those of other triangles, a followed style is not drawn."""
    snapshot = snapshot_with(random_mesh(1), np.zeros((random_mesh(1).triangle_count, 3)))
    size = (WIDTH, HEIGHT)
    renderer = Renderer(Device("cpu"), size, size, (Flat(),), (Flat(),), (0,))
    count = snapshot.mesh.triangle_count
    renderer.render(snapshot, shares=np.zeros((count, 1), np.uint8))
    for shares in (None, np.zeros((count, 2), np.uint8), np.zeros((count - 1, 1), np.uint8)):
        with pytest.raises(ValueError, match="shares"):
            renderer.render(snapshot, shares=shares)


@pytest.mark.parametrize(
    ("command", "flags", "named"),
    [
        ("render", ("{mask}@50:flat",), "mask.png@50: no frame 50 was solved, only frames 0 to 11"),
        ("render", ("{gap}@2:flat",), "gap_%01d.png@2: "),
        ("animate", ("{mask}@50:flat",), "no frame 50"),
        ("animate", ("{mask}@2:flat", "--frames", "3-5"), "no frame 2"),
        ("animate", ("{mask}@2:flat", "--frames", "1-5x2"), "no frame 2"),
        ("animate", ("{mask}@2:flat", "--independent"), "--independent"),
        ("animate", ("{mask}@0:flat", "--start", "0.05", "--end", "0.15"), "mask.png@0: frame 0"),
        ("animate", ("{mask}@4:flat", "--start", "0.05", "--end", "0.15"), "mask.png@4: frame 4"),
        ("animate", ("{gap}@1,2:flat",), "gap_%01d.png@2: has no mask for frame 2"),
        ("animate", ("{short}@1,2:flat",), "short.mp4@2: has no mask for frame 2"),
        ("animate", ("{small}@2:flat",), "small.png@2: the mask is 48x64"),
        ("animate", ("no_such.png@2:flat",), "--region no_such.png@2: "),
        ("render", ("no_such.png@2:flat",), "--region no_such.png@2: "),
        ("render", ("{mask}@x:flat",), "mask.png@x"),
    ],
)
def test_mistakes_are_one_line(
    command: str,
    flags: tuple[str, ...],
    named: str,
    clip: Path,
    track: Path,
    tmp_path: Path,
    capsys,
) -> None:
    """What is wrong and what may be done instead, before anything is solved; nothing is left."""
    names = {"mask": "mask.png", "gap": "gap_%01d.png", "short": "short.mp4", "small": "small.png"}
    masks = {key: clip.with_name(name) for key, name in names.items()}
    text = [flag.format(**masks) for flag in flags]
    source = str(track if command == "render" else clip)
    out = tmp_path / "out.mp4"
    code = main([command, source, "-o", str(out), "--region", *text, "--progress", "json"])
    frames_told, line = capsys.readouterr()
    assert code in (2, 3)
    assert frames_told == ""
    assert named in line
    assert line.count("\n") == 1
    assert str(tmp_path) not in line
    assert not list(tmp_path.iterdir())
