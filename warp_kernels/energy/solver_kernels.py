"""Which kernels solving takes, so that they are compiled together; see `device.kernels`.

One that is missing here is compiled alone, when it is recorded.
"""

from typing import Any

from warp_kernels.color_model import ColorModel
from warp_kernels.device.device import Device
from warp_kernels.energy.card_splits import choice_kernel, trial_kernel
from warp_kernels.energy.color_bands import sift, widen_bands
from warp_kernels.energy.color_extremes import find_extremes
from warp_kernels.energy.fit import fit_kernel
from warp_kernels.energy.gradient_descent import descend
from warp_kernels.energy.nearby_colors import nearby_kernel
from warp_kernels.energy.plain_colors import find_plain_colors
from warp_kernels.energy.topology_gains import CHANGES
from warp_kernels.energy.variant_energies import energy_kernel
from warp_kernels.moments.edge_moments import edge_kernel
from warp_kernels.moments.fragments import fragment_kernel
from warp_kernels.moments.moment_layout import layout_of_moments
from warp_kernels.moments.prefix_tables import table_kernel
from warp_kernels.moments.variants import EDGE_VERSIONS

SLOWEST = ("split", "flip", "collapse")
"""Changes of topology, those first whose kernels take longest to compile."""


def solving_kernels(
    device: Device, model: ColorModel, sums: str, weighted: bool = False
) -> list[Any]:
    """What a `Workspace` and a `Survey` launch, those first that take longest to compile.

    Args:
        device: Where to run.
        model: The colour model that is optimised.
        sums: "edges" or "fragments".
        weighted: Whether pictures come with weights.
    """
    layout = layout_of_moments(model, weighted=weighted)
    changes = [CHANGES[change](layout) for change in SLOWEST]
    if device.is_cuda:
        changes = [trial_kernel(layout), *changes[1:], choice_kernel(layout)]
    return [*changes, *_own(device, model, sums, weighted)]


def limiting_kernels(device: Device, model: ColorModel, drawn: ColorModel) -> list[Any]:
    """What else takes colours: they are kept within what is near by.

    Args:
        device: Where to run.
        model: The colour model that is optimised.
        drawn: The one that is drawn; another one has a `Workspace` of its own.
    """
    looking = [nearby_kernel(drawn)]
    if drawn.degree > 0:
        looking.append(find_extremes)
    if model.degree == 0:
        looking.append(find_plain_colors)
    if model.degree == 0 and not device.is_cuda:
        looking += [sift, widen_bands]
    if drawn is model:
        return looking
    return [nearby_kernel(model), *looking, *_own(device, drawn, "edges", False)]


def _own(device: Device, model: ColorModel, sums: str, weighted: bool) -> list[Any]:
    """What a `Workspace` launches."""
    layout = layout_of_moments(model, weighted=weighted)
    if sums == "edges":
        moments, _ = edge_kernel(device, layout, EDGE_VERSIONS)
    else:
        moments = fragment_kernel(layout)
    along, _ = edge_kernel(device, layout, 1)
    energies = energy_kernel(layout, sums, on_card=device.is_cuda)
    tables, _ = table_kernel(device, layout)
    return [moments, energies, fit_kernel(layout), along, descend, tables]
