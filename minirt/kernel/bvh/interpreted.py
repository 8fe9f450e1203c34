"""What builds a tree, without the compiler."""

from minirt.kernel.bvh.build import divide
from minirt.kernel.bvh.collapse import collapse, weigh

__all__ = ["collapse", "divide", "weigh"]
