"""The engines for which a job can be written."""

from collections.abc import Callable, Mapping
from types import MappingProxyType

from pipeline.farm.farm_job import FarmJob
from pipeline.farm.flamenco import as_flamenco
from pipeline.farm.openjd import as_openjd
from pipeline.farm.slurm import as_slurm

ENGINES: Mapping[str, Callable[[FarmJob], str]] = MappingProxyType(
    {"slurm": as_slurm, "openjd": as_openjd, "flamenco": as_flamenco}
)
"""What writes a job, by the name of the engine."""
