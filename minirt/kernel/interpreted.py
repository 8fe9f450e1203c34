"""Interpreted functions that pack a scene, under the same names as in `minirt.kernel.machine_code.functions`."""

from minirt.kernel.binning import fill_bins, project_all
from minirt.kernel.bvh_build import collapse, divide

__all__ = ["collapse", "divide", "fill_bins", "project_all"]
