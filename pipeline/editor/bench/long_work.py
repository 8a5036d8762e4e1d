"""The kinds of long work, each as what a window begins, sees and cancels."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Protocol

from pipeline.editor.bench.errands import Shots, Told, apply_edits, draw_film
from pipeline.editor.bench.session import Session
from pipeline.options.edit_log import EditLog
from pipeline.options.look import Look


class LongWork(Protocol):
    """Work that goes on beside editing, in a thread of its own."""

    changes: bool
    """Whether frames of the track are replaced by it."""

    @property
    def title(self) -> str:
        """What a window calls it."""
        ...

    def run(self, told: Told, is_cancelled: Callable[[], bool]) -> tuple[str, ...]:
        """Do it.

        Args:
            told: Told of every frame.
            is_cancelled: Asked at every frame.

        Returns:
            What is noteworthy, one sentence each.
        """
        ...


@dataclass(frozen=True, eq=False)
class Applying:
    """Shots are solved again with the edits in force."""

    session: Session
    """The job."""
    shots: list[Shots]
    """The shots."""
    log: EditLog
    """The edits in force when it begins."""
    changes = True

    @property
    def title(self) -> str:
        """What a window calls it."""
        if len(self.shots) == 1:
            one = self.shots[0]
            return f"Solving frames {one.first} to {one.last} with the edits"
        return f"Solving {len(self.shots)} shots with the edits"

    def run(self, told: Told, is_cancelled: Callable[[], bool]) -> tuple[str, ...]:
        """Solve one shot after the other; what is solved stays."""
        session, before = self.session, 0
        notes: tuple[str, ...] = ()
        total = sum(shots.last - shots.first + 1 for shots in self.shots)
        for shots in self.shots:
            begun = before

            def tell(done: int, _: int, begun: int = begun) -> None:
                """Count over all shots."""
                told(begun + done, total)

            given = session.path, session.options, session.run, shots, self.log
            notes += apply_edits(*given, tell, is_cancelled)
            before += shots.last - shots.first + 1
        return notes


@dataclass(frozen=True, eq=False)
class Rendering:
    """The film is drawn to a file."""

    session: Session
    """The job."""
    look: Look
    """How it is drawn."""
    output: Path
    """What is written."""
    changes = False

    @property
    def title(self) -> str:
        """What a window calls it."""
        return f"Rendering {self.output.name}"

    def run(self, told: Told, is_cancelled: Callable[[], bool]) -> tuple[str, ...]:
        """Draw it."""
        session = self.session
        given = session.path, session.options.source, self.look, self.output, session.run
        return draw_film(*given, told, is_cancelled)
