"""Fig. 4: refinement by a threshold of the triangles' error."""

from dataclasses import dataclass

from benchmarks.paper.labels import triangle_of_pixels
from benchmarks.paper.methods import BOTH
from benchmarks.paper.page import Section, picture
from benchmarks.paper.sheet import drawn, error_map, save_sheet
from benchmarks.paper.study import Study
from benchmarks.timing import table

HEADS = (
    "picture",
    "tau",
    *(f"{method}: {what}" for method, _ in BOTH for what in ("triangles", "rmse", "worst")),
)


@dataclass(frozen=True)
class Thresholds:
    """Triangles are split while sqrt(E(T) / |I|) exceeds tau."""

    taus: tuple[float, ...] = (4.0, 2.5, 1.5, 1.0)
    """Thresholds [code values]."""
    cap: int = 6000
    """Most triangles."""
    shown: int = 1
    """Pictures that are looked at."""

    def run(self, study: Study) -> Section:
        """Refine the first pictures down to every threshold."""
        rows, bands = [], ([], [])
        for name in list(study.pictures)[: self.shown]:
            for tau in self.taus:
                row = [name, f"{tau:g}"]
                for _, make in BOTH:
                    solution = study.triangulate(name, make(), self.cap, error=tau)
                    snapshot = solution.snapshot
                    pixels = snapshot.mesh.width * snapshot.mesh.height
                    worst = (snapshot.energies.max() / pixels) ** 0.5
                    row += [solution.triangles, f"{solution.rmse:.2f}", f"{worst:.2f}"]
                rows.append(row)
                if name == study.first:  # the last solution is ours
                    caption = (
                        f"tau {tau:g}: {solution.triangles} triangles\nrmse {solution.rmse:.1f}"
                    )
                    bands[0].append((drawn(study, snapshot), caption))
                    labels = triangle_of_pixels(study.device, snapshot.mesh)
                    bands[1].append((error_map(snapshot, labels, max(self.taus)), ""))
        save_sheet(study.plots / "fig4.png", bands)
        body = (
            f"`--error TAU`, constant colours, at most {self.cap} triangles. *worst* is the "
            "largest sqrt(E(T) / |I|) that is left [code values]; below, it is drawn from blue "
            f"(0) to red ({max(self.taus):g}).\n\n{table(HEADS, rows)}\n\n"
            f"{picture(study, 'fig4.png', 'triangulations and errors for four thresholds')}"
        )
        return Section("Fig. 4: thresholds", body)
