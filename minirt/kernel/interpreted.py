"""Interpreted functions that pack a scene, under the same names as in `minirt.kernel.machine_code.functions`."""

from minirt.kernel.bvh.build import divide
from minirt.kernel.bvh.collapse import collapse, weigh
from minirt.kernel.culling.binning import fill_bins, project_all

__all__ = ["collapse", "divide", "fill_bins", "project_all", "weigh"]
