"""What a window may ask for, by name."""

from collections.abc import Awaitable, Callable
from functools import partial
from typing import TYPE_CHECKING, Any

from pipeline.edit_log.json_lines import log_of
from pipeline.editor.bench.command_lines import render_line, solve_line
from pipeline.editor.bench.easel import MOST_ACROSS, look_of
from pipeline.editor.bench.errands import beside
from pipeline.editor.bench.long_work import Applying, Rendering
from pipeline.editor.bench.session import LIVE, VIEWS
from pipeline.editor.bench.sketch import Sketch, drawing_of, embedded_drawing, keep_drawing
from pipeline.editor.wire.asked import Asked, AskError
from pipeline.editor.wire.packed import packed_pixels
from stages.hand import Edit

if TYPE_CHECKING:
    from pipeline.editor.serving.window import Window

Reply = dict[str, Any]
MOST_EDITS = 1_000
"""Edits of one message."""
MOST_STEPS = 1_000_000
"""Steps that the optimiser takes while nobody stops it."""
LEAST_ACROSS = 64
"""Narrowest picture that is drawn [px]."""
MOST_STYLES = 16
"""Styles over one another."""


async def hello(window: "Window", asked: Asked) -> Reply:
    """All that does not change, and the state."""
    studio = window.studio
    state = await studio.do(studio.session.state)
    return {"facts": await studio.do(studio.facts), "state": state}


async def look_at(window: "Window", asked: Asked) -> Reply:
    """Show a frame, or parts of what is to be seen of it."""
    frame, view = asked.whole("frame"), asked.text("view", window.view)
    parts = asked.items("parts", ["picture", "mesh", "drawn"])
    across = max(LEAST_ACROSS, asked.whole("across", MOST_ACROSS))
    if view not in VIEWS:
        raise AskError(f"look: it needs view, one of {', '.join(VIEWS)}")
    if frame not in window.studio.session.film:
        await window.studio.do(window.studio.session.picture, frame)  # says what is there
    window.optimise({}, steps=0)
    window.frame, window.view = frame, view
    shows: dict[str, Callable[[], Awaitable[None]]] = {
        "picture": window.show_picture,
        "mesh": window.show_mesh,
        "drawn": partial(window.show_drawn, at_once=True, across=across),
    }
    for part in shows.keys() & set(map(str, parts)):
        await shows[part]()
    return {}


async def thumbnail(window: "Window", asked: Asked) -> Reply:
    """A frame in small."""
    frame = asked.whole("frame")
    pixels = await window.studio.do(window.studio.session.thumbnail, frame)
    window.show(f"thumb {frame}", packed_pixels({"kind": "thumb", "frame": frame}, pixels))
    return {}


async def apply(window: "Window", asked: Asked) -> Reply:
    """Solve a shot again, or all that wait for it, with the edits in force."""
    session = window.studio.session
    log = await window.studio.do(lambda: session.log)
    pending = session.film.pending(log)
    if "frame" in asked.values:
        frame = asked.whole("frame")
        pending = [shots for shots in session.film.shots if shots.first <= frame <= shots.last]
    window.studio.begin(Applying(session, pending, log))
    return {}


async def render_film(window: "Window", asked: Asked) -> Reply:
    """Draw the film to a file beside the track."""
    session = window.studio.session
    output = beside(session.path, asked.text("name"))
    window.studio.begin(Rendering(session, window.look, output))
    return {"path": str(output.resolve())}


async def cancel(window: "Window", asked: Asked) -> Reply:
    """End the long work."""
    window.studio.cancel()
    return {}


async def export(window: "Window", asked: Asked) -> Reply:
    """Write the frame, as it is drawn, to a file beside the track."""
    session = window.studio.session
    output = beside(session.path, asked.text("name"))
    await window.studio.do(session.export, window.frame, window.look, output, window.view)
    return {"path": str(output.resolve())}


async def optimise(window: "Window", asked: Asked) -> Reply:
    """Take steps of the optimiser, or let it rest."""
    names = ("triangles", "error", "regularity", "trust_region")
    course = {name: asked.real(name) for name in names if name in asked.values}
    what = asked.text("do")
    if what == "begin":
        window.studio.session.live = None
    window.optimise(course, steps={"step": 1, "play": MOST_STEPS}.get(what, 0))
    return {}


async def style(window: "Window", asked: Asked) -> Reply:
    """Draw in a stack of styles."""
    specs = asked.items("styles")
    if len(specs) > MOST_STYLES or not all(isinstance(spec, str) for spec in specs):
        raise AskError(f"style: it needs styles, up to {MOST_STYLES} texts")
    window.look = await window.studio.do(look_of, specs)
    window.styles = specs
    window.want_drawn()
    return {}


async def sketch(window: "Window", asked: Asked) -> Reply:
    """Show a texture on all triangles, as it is being drawn; without one, show none any more."""
    drawing = drawing_of(asked.text("drawing")) if "drawing" in asked.values else b""
    window.sketch = None
    if drawing or "file" in asked.values:
        window.sketch = Sketch(
            file=asked.text("file", "drawing"),
            strength=asked.real("strength", 1.0),
            opacity=asked.real("opacity", 1.0),
            drawing=drawing,
        )
    window.want_drawn()
    return {}


async def keep(window: "Window", asked: Asked) -> Reply:
    """A texture that was drawn, for edits as a text that holds it, for styles as a file."""
    drawing = drawing_of(asked.text("drawing"))
    if asked.text("for", "edits") == "edits":
        return {"file": await window.studio.do(embedded_drawing, drawing)}
    track = window.studio.session.path
    return {"file": str(await window.studio.do(keep_drawing, drawing, track))}


async def edit(window: "Window", asked: Asked) -> Reply:
    """Make edits."""
    session = window.studio.session
    after = asked.whole("after") if "after" in asked.values else None
    in_live = window.view == LIVE
    number = await window.studio.do(session.make, _edits(asked), after, in_live=in_live)
    await window.studio.changed()
    return {"number": number}


async def ghost(window: "Window", asked: Asked) -> Reply:
    """Where an edit would put vertices, and which would go."""
    (edit,) = _edits(asked)[:1]
    session, in_live = window.studio.session, window.view == LIVE
    found = await window.studio.do(session.ghost, edit, in_live=in_live)
    return {"fresh": found.fresh.tolist(), "gone": found.gone.tolist()}


async def undo(window: "Window", asked: Asked) -> Reply:
    """Undo the last edit."""
    return await _turned(window, await window.studio.do(window.studio.session.undo))


async def redo(window: "Window", asked: Asked) -> Reply:
    """Redo the edit that was undone last."""
    return await _turned(window, await window.studio.do(window.studio.session.redo))


async def commands(window: "Window", asked: Asked) -> Reply:
    """What to type to make the same without the editor."""
    session, styles = window.studio.session, window.styles
    track = session.path.with_name(f"{session.path.stem}.edited{session.path.suffix}")
    output = track.with_suffix(".png" if session.info.kind == "image" else ".mp4")
    lines = [solve_line(session.path, session.options), render_line(track, output, styles)]
    return {"lines": lines}


async def _turned(window: "Window", edit: Edit | None) -> Reply:
    if edit is None:
        return {"frame": None}
    await window.studio.changed()
    return {"frame": edit.frame}


def _edits(asked: Asked) -> list[Edit]:
    """The edits of a message.

    Raises:
        AskError: If there is none, or too many.
        MediaError: If one is none.
    """
    given = asked.items("edits")
    if not 0 < len(given) <= MOST_EDITS:
        raise AskError(f"{asked.what}: it needs edits, from 1 to {MOST_EDITS}")
    return list(log_of(given).edits)


ANSWERS: dict[str, Callable[["Window", Asked], Awaitable[Reply]]] = {
    "hello": hello,
    "look": look_at,
    "thumbnail": thumbnail,
    "apply": apply,
    "render": render_film,
    "cancel": cancel,
    "export": export,
    "optimise": optimise,
    "style": style,
    "sketch": sketch,
    "keep": keep,
    "edit": edit,
    "ghost": ghost,
    "commands": commands,
    "undo": undo,
    "redo": redo,
}
"""What answers."""
