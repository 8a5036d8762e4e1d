"""Videos and pictures as coherent triangles: trimotion for Python programs.

    import trimotion

    trimotion.animate("clip.mp4", "triangles.mp4", triangles=3000, styles=["flat", "edges"])
    picture = trimotion.triangulate(pixels, triangles=700)     # an array [H, W, 3] uint8

Whatever the command line can do is a keyword of the same name: `--max-area 900` is `max_area=900`;
what can be repeated is a list, `styles=[...]`; `--no-audio` is `audio=False`. Errors are
`TrimotionError`s of one line that ends with a remedy. `docs/python.md` shows all of it.

This is the only public face. What it names is imported when it is first used.
"""

from importlib import import_module

TYPE_CHECKING = False
if TYPE_CHECKING:
    from pipeline.compare.report import Report as Report
    from pipeline.library.animator import Animator as Animator
    from pipeline.library.keywords import AnimateKeywords as AnimateKeywords
    from pipeline.library.keywords import AnimatorKeywords as AnimatorKeywords
    from pipeline.library.keywords import PictureKeywords as PictureKeywords
    from pipeline.library.keywords import RenderKeywords as RenderKeywords
    from pipeline.library.keywords import SolveKeywords as SolveKeywords
    from pipeline.library.progress import FrameDone as FrameDone
    from pipeline.library.result import Result as Result
    from pipeline.library.runs import animate as animate
    from pipeline.library.runs import measure as measure
    from pipeline.library.runs import render as render
    from pipeline.library.runs import solve as solve
    from pipeline.library.track import Track as Track
    from pipeline.library.track import open_track as open_track
    from pipeline.library.triangulate import triangulate as triangulate
    from pipeline.library.triangulation import Triangulation as Triangulation
    from warp_kernels.errors import MediaError as MediaError
    from warp_kernels.errors import OptionError as OptionError
    from warp_kernels.errors import OutputError as OutputError
    from warp_kernels.errors import TrackError as TrackError
    from warp_kernels.errors import TrimotionError as TrimotionError

    __version__: str

_HOMES = {
    "pipeline.library.animator": ("Animator",),
    "pipeline.library.keywords": (
        "AnimateKeywords",
        "AnimatorKeywords",
        "PictureKeywords",
        "RenderKeywords",
        "SolveKeywords",
    ),
    "pipeline.library.result": ("Result",),
    "pipeline.library.runs": ("animate", "measure", "render", "solve"),
    "pipeline.library.progress": ("FrameDone",),
    "pipeline.library.track": ("Track", "open_track"),
    "pipeline.library.triangulate": ("triangulate",),
    "pipeline.library.triangulation": ("Triangulation",),
    "pipeline.compare.report": ("Report",),
    "warp_kernels.errors": (
        "MediaError",
        "OptionError",
        "OutputError",
        "TrackError",
        "TrimotionError",
    ),
}
"""Where the public names live."""

__all__ = sorted(name for names in _HOMES.values() for name in names)


def __getattr__(name: str) -> object:
    """Import a public name when it is first asked for."""
    if name == "__version__":
        return import_module("pipeline.version").program_version()
    for module, names in _HOMES.items():
        if name in names:
            value = getattr(import_module(module), name)
            globals()[name] = value
            return value
    raise AttributeError(f"module 'trimotion' has no attribute {name!r}")


def __dir__() -> list[str]:
    return sorted([*globals(), *__all__, "__version__"])
