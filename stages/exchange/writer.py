"""Files of shapes that appear under their names only when they are complete."""

from contextlib import suppress
from pathlib import Path

from stages.exchange import format_of
from stages.exchange.figure import Figure
from stages.exchange.film import Film
from stages.exchange.format import Format
from stages.media.writing.commit import PendingFile, output_error
from stages.media.writing.output_plan import OutputPlan
from warp_kernels.errors import OutputError


class ShapeWriter:
    """Writes frames as shapes: all to one file, or each to one of its own.

    Args:
        plan: The checked output.
        film: What all frames have in common; it was checked.
    """

    def __init__(self, plan: OutputPlan, film: Film) -> None:
        self._plan = plan
        self._film = film
        self._format = format_of(plan.path)
        self._one: Format | None = None
        self._told: list[str] = []
        self._count = 0

    @property
    def notes(self) -> list[str]:
        """Choices that were made, one sentence each; complete after `close`."""
        return [*self._plan.notes, *dict.fromkeys(self._told)]

    def write(self, figure: Figure) -> None:
        """Take a frame.

        Args:
            figure: The frame.

        Raises:
            OutputError: If it cannot be written.
        """
        self._count += 1
        if self._plan.pattern is not None:
            one = self._format(self._film)
            one.add(figure)
            self._save(one, self._plan.pattern.path_for(figure.index))
            return
        if self._one is None:
            self._one = self._format(self._film)
        self._one.add(figure)

    def close(self) -> None:
        """Write what is not written yet.

        Raises:
            OutputError: If it cannot be, or there was no frame.
        """
        if self._count == 0:
            raise OutputError(self._plan.path, "no frame was written", "check the frame range")
        if self._one is not None:
            self._save(self._one, self._plan.path)

    def _save(self, one: Format, target: Path) -> None:
        # libraries choose a format by the ending, so the temporary name has it as well
        pending = PendingFile(target)
        part = pending.path.with_suffix(f".part{self._film.ending}")
        pending.path = part
        try:
            one.save(part)
        except OSError as error:
            pending.discard()
            raise output_error(target, error) from error
        except BaseException:
            with suppress(OSError):
                pending.discard()
            raise
        pending.commit()
        self._told += one.notes
