"""Where errors count more: what is found, what it changes, and that nothing else changes."""

import json
import sqlite3
from dataclasses import dataclass, field, replace
from fractions import Fraction
from itertools import pairwise
from pathlib import Path

import cv2
import numpy as np
import pytest

from pipeline.cli import main
from pipeline.envelope import InShot
from pipeline.loop.animate import animate, solve
from pipeline.loop.attention import UNIT, WINDOW, Attention, reach_of
from pipeline.loop.face_tracks import CARRIED, MEMORY, SEARCHED, SPACING, FaceTracks
from pipeline.options.members import parse_member
from pipeline.options.solve_options import SolveOptions
from pipeline.progress import Progress
from pipeline.track import TrackReader
from pipeline.track.plain_values import from_plain, to_plain
from stages.focus import FOCI, Glance, resolved, spelled
from stages.focus.center import Center
from stages.focus.face import Face, emphasis
from stages.focus.faces import Auto, Faces
from stages.focus.none import NoFocus
from stages.focus.picture import Picture
from stages.focus.search import OPENING, PASSING, STILL, SURE, FaceSearch
from stages.focus.yunet import MODEL, YuNet
from stages.frame import Frame
from stages.layouts.importance import Importance
from stages.media import open_decoder, probe
from stages.motion.advect import Carried
from stages.motion.springs import FIRMEST, springs_of
from stages.triangulate import Triangulator
from tests import media_samples as samples
from tests.jobs import job_of
from tests.kernel_samples import frame_of, noise
from tests.test_coverage import grid_mesh
from tests.tracks import QUICK, InTurn, rows_of, solve_to
from warp_kernels.device.device import Device
from warp_kernels.errors import OptionError

PORTRAIT = Path(__file__).parents[1] / "sample_videos" / "astronaut.jpg"
MIDDLE, EYES, MOUTH, SIZE = (227, 122), ((205, 104), (248, 104)), (226, 150), 100
"""Where the portrait's face is [px], read off the picture."""
CUT, COUNT = 11, 23
"""First frame of the second shot of the clip, and number of frames."""


@pytest.fixture(scope="module")
def portrait() -> np.ndarray:
    """The portrait, [512, 512, 3] uint8."""
    with open_decoder(PORTRAIT) as decoder:
        return next(decoder).pixels


@pytest.fixture(scope="module")
def search() -> FaceSearch:
    """A search, loaded once."""
    return FaceSearch()


def seen_from(
    portrait: np.ndarray,
    size: tuple[int, int],
    middle: tuple[float, float],
    face: float,
    turn: float = 0.0,
    *,
    mirrored: bool = False,
) -> np.ndarray:
    """The portrait as another camera sees it: its face as large, where and as turned as wanted."""
    copy = portrait[:, ::-1] if mirrored else portrait
    from_middle = (512 - MIDDLE[0] if mirrored else MIDDLE[0], MIDDLE[1])
    matrix = cv2.getRotationMatrix2D(from_middle, turn, face / SIZE)
    matrix[:, 2] += np.subtract(middle, from_middle)
    blurred = cv2.GaussianBlur(copy, (0, 0), max(0.01, 0.4 * SIZE / face))
    return cv2.warpAffine(blurred, matrix, size, borderMode=cv2.BORDER_REFLECT)


@pytest.fixture(scope="module")
def clip(portrait: np.ndarray, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A face that wanders, a cut, and another, smaller and mirrored."""
    size = (128, 96)
    first = [seen_from(portrait, size, (50 + n, 45), 45, n) for n in range(CUT)]
    places = [(84 - 2 * n, 56) for n in range(COUNT - CUT)]
    second = [seen_from(portrait, size, place, 34, mirrored=True) for place in places]
    for picture in second:  # another light, so that there is a cut
        picture[:] = picture // 3
    path = tmp_path_factory.mktemp("focus") / "face.mp4"
    return samples.write_video(path, first + second, options={"crf": "12"})


@pytest.fixture(scope="module")
def whole(clip: Path) -> Path:
    """The track of the whole clip."""
    track = clip.with_name("whole.mtrk")
    solve_to(track, clip)
    return track


def shot_frames(pictures: list[np.ndarray], first: int = 0) -> list[InShot]:
    """Frames of one shot."""
    return [InShot(first, frame_of(picture, first + n)) for n, picture in enumerate(pictures)]


def weights_of(pictures: list[np.ndarray], *members: object, first: int = 0) -> list[np.ndarray]:
    """Weights of the frames of one shot, [N, H, W] in units of a pixel that counts once."""
    height, width = pictures[0].shape[:2]
    info = replace(probe(PORTRAIT), kind="video", width=width, height=height)
    told = Attention(members or (Faces(),), info, 1, 40).beside(shot_frames(pictures, first))
    even = np.full((height, width), UNIT, np.uint8)
    weights = [even if t.frame.weights is None else t.frame.weights for t in told]
    return [one.astype(float) / UNIT for one in weights]


@pytest.mark.parametrize("name", FOCI)
def test_members_are_named_stored_and_told(name: str, tmp_path: Path) -> None:
    """Every member is made of its name, survives a track, is spelled as it was given."""
    spec = {"none": "none", "picture": f"picture:{PORTRAIT},strength=0.5"}
    text = spec.get(name, f"{name}:strength=0.5")
    member = parse_member("--focus", text, FOCI)
    assert from_plain(type(member), to_plain(member)) == member
    options = SolveOptions(PORTRAIT, focus=(member,))
    assert from_plain(SolveOptions, to_plain(options)).focus == (member,)
    assert spelled(options.foci).startswith(name)
    if isinstance(member, Glance):
        for picture in (samples.picture(48, 32), np.zeros((1, 1, 3), np.uint8)):
            seen = member.glance(frame_of(picture[::-1].copy(), 0), frame_of(picture, 1))
            assert seen.dtype == np.float32
            assert np.isfinite(seen).all()
            assert 0 <= seen.min() <= seen.max() <= 1


def test_who_is_at_work() -> None:
    """Nobody named: auto, but for nothing beside a map; none and strength 0 are nobody."""
    assert resolved((), None) == (Auto(),)
    assert resolved((), "m.png") == (Picture("m.png"),)
    assert resolved((Center(),), "m.png") == (Center(), Picture("m.png"))
    assert resolved((NoFocus(),), None) == resolved((Faces(strength=0.0),), None) == ()
    with pytest.raises(OptionError, match="none: goes with no other"):
        resolved((NoFocus(), Faces()), None)


@pytest.mark.filterwarnings("error::RuntimeWarning")
@pytest.mark.parametrize("size", [(4, 2000), (2000, 3), (1, 1), (2, 2), (1, 900)])
def test_narrow_pictures_hold_no_face(size: tuple[int, int]) -> None:
    """Of a few pixels across the network says anything; nothing of it is believed or overflows."""
    pictures = (np.full((*size, 3), 200, np.uint8), noise(size[1], size[0]))
    for pixels in pictures:
        for most in (STILL, OPENING, PASSING):
            assert FaceSearch().everywhere(pixels, most) == []


@pytest.mark.parametrize(
    ("spec", "word"),
    [
        ("nose", "choose from auto, none"),
        ("faces:strength=9", "strength 9: must lie between 0 and 4"),
        ("faces:strength=x", "write a number"),
        ("faces:age=3", "age"),
        ("none:strength=1", "strength"),
        ("center:size=0", "size 0: must lie"),
        ("motion:speed=1", "speed 1: must lie"),
        ("picture", "write picture:FILE"),
        ("picture:there.is.none.png", "there.is.none.png"),
    ],
)
def test_mistakes_are_one_line(spec: str, word: str, tmp_path: Path, capsys) -> None:
    """What is wrong and what to do, and nothing written."""
    output = tmp_path / "o.png"
    assert main(["animate", str(PORTRAIT), "-o", str(output), "--focus", spec]) in (2, 3)
    error = capsys.readouterr().err
    assert error.startswith("trimotion: error: ")
    assert error.count("\n") == 1
    assert word in error
    assert not output.exists()


def test_missing_network_is_one_line(tmp_path: Path, capfd) -> None:
    """Neither a missing file nor a damaged one makes OpenCV print anything of its own."""
    damaged = tmp_path / "b.onnx"
    damaged.write_bytes(MODEL.read_bytes()[:1000])
    for path in (tmp_path / "a.onnx", damaged):
        with pytest.raises(OptionError, match=r"onnx is missing or damaged; .*--focus none"):
            YuNet(path)
    assert capfd.readouterr() == ("", "")


def test_network_is_shipped_with_its_licence() -> None:
    """The licence and where the network is from stand beside it."""
    assert MODEL.stat().st_size == 317466
    assert "Apache License" in MODEL.with_name("LICENSE").read_text(encoding="utf-8")
    assert "Apache License 2.0" in MODEL.with_name("README.md").read_text(encoding="utf-8")


def test_portrait_has_one_face(portrait: np.ndarray, search: FaceSearch) -> None:
    """Middle, eyes, mouth and size lie where they are seen."""
    ((certainty, face),) = search.everywhere(portrait, OPENING)
    assert certainty > SURE
    assert face.places == pytest.approx(np.array([MIDDLE, *EYES, MOUTH]), abs=8)
    assert face.size == pytest.approx(SIZE, rel=0.2)


@pytest.mark.parametrize("size", [20, 40, 150])
@pytest.mark.parametrize("turn", [-30, 0, 40])
@pytest.mark.parametrize("mirrored", [False, True])
def test_small_turned_and_mirrored_faces_are_found(
    size: int, turn: int, mirrored: bool, portrait: np.ndarray, search: FaceSearch
) -> None:
    """A face of a photograph, wherever it is."""
    picture = seen_from(portrait, (320, 240), (160, 110), size, turn, mirrored=mirrored)
    found = search.everywhere(picture, OPENING)
    near = [face for c, face in found if c >= SURE and np.hypot(*(face.middle - (160, 110))) < size]
    assert near
    assert near[0].size == pytest.approx(size, rel=0.3)


@pytest.mark.parametrize(("size", "turn"), [(40, -60), (40, -90), (80, 90), (150, -60)])
def test_faces_that_lie_are_found(
    size: int, turn: int, portrait: np.ndarray, search: FaceSearch
) -> None:
    """With their eyes where they are, though the network tells those of turned faces wrong."""
    picture = seen_from(portrait, (320, 240), (160, 110), size, turn)
    certainty, face = min(  # the border mirrors another one
        search.everywhere(picture, OPENING),
        key=lambda entry: float(np.hypot(*(entry[1].middle - (160, 110)))),
    )
    assert certainty >= SURE
    across = face.places[2] - face.places[1]
    told = np.degrees(np.arctan2(-across[1], across[0]))
    assert told == pytest.approx(turn, abs=20)


@pytest.mark.parametrize("kind", ["noise", "flat", "squares", "clouds"])
def test_nothing_is_no_face(kind: str, search: FaceSearch) -> None:
    """Noise, plain grey, drawn shapes and soft blobs."""
    rng = np.random.default_rng(5)
    pictures = {
        "noise": rng.integers(0, 256, (200, 300, 3)),
        "flat": np.full((200, 300, 3), 90),
        "squares": samples.chart(300, 200),
        "clouds": cv2.resize(rng.integers(0, 256, (20, 30, 3)).astype(np.uint8), (300, 200)),
    }
    assert not search.everywhere(pictures[kind].astype(np.uint8), OPENING)


def test_search_does_not_depend_on_threads(portrait: np.ndarray, search: FaceSearch) -> None:
    """The same places to the bit, whatever OpenCV does with its threads."""
    found = []
    before = cv2.getNumThreads()
    try:
        for threads in (1, 2, 3):
            cv2.setNumThreads(threads)
            found.append(search.everywhere(portrait, OPENING)[0])
    finally:
        cv2.setNumThreads(before)
    for certainty, face in found:
        assert certainty == found[0][0]
        np.testing.assert_array_equal(face.places, found[0][1].places)


def test_without_a_face_all_is_as_without_focus(tmp_path: Path) -> None:
    """The same bits, frame by frame, and a note that tells why."""
    pictures = [samples.picture(96, 64, number) for number in range(5)]
    clip = samples.write_video(tmp_path / "in.mp4", pictures)
    notes = solve_to(tmp_path / "auto.mtrk", clip).notes
    assert "--focus auto: no face found" in notes
    for name, focus in (("none", NoFocus()), ("zero", Faces(strength=0.0))):
        told = solve_to(tmp_path / f"{name}.mtrk", clip, focus=(focus,)).notes
        assert not any("--focus" in note for note in told)
        assert rows_of(tmp_path / f"{name}.mtrk") == rows_of(tmp_path / "auto.mtrk")


def test_strength_zero_is_none_with_a_face(clip: Path, whole: Path, tmp_path: Path) -> None:
    """Nothing is added, so nothing changes; with a face it does."""
    tracks = {"none": NoFocus(), "zero": Auto(strength=0.0)}
    for name, focus in tracks.items():
        solve_to(tmp_path / f"{name}.mtrk", clip, "0-3", focus=(focus,))
    none, zero = (rows_of(tmp_path / f"{name}.mtrk") for name in tracks)
    assert none == zero
    assert none["meshes"][0] != rows_of(whole)["meshes"][0]


def test_face_is_drawn_better_and_told_honestly(portrait: np.ndarray, tmp_path: Path) -> None:
    """The face gains, the rest loses little, and the rmse that is told is that of all pixels."""
    errors, told = {}, {}
    wanted = replace(QUICK, iterations=120, refine=replace(QUICK.refine, triangles=400))
    for name, focus in (("none", NoFocus()), ("auto", Auto())):
        output = tmp_path / f"{name}.png"
        job = job_of(PORTRAIT, output, triangulate=wanted, focus=(focus,))
        told[name] = animate(job, Progress()).mean_rmse
        with open_decoder(output) as decoder:
            squares = (next(decoder).pixels.astype(float) - portrait) ** 2
        errors[name] = np.sqrt([squares[73:184, 170:281].mean(), squares.mean()])
    assert errors["auto"][0] < 0.8 * errors["none"][0]
    assert errors["auto"][1] < 1.08 * errors["none"][1]
    for name in told:
        assert told[name] == pytest.approx(errors[name][1], rel=0.1)


def test_ranges_resume_and_jobs_are_the_whole(clip: Path, whole: Path, tmp_path: Path) -> None:
    """A shot alone, a run that goes on inside a shot, and two processes: the same bits."""
    rows = rows_of(whole)
    assert [row[2] for row in rows["frames"]] == [0] * CUT + [CUT] * (COUNT - CUT)
    alone = tmp_path / "alone.mtrk"
    solve_to(alone, clip, f"{CUT}-")
    assert rows_of(alone)["meshes"] == rows["meshes"][CUT:]
    for last in (SPACING, CUT + 5):  # at a search for faces, and between two of the second shot
        track = tmp_path / f"{last}.mtrk"
        solve_to(track, clip, f"0-{last}")
        assert rows_of(track)["meshes"] == rows["meshes"][: last + 1]
        solve_to(track, clip, resume=True)
        assert rows_of(track) == rows
    job = job_of(clip, track=tmp_path / "j.mtrk", triangulate=QUICK)
    solve(job.solve, job.output, job.run, Progress(), runner=InTurn())
    assert rows_of(tmp_path / "j.mtrk")["meshes"] == rows["meshes"]


def test_track_tells_its_focus(whole: Path, clip: Path, tmp_path: Path, capsys) -> None:
    """`info` names it, a resume with another one is refused, and old tracks had none."""
    assert main(["info", str(whole)]) == 0
    assert "focus      auto" in capsys.readouterr().out
    track = tmp_path / "t.mtrk"
    solve_to(track, clip, "0-2")
    with pytest.raises(OptionError, match="--focus"):
        solve_to(track, clip, resume=True, focus=(NoFocus(),))
    with TrackReader(track) as reader:
        options = dict(reader.header.options)
    del options["focus"]
    assert from_plain(SolveOptions, options).foci == (Auto(),)  # so a header has to say it
    forget_focus(track)
    with TrackReader(track) as reader:
        assert reader.header.solve.foci == ()


def forget_focus(track: Path) -> None:
    """Make a track one of those from before there was a focus."""
    connection = sqlite3.connect(track)
    with connection:
        (text,) = connection.execute("SELECT value FROM header WHERE key = 'options'").fetchone()
        options = json.loads(text)
        del options["focus"]
        text = json.dumps(options)
        connection.execute("UPDATE header SET value = ? WHERE key = 'options'", [text])
    connection.close()


def test_weights_follow_and_never_switch(portrait: np.ndarray) -> None:
    """A face that wanders is covered in every frame; one that is hidden fades; no step is large."""
    size = (160, 120)
    pictures = [seen_from(portrait, size, (60 + n, 55), 45) for n in range(40)]
    for hidden in pictures[20:28]:
        hidden[20:95] = 90
    weights = weights_of(pictures)
    for n in range(20):
        assert weights[n][55, 60 + n] > 4
        assert weights[n][110, 5] == 1
    assert weights[26].max() < weights[20].max()
    steps = [np.abs(b - a).max() for a, b in pairwise(weights)]
    assert max(steps) < 0.5 * max(one.max() - 1 for one in weights)


def test_small_faces_keep_their_strength(portrait: np.ndarray) -> None:
    """What a face adds does not depend on its size, and ends without a step."""
    places = np.array([[50.0, 50.0], [45.0, 45.0], [55.0, 45.0], [50.0, 58.0]])
    for scale in (0.4, 1.0, 8.0):
        added = emphasis([Face(scale * places, scale * 25)], (int(scale * 100),) * 2)
        assert 9 < added.max() < 14
        assert added[0].max() == added[-1].max() == added[:, 0].max() == 0
        assert np.abs(np.diff(added, axis=0)).max() < 0.6 * added.max()
    assert not emphasis([Face(places + 1000, 25)], (100, 100)).any()
    assert emphasis([Face(places, 25, share=0.5)], (100, 100)).max() < 7


def test_faces_of_many_triangles_count_more() -> None:
    """They are harder to better, and their eyes need no more help; few triangles change nothing."""
    places = np.array([[50.0, 50.0], [40.0, 42.0], [60.0, 42.0], [50.0, 64.0]])
    face, size = Face(places, 50), (100, 100)
    coarse, fine, finest = (emphasis([face], size, area) for area in (63.0, 20.0, 1.0))
    np.testing.assert_array_equal(coarse, emphasis([face], size))
    cheek, eye = (62, 32), (42, 40)
    assert coarse[cheek] < fine[cheek] < finest[cheek] < 2.1 * coarse[cheek]
    assert finest[eye] - finest[cheek] < coarse[eye] - coarse[cheek]


@pytest.mark.parametrize("heavy", [0.01, 0.2, 0.6])
def test_light_places_are_firm_and_heavy_ones_as_ever(heavy: float) -> None:
    """The more triangles weights lead elsewhere, the firmer is what is left."""
    weights = np.full((100, 100), UNIT, np.uint8)
    weights[: round(100 * heavy)] = 10 * UNIT
    mesh = grid_mesh(100, 100, 200)
    seed = Carried(mesh, np.ones(mesh.vertex_count, np.float32))
    strengths = springs_of(mesh, seed, 3.0, weights)[:, 2]
    rows = np.clip(mesh.vertices[:, 1].astype(int), 0, 99)
    is_heavy = weights[rows, 0] > UNIT
    np.testing.assert_allclose(strengths[is_heavy], 3.0)
    rest = strengths[~is_heavy]
    assert np.ptp(rest) == 0
    assert rest[0] == 3.0 if heavy > 0.5 else 3.0 < rest[0] <= 3.0 * FIRMEST


@dataclass
class FickleSearch:
    """Finds faces that come and go by chance, the same in the same frame; remembers nothing."""

    looks: list[int] = field(default_factory=list)

    def everywhere(self, pixels: np.ndarray, most: float) -> list[tuple[float, Face]]:
        """Some faces, more of them in a thorough search."""
        rng = np.random.default_rng([int(pixels[0, 0, 0]), int(pixels[0, 0, 1]), int(most)])
        self.looks.append(int(most))
        count = rng.integers(0, 3) if most == OPENING else rng.integers(0, 2)
        return [(rng.uniform(0.5, 0.9), self._face(rng)) for _ in range(count)]

    def near(self, pixels: np.ndarray, face: Face) -> Face | None:
        """The face, moved a little, or nothing."""
        seed = [*pixels[0, 0].tolist(), *np.round(face.places.reshape(-1) * 100).astype(int) % 9973]
        rng = np.random.default_rng(seed)
        if rng.random() < 0.25:
            return None
        return replace(face, places=face.places + rng.uniform(-2, 2, 2), share=1.0)

    def _face(self, rng: np.random.Generator) -> Face:
        middle = rng.uniform(20, 80, 2)
        return Face(middle + np.array([[0, 0], [-4, -4], [4, -4], [0, 6]]), rng.uniform(14, 30))


def numbered(first: int, last: int) -> list[Frame]:
    """Frames whose pixels tell their number."""
    frames = []
    for n in range(first, last):
        pixels = np.zeros((4, 4, 3), np.uint8)
        pixels[0, 0] = (n % 256, n // 256, 7)
        frames.append(Frame(n, n, Fraction(1, 25), pixels))
    return frames


def tracked(first: int, last: int, step: int = 1) -> dict[int, np.ndarray | None]:
    """What the faces of a shot add, by frame."""
    tracks = FaceTracks(FickleSearch(), (100, 100), 50.0, step, is_still=False)
    frames = numbered(first, last)
    for frame in frames:
        tracks.see(frame, is_last=frame is frames[-1])
    return {frame.index: tracks.added(frame.index) for frame in frames}


def test_what_lies_far_back_does_not_matter() -> None:
    """Begun anywhere in a shot, after `MEMORY` frames all is as in the whole shot, to the bit."""
    end = 2 * MEMORY + 150
    known = tracked(0, end)
    carried = 0
    for start in (3, 97, MEMORY + 5):
        again = tracked(start, end)
        for index in range(start + MEMORY, end):
            one, other = known[index], again[index]
            assert (one is None) == (other is None)
            if one is not None:
                np.testing.assert_array_equal(one, other)
                carried += 1
    assert carried > 100
    assert CARRIED * SPACING < MEMORY


@dataclass
class ToldSearch:
    """Sees at each search what it was told to, and nothing between."""

    told: list[list[tuple[float, Face]]]

    def everywhere(self, pixels: np.ndarray, most: float) -> list[tuple[float, Face]]:
        """What comes next."""
        return self.told.pop(0)

    def near(self, pixels: np.ndarray, face: Face) -> Face | None:
        """Always where it was."""
        return face


@pytest.mark.parametrize(
    ("told", "seen_from"),
    [
        ([[0.74], [0.74], []], 5),
        ([[0.74], [], [0.74]], None),
        ([[0.6], [0.74], [0.6]], None),
        ([[0.9], [], []], 0),
        ([[], [0.9], []], 5),
    ],
)
def test_what_is_hardly_a_face_must_be_seen_twice(told: list, seen_from: int | None) -> None:
    """A score that stays is a face, one that flashes is none."""
    face = Face(np.array([[40, 40], [36, 36], [44, 36], [40, 46]], float), 20.0)
    search = ToldSearch([[(score, face) for score in scores] for scores in told])
    tracks = FaceTracks(search, (100, 100), 50.0, 1, is_still=False)
    frames = numbered(0, 2 * SEARCHED + 1)
    for frame in frames:
        tracks.see(frame, is_last=frame is frames[-1])
    weighed = [frame.index for frame in frames if tracks.added(frame.index) is not None]
    assert weighed == ([] if seen_from is None else list(range(seen_from, 2 * SEARCHED + 1)))


def test_maps_are_smoothed_over_their_window(portrait: np.ndarray) -> None:
    """A map depends on the frames around its own alone, and swells and fades around a flash."""
    pictures = [np.full((40, 60, 3), 90, np.uint8) for _ in range(30)]
    pictures[14][10:30, 20:40] = 250
    for name in ("saliency", "motion"):
        member = FOCI[name]()
        weights = weights_of(pictures, member)
        heights = np.array([one.max() for one in weights])
        assert heights[14] > 1.2
        assert (heights[: 14 - WINDOW - 1] == 1).all()
        assert (heights[15 + WINDOW + 1 :] == 1).all()
        before, _ = reach_of([member])
        later = weights_of(pictures[5:], member, first=5)
        for n in range(5 + before, 30):
            np.testing.assert_array_equal(weights[n], later[n - 5])


def test_motion_tells_what_moves_against_the_whole() -> None:
    """A square that wanders over a ground that pans the other way."""
    rng = np.random.default_rng(1)
    ground = cv2.GaussianBlur(rng.integers(0, 256, (120, 260, 3)).astype(np.uint8), (0, 0), 2)
    thing = cv2.GaussianBlur(rng.integers(0, 256, (30, 30, 3)).astype(np.uint8), (0, 0), 1.5)
    pictures = []
    for n in range(4):
        picture = ground[:, 3 * n : 3 * n + 160].copy()
        picture[45:75, 60 + 2 * n : 90 + 2 * n] = thing
        pictures.append(picture)
    weights = weights_of(pictures, FOCI["motion"]())[2]
    assert weights[60, 78] > 3
    assert np.median(weights) < 1.3


def test_several_add_up_and_a_picture_multiplies(portrait: np.ndarray, tmp_path: Path) -> None:
    """The sum of what members add; a map of the user's is a factor."""
    pictures = [seen_from(portrait, (160, 120), (60, 55), 45)]
    face, middle = weights_of(pictures, Faces())[0], weights_of(pictures, Center())[0]
    both = weights_of(pictures, Faces(), Center())[0]
    np.testing.assert_allclose(both, face + middle - 1, atol=1.01 / UNIT)
    half = weights_of(pictures, Faces(strength=0.5))[0]
    np.testing.assert_allclose(half - 1, 0.5 * (face - 1), atol=1.01 / UNIT)
    still = samples.write_still(tmp_path / "in.png", pictures[0])
    grey = samples.write_still(tmp_path / "map.png", np.full((120, 160, 3), 255, np.uint8))
    solve_to(tmp_path / "a.mtrk", still)
    solve_to(tmp_path / "b.mtrk", still, focus=(Auto(), Picture(str(grey))))
    assert rows_of(tmp_path / "a.mtrk") == rows_of(tmp_path / "b.mtrk")


def test_weights_map_is_the_picture(portrait: np.ndarray, tmp_path: Path) -> None:
    """`--weights MAP` and `--focus picture:MAP` are the same."""
    grey = np.repeat(np.linspace(0, 255, 160).astype(np.uint8)[None, :, None], 120, 0).repeat(3, 2)
    path = str(samples.write_still(tmp_path / "map.png", grey))
    still = samples.write_still(tmp_path / "in.png", samples.picture(160, 120))
    solve_to(tmp_path / "a.mtrk", still, weights=path)
    solve_to(tmp_path / "b.mtrk", still, focus=(Picture(path),))
    assert rows_of(tmp_path / "a.mtrk") == rows_of(tmp_path / "b.mtrk")


def test_modes_take_turns_without_a_trace(device: str) -> None:
    """A frame without weights between two with some gives the bits of one that never had any."""
    picture = samples.picture(64, 48)
    plain = frame_of(picture, 0)
    even = replace(plain, weights=np.full((48, 64), 8, np.uint8))
    heavy = replace(plain, weights=np.arange(48 * 64).reshape(48, 64).astype(np.uint8) % 200 + 1)
    triangulator = Triangulator(Device(device), (64, 48), QUICK)

    def solved(frame: Frame) -> np.ndarray:
        """Vertices of a frame."""
        return triangulator.first(frame, Importance(), np.random.default_rng(3)).mesh.vertices

    first, weighted, again, ones = (solved(f) for f in (plain, heavy, plain, even))
    np.testing.assert_array_equal(first, again)
    np.testing.assert_array_equal(first, ones)
    assert first.shape != weighted.shape or (first != weighted).any()
