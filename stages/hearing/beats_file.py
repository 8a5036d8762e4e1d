"""Files of beats: read whatever program wrote them, and written."""

from fractions import Fraction
from pathlib import Path

from stages.hearing.formats.edl import from_edl
from stages.hearing.formats.json_form import as_json, from_json
from stages.hearing.formats.lines import as_labels, from_lines
from stages.hearing.formats.midi import from_midi
from stages.hearing.heard import Heard
from stages.media.text_file import bounded_bytes, text_of
from stages.media.writing.commit import write_file
from warp_kernels.errors import MediaError

_REMEDY = (
    "give the JSON of trimotion listen, one time a line, labels of Audacity, CSV, MIDI or an EDL"
)


def read_beats(path: Path, rate: Fraction | None = None) -> Heard:
    """Read beats, bars and sections; what the file holds decides how, not its name.

    Args:
        path: JSON of `listen`, times as text or CSV, labels of Audacity, MIDI, or an EDL.
        rate: Frames a second of the film, in which an EDL counts; None if there is none.

    Raises:
        MediaError: If it cannot be read or is none of these.
    """
    try:
        content = bounded_bytes(path)
        if content.startswith(b"MThd"):
            return from_midi(content)
        text = text_of(content)
        if text.lstrip().startswith(("{", "[")):
            return from_json(text)
        if path.suffix.lower() == ".edl" or text.lstrip().startswith("TITLE:"):
            return from_edl(text, rate)
        return from_lines(text)
    except OSError as error:
        reason = str(error.strerror or error).lower()
        raise MediaError(path, f"the beats cannot be read ({reason})", "check the name") from error
    except ValueError as error:  # also of decoding
        raise MediaError(path, f"is no file of beats ({error})", _REMEDY) from error


def write_beats(heard: Heard, path: Path) -> None:
    """Write all that was heard as JSON, which `read_beats` reads.

    Args:
        heard: What was heard.
        path: The file; replaced if it is there.

    Raises:
        OutputError: If it cannot be written.
    """
    write_file(path, as_json(heard).encode())


def write_labels(heard: Heard, path: Path) -> None:
    """Write beats and sections as labels of Audacity, which `read_beats` reads.

    Args:
        heard: What was heard.
        path: The file; replaced if it is there.

    Raises:
        OutputError: If it cannot be written.
    """
    write_file(path, as_labels(heard).encode())
