"""Fig. 8: side by side with the related tools at equal numbers of triangles."""

from dataclasses import dataclass
from statistics import median

import numpy as np

from benchmarks.paper.methods import ours
from benchmarks.paper.page import Check, Section, picture
from benchmarks.paper.related import RELATED
from benchmarks.paper.sheet import Cell, drawn, save_sheet
from benchmarks.paper.study import Study
from benchmarks.timing import table
from stages.mesh import Mesh

COLORS = {"constant": "flat", "linear": "gradient"}
"""Colour models and what they are called in tables."""
LEAST_GAIN = 0.25
"""Part by which the error is to be lower in the median."""
SUMMARY_HEADS = ("tool", "colours", "lower on", "least gain", "median gain", "at each count")


@dataclass(frozen=True)
class Case:
    """One picture at one number of triangles in one colour model."""

    color: str
    name: str
    count: int


@dataclass(frozen=True)
class RelatedTools:
    """Meshes of the related tools get the best colours that there are, as ours do."""

    sheet_count: int = 700
    """Triangles of the pictures on the sheets."""
    sheets: int = 3
    """Pictures that get a sheet."""

    def run(self, study: Study) -> Section:
        """Compare on every picture, with every number of triangles and both colour models."""
        meshes = self._meshes(study)
        errors: dict[Case, dict[str, float]] = {}
        for color in COLORS:
            for (name, count), by_tool in meshes.items():
                row = {tool: study.fit(name, mesh, color).rmse for tool, mesh in by_tool.items()}
                row["ours"] = study.solve(name, ours(color), count).rmse
                errors[Case(color, name, count)] = row
        summary, checks = _summary(study, errors)
        parts = [
            "Every tool is rebuilt from its published idea in `benchmarks/paper/related`, with "
            "the parameters that served it best in a search over a few photographs; its triangles "
            "get the colours of least error. *Greedy insertion, steepest pixel* is no one's tool: "
            "it strengthens the classic one for constant colours. The gain is the part by which "
            "ours lowers the rmse.",
            table(SUMMARY_HEADS, summary),
        ]
        for color, label in COLORS.items():
            parts += [f"rmse, {label}:", _error_table(errors, color)]
        for number, name in enumerate(list(study.pictures)[: self.sheets], start=1):
            self._draw(study, name, meshes[name, self._sheet_count(study)], number)
            parts.append(picture(study, f"fig8_{number}.png", f"{name}, all methods"))
        return Section("Fig. 8: related tools", "\n\n".join(parts), tuple(checks))

    def _sheet_count(self, study: Study) -> int:
        return min(study.counts, key=lambda count: abs(count - self.sheet_count))

    def _meshes(self, study: Study) -> dict[tuple[str, int], dict[str, Mesh]]:
        """Meshes of every tool by picture and number of triangles."""
        meshes = {}
        for name, pixels in study.pictures.items():
            for count in study.counts:
                meshes[name, count] = {
                    tool: layout().build(pixels, count, study.rng())
                    for tool, layout in RELATED.items()
                }
            study.say(f"  {name}: meshes of {len(RELATED)} tools")
        return meshes

    def _draw(self, study: Study, name: str, meshes: dict[str, Mesh], number: int) -> None:
        """One sheet: the picture, ours, the tools."""
        solution = study.solve(name, ours(), self._sheet_count(study))
        cells: list[Cell] = [(study.pictures[name], name)]
        shots = {"ours": solution.snapshot}
        shots |= {tool: study.fit(name, mesh, "constant") for tool, mesh in meshes.items()}
        for label, shot in shots.items():
            caption = f"{label}\n{shot.mesh.triangle_count} triangles, rmse {shot.rmse:.1f}"
            cells.append((drawn(study, shot), caption))
        path = study.plots / f"fig8_{number}.png"
        save_sheet(path, [cells[first : first + 5] for first in range(0, len(cells), 5)])


def _summary(study: Study, errors: dict[Case, dict[str, float]]) -> tuple[list, list[Check]]:
    """Rows of the summary, and a check for each tool and colour model."""
    rows, checks = [], []
    for tool in RELATED:
        for color, label in COLORS.items():
            cases = [case for case in errors if case.color == color]
            gains = {case: 1 - errors[case]["ours"] / errors[case][tool] for case in cases}
            middle = median(gains.values())
            lower = sum(gain > 0 for gain in gains.values())
            each = (
                f"{count}: {median(g for c, g in gains.items() if c.count == count):.0%}"
                for count in study.counts
            )
            least = min(gains.values())
            rows.append(
                (
                    tool,
                    label,
                    f"{lower} of {len(cases)}",
                    f"{least:.0%}",
                    f"{middle:.1%}",
                    ", ".join(each),
                )
            )
            checks.append(
                Check(
                    f"ours below {tool}, {label}",
                    f"on each; {LEAST_GAIN:.0%} in the median",
                    f"{lower} of {len(cases)}; {middle:.1%}",
                    lower == len(cases) and middle >= LEAST_GAIN,
                )
            )
    return rows, checks


def _error_table(errors: dict[Case, dict[str, float]], color: str) -> str:
    """The rmse of all methods, ours last."""
    cases = [case for case in errors if case.color == color]
    tools = list(errors[cases[0]])
    rows = [
        (case.name, case.count, *(f"{errors[case][tool]:.2f}" for tool in tools)) for case in cases
    ]
    best = [
        (
            "geometric mean",
            "",
            *(f"{_mean([errors[case][t] for case in cases]):.2f}" for t in tools),
        )
    ]
    return table(("picture", "triangles", *tools), rows + best)


def _mean(values: list[float]) -> float:
    return float(np.exp(np.mean(np.log(np.maximum(values, 1e-9)))))
