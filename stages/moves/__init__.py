"""How triangles move while they are drawn: `MOVES` names the ways for the command line.

A move changes no mesh: it says for every triangle where it is drawn, and in which light. It is a
file with a frozen dataclass of parameters, see `Move`; a new one is that and a line here, or a
package of its own.
"""

from stages.moves.move import Move
from warp_kernels.registry import Registry

__all__ = ["MOVES", "Move"]

MOVES: Registry[Move] = Registry(
    "moves",
    {
        "assemble": "stages.moves.assemble:Assemble",
        "explode": "stages.moves.explode:Explode",
        "jitter": "stages.moves.jitter:Jitter",
        "pulse": "stages.moves.pulse:Pulse",
        "shatter": "stages.moves.shatter:Shatter",
        "wave": "stages.moves.wave:Wave",
    },
    method="moved",
)
