"""The functions that build a BVH, without the compiler: the same names as in `minirt.kernel.compiler.jit_bvh`."""

from minirt.kernel.bvh.build import divide
from minirt.kernel.bvh.collapse import collapse, weigh

__all__ = ["collapse", "divide", "weigh"]
