"""The related tools of Sec. 6.1, rebuilt from what is published of them: `RELATED` names them.

Each is a layout without optimisation: a frozen dataclass with one method
`build(pixels [H, W, 3] uint8, triangle_count, rng) -> Mesh`, given the parameters that served it
best on a set of photographs. A new one is a file and a line here.
"""

from benchmarks.paper.related.edge_density import EdgeDensity
from benchmarks.paper.related.edge_sampling import EdgeSampling
from benchmarks.paper.related.greedy_insertion import GreedyInsertion, SteepestInsertion
from benchmarks.paper.related.poisson_disc import PoissonDisc
from benchmarks.paper.related.quadric_simplification import QuadricSimplification
from benchmarks.paper.related.threshold_density import ThresholdDensity
from benchmarks.paper.related.uniform_features import UniformFeatures
from stages.layouts import Layout

RELATED: dict[str, type[Layout]] = {
    "edge sampling (Borquez, Dmesh)": EdgeSampling,
    "uniform features (Conceptfarm)": UniformFeatures,
    "edge density (Hamamuro)": EdgeDensity,
    "threshold density (Fischer)": ThresholdDensity,
    "Poisson discs (Polyshaper)": PoissonDisc,
    "greedy insertion, worst pixel": GreedyInsertion,
    "greedy insertion, steepest pixel": SteepestInsertion,
    "quadrics (Garland & Heckbert)": QuadricSimplification,
}
