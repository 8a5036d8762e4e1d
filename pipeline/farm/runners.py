"""Who solves, as a run says: this process, several, or a cluster."""

from pipeline.loop.animate import runner_of
from pipeline.loop.ranges import RangeRunner
from pipeline.options.run import Run
from warp_kernels.registry import imported


def runner_for(run: Run) -> RangeRunner:
    """Who solves ranges.

    Args:
        run: Names a cluster, or says how many processes there may be.
    """
    if run.cluster is None:
        return runner_of(run)
    cluster = imported("pipeline.farm.cluster.runner:OnCluster")
    runner: RangeRunner = cluster(run.cluster)
    return runner
