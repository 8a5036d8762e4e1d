"""All that a run from a source to a picture needs: a bundle of four kinds of options.

What needs one kind takes that one: a mesh does not depend on its look, a look on no file, and
nothing on the number of threads. The options of the command line are the fields of these
dataclasses, and of those inside them, that carry `help`: their defaults, help and choices stand
there and nowhere else. Metadata of a field:

    help       what it does; a field without is not an option
    choices    the values that it may have
    metavar    how its value is shown in the help
    flag       its name on the command line, if not its own name with dashes
    registry   the registry whose members it names
    group      the heading in the help, if not that of its dataclass
"""

from dataclasses import dataclass, field

from pipeline.options.look import Look
from pipeline.options.output import Output
from pipeline.options.run import Run
from pipeline.options.solve_options import SolveOptions
from warp_kernels.color_model import ColorModel


@dataclass(frozen=True)
class Job:
    """One run, checked and with every default filled in."""

    solve: SolveOptions
    """What decides the meshes."""
    look: Look = field(default_factory=Look)
    """What decides the pictures."""
    output: Output = field(default_factory=Output)
    """What is written."""
    run: Run = field(default_factory=Run)
    """What the work may use."""

    @property
    def fitted(self) -> ColorModel:
        """The colour model of the snapshots: the optimised one, or what the look needs beyond."""
        return self.look.fitted(self.solve.model)
