"""What builds a tree, without the compiler."""

from minirt.kernel.bvh_build import divide
from minirt.kernel.bvh_collapse import collapse, weigh

__all__ = ["collapse", "divide", "weigh"]
