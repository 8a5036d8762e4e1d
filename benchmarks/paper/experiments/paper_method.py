"""Ours against the paper's own method: Delaunay topology with the paper's settings."""

from dataclasses import dataclass
from statistics import median

from benchmarks.paper.experiments.related_tools import COLORS
from benchmarks.paper.methods import PAPER_ITERATIONS, PAPER_STEPS, ours, papers
from benchmarks.paper.page import Check, Section
from benchmarks.paper.study import Study
from benchmarks.timing import table

HEADS = (
    "picture",
    "triangles",
    "the paper's",
    "ours",
    "gain",
    "the paper's [s]",
    "ours [s]",
    "times",
)
LEAST_GAIN = 0.12
"""Part by which the error is to be lower in the median."""
MOST_TIME = 2.0
"""Times the paper's time that ours may take in the median."""


@dataclass(frozen=True)
class PaperMethod:
    """Both solve the same pictures from the same first meshes, by turns."""

    def run(self, study: Study) -> Section:
        """Compare on every picture, with every number of triangles and both colour models."""
        parts = [
            f"The paper's: `--topology delaunay --iterations {PAPER_ITERATIONS} --trust-region "
            f"{PAPER_STEPS.trust_region:g} --regularity {PAPER_STEPS.regularity:g}`. Ours: the "
            "defaults. Both start from half the triangles, placed by importance. "
            "The gain is the part by which ours lowers the rmse."
        ]
        checks: list[Check] = []
        for color, label in COLORS.items():
            rows, gains, ratios = self._compare(study, color)
            parts += [f"{label.capitalize()}:", table(HEADS, rows)]
            parts.append(
                f"Median gain {median(gains):.1%}, least {min(gains):.1%}; "
                f"median time {median(ratios):.2f} of the paper's."
            )
            checks += _checks(label, gains, ratios)
        return Section("The paper's method: ours against it", "\n\n".join(parts), tuple(checks))

    def _compare(self, study: Study, color: str) -> tuple[list, list[float], list[float]]:
        """Rows of the table, gains, ratios of the times."""
        rows, gains, ratios = [], [], []
        for name in study.pictures:
            for count in study.counts:
                paper = study.solve(name, papers(color), count)
                own = study.solve(name, ours(color), count)
                gains.append(1 - own.rmse / paper.rmse)
                ratios.append(own.seconds / paper.seconds)
                figures = (f"{paper.rmse:.2f}", f"{own.rmse:.2f}", f"{gains[-1]:.1%}")
                times = (f"{paper.seconds:.2f}", f"{own.seconds:.2f}", f"{ratios[-1]:.2f}")
                rows.append((name, count, *figures, *times))
            study.say(f"  {name}, {color}: gain {gains[-1]:.1%}")
        return rows, gains, ratios


def _checks(label: str, gains: list[float], ratios: list[float]) -> list[Check]:
    lower = sum(gain > 0 for gain in gains)
    return [
        Check(
            f"ours below the paper's, {label}",
            f"on each; {LEAST_GAIN:.0%} in the median",
            f"{lower} of {len(gains)}; {median(gains):.1%}",
            lower == len(gains) and median(gains) >= LEAST_GAIN,
        ),
        Check(
            f"time beside the paper's, {label}",
            f"at most {MOST_TIME:g} times in the median",
            f"{median(ratios):.2f} times",
            median(ratios) <= MOST_TIME,
        ),
    ]
