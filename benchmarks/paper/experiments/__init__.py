"""The experiments: `EXPERIMENTS` names them for the command line.

An experiment is a frozen dataclass of parameters with one method `run(study) -> Section`; a new one
is a file and a line here.
"""

from typing import Protocol

from benchmarks.paper.experiments.accumulation import Accumulation
from benchmarks.paper.experiments.convergence import Convergence
from benchmarks.paper.experiments.paper_method import PaperMethod
from benchmarks.paper.experiments.random_starts import RandomStarts
from benchmarks.paper.experiments.regularity import Regularity
from benchmarks.paper.experiments.related_tools import RelatedTools
from benchmarks.paper.experiments.start_layout import StartLayout
from benchmarks.paper.experiments.step_times import StepTimes
from benchmarks.paper.experiments.thresholds import Thresholds
from benchmarks.paper.page import Section
from benchmarks.paper.study import Study


class Experiment(Protocol):
    """What every member of `EXPERIMENTS` can do."""

    def run(self, study: Study) -> Section:
        """Do the experiment and write its plots."""
        ...


EXPERIMENTS: dict[str, type[Experiment]] = {
    "fig3": StartLayout,
    "fig4": Thresholds,
    # before fig8, which solves the same: times are compared, so both solve by turns
    "method": PaperMethod,
    "fig8": RelatedTools,
    "fig9": RandomStarts,
    "fig10": Regularity,
    "fig12": Convergence,
    "fig13": StepTimes,
    "sec65": Accumulation,
}
