"""Fig. 13: the time of the steps against the number of triangles."""

from dataclasses import dataclass

import numpy as np

from benchmarks.paper.curves import Panel, save_curves
from benchmarks.paper.page import Section, picture
from benchmarks.paper.pictures import reduced
from benchmarks.paper.study import Study
from benchmarks.timing import layout_of, loaded_workspace, repeat, table, time_iteration
from stages.topology import TOPOLOGIES
from stages.topology.appraise import Appraiser
from stages.topology.goal import SLIVER_HEIGHT, Goal
from warp_kernels.color_model import COLOR_MODELS

STEPS = (
    "load the picture",
    "iteration",
    "iteration, fragments",
    "fit",
    "adapt, energy",
    "adapt, delaunay",
)
HEADS = ("colours", "triangles", *(f"{step} [ms]" for step in STEPS))


@dataclass(frozen=True)
class StepTimes:
    """Medians over a few samples on the first picture."""

    counts: tuple[int, ...] = (200, 500, 1000, 2000, 5000, 10000)
    samples: int = 5
    colors: tuple[str, ...] = tuple(COLOR_MODELS)

    def run(self, study: Study) -> Section:
        """Time every step with every number of triangles, in the colour models."""
        pixels = reduced(study.pictures[study.first])
        rows, panels = [], []
        for color in self.colors:
            times: dict[str, list[float]] = {step: [] for step in STEPS}
            for count in self.counts:
                for step, value in self._times(study, pixels, color, count).items():
                    times[step].append(value)
                rows.append((color, count, *(f"{times[step][-1]:.2f}" for step in STEPS)))
            lines = {step: (self.counts, values) for step, values in times.items()}
            panels.append(Panel(color, "triangles", "time [ms]", lines, logarithmic=True))
        save_curves(study.plots / "fig13.png", panels)
        body = (
            f"{study.first}, {pixels.shape[1]}x{pixels.shape[0]}. An *iteration* is moments and "
            "energies of all thirteen variants, gradient and step of every vertex; *fragments* "
            "sums them the paper's way. *adapt* is one change of topology, flips and splits to "
            "a hundredth more triangles. The paper's GPU takes 3-15 ms (constant) and 6-24 ms "
            f"(linear) for an iteration at 512x512.\n\n{table(HEADS, rows)}\n\n"
            f"{picture(study, 'fig13.png', 'time of the steps')}"
        )
        return Section("Fig. 13: time of the steps", body)

    def _times(self, study: Study, pixels: np.ndarray, color: str, count: int) -> dict[str, float]:
        """Median time of each step [ms]."""
        mesh, model = layout_of(pixels, count), COLOR_MODELS[color]
        workspace = loaded_workspace(study.device, pixels, mesh, model)
        slow = loaded_workspace(study.device, pixels, mesh, model, "fragments")
        times = {
            "load the picture": repeat(lambda: workspace.load_image(pixels), self.samples).median,
            "iteration": time_iteration(workspace, mesh, steps=10, times=self.samples).median,
            "iteration, fragments": time_iteration(slow, mesh, steps=1, times=1).median,
            "fit": repeat(workspace.fit, self.samples).median,
        }
        goal = Goal(count + count // 100)
        for name, topology in TOPOLOGIES.items():
            appraiser = Appraiser(workspace, SLIVER_HEIGHT)

            def adapt(topology=topology, appraiser=appraiser) -> None:
                """One change, measured from scratch."""
                appraiser.forget()
                topology().adapt(mesh, appraiser, goal)

            times[f"adapt, {name}"] = repeat(adapt, self.samples).median
        return times
