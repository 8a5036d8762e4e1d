"""Fig. 10: the weight of the regularity."""

from dataclasses import dataclass, replace

import numpy as np

from benchmarks.paper.methods import Method, ours
from benchmarks.paper.page import Section, picture
from benchmarks.paper.sheet import drawn, save_sheet
from benchmarks.paper.study import Study
from benchmarks.timing import table

HEADS = ("lambda", "rmse", "triangles", "smallest angle, median [deg]", "thinnest height [px]")


@dataclass(frozen=True)
class Regularity:
    """From no pull towards the ring's centre to a stiff mesh."""

    weights: tuple[float, ...] = (0.0, 1e-3, 1.0, 30.0, 1000.0)
    """Values of lambda [code value^2]."""
    triangles: int = 700

    def run(self, study: Study) -> Section:
        """Solve the first picture with every weight."""
        rows, cells = [], []
        for weight in self.weights:
            solution = study.triangulate(study.first, _with_weight(weight), self.triangles)
            mesh = solution.snapshot.mesh
            angle = np.median(smallest_angles(mesh.vertices[mesh.triangles]))
            rows.append(
                (
                    f"{weight:g}",
                    f"{solution.rmse:.2f}",
                    solution.triangles,
                    f"{angle:.1f}",
                    f"{mesh.heights.min():.2f}",
                )
            )
            caption = f"lambda {weight:g}\nrmse {solution.rmse:.2f}"
            cells.append((drawn(study, solution.snapshot, lines=True), caption))
        save_sheet(study.plots / "fig10.png", [cells])
        body = (
            f"{study.first}, {self.triangles} triangles, constant colours, `--regularity`.\n\n"
            f"{table(HEADS, rows)}\n\n{picture(study, 'fig10.png', 'from loose to stiff')}"
        )
        return Section("Fig. 10: regularity", body)


def _with_weight(weight: float) -> Method:
    """Ours with another lambda."""
    steps = replace(ours().options.optimize, regularity=weight)
    return ours().with_options(optimize=steps)


def smallest_angles(corners: np.ndarray) -> np.ndarray:
    """Smallest angle of every triangle [deg], [T], from corners [px], [T, 3, 2]."""
    ahead = np.roll(corners, -1, axis=1) - corners
    behind = np.roll(corners, 1, axis=1) - corners
    cross = ahead[..., 0] * behind[..., 1] - ahead[..., 1] * behind[..., 0]
    angles = np.arctan2(np.abs(cross), (ahead * behind).sum(axis=2))
    return np.degrees(angles.min(axis=1))
