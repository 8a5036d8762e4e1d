"""Fig. 12: how the error falls with the iterations."""

from dataclasses import dataclass

from benchmarks.paper.curves import Panel, save_curves
from benchmarks.paper.experiments.related_tools import COLORS
from benchmarks.paper.methods import BOTH
from benchmarks.paper.page import Section, picture
from benchmarks.paper.study import Solution, Study
from benchmarks.timing import table

MARKS = (50, 100, 200, 400, 600)
"""Iterations of the table."""
HEADS = ("picture", "colours", "method", *(f"after {mark}" for mark in MARKS))


@dataclass(frozen=True)
class Convergence:
    """Both methods for as many iterations as the paper, in both colour models."""

    triangles: int = 700
    shown: int = 2
    """Pictures that are looked at."""
    iterations: int = 600

    def run(self, study: Study) -> Section:
        """Watch the first pictures being solved."""
        rows, panels = [], []
        for name in list(study.pictures)[: self.shown]:
            for color, label in COLORS.items():
                lines = {}
                for method, make in BOTH:
                    settings = make(color).with_options(iterations=self.iterations)
                    solution = study.watch(name, settings, self.triangles)
                    lines[method] = (
                        [moment.iterations for moment in solution.moments],
                        [moment.rmse for moment in solution.moments],
                    )
                    figures = (f"{_error_after(solution, mark):.2f}" for mark in MARKS)
                    rows.append((name, label, method, *figures))
                panels.append(Panel(f"{name}, {label}", "iterations", "rmse", lines))
            study.say(f"  {name}")
        save_curves(study.plots / "fig12.png", panels)
        body = (
            f"rmse on the way to {self.triangles} triangles in {self.iterations} iterations. "
            "Triangles are added on the way, so early errors are those of fewer triangles.\n\n"
            f"{table(HEADS, rows)}\n\n{picture(study, 'fig12.png', 'rmse against iterations')}"
        )
        return Section("Fig. 12: convergence", body)


def _error_after(solution: Solution, mark: int) -> float:
    """The last rmse that was seen within a number of iterations."""
    within = [m.rmse for m in solution.moments if m.iterations <= mark]
    return within[-1] if within else solution.moments[0].rmse
