"""Compiled binning of shapes into screen tiles and light-buffer cells."""

from __future__ import annotations

from numba import types

from minirt.kernel.compiler.compilation import CACHE, compiled
from minirt.kernel.compiler.inlining import inline_functions_of
from minirt.kernel.culling import binning

inline_functions_of(binning, besides=(binning.project_all, binning.fill_bins))

# Functions with types are compiled when this module is imported.
NUMBER, INTEGER, SHORT = types.float64, types.int64, types.int32
GRID = types.NamedTuple([NUMBER[:, :, ::1], INTEGER, INTEGER, *[NUMBER] * 5, INTEGER, INTEGER], binning.Grid)
PROJECT_ALL = INTEGER(
    *(NUMBER[::1], GRID, NUMBER[:, ::1], NUMBER, INTEGER[::1], INTEGER[:, ::1]),
    *(SHORT[:, ::1], INTEGER, NUMBER[:, ::1], INTEGER[::1]),
)
FILL_BINS = types.void(SHORT[:, ::1], INTEGER[::1], INTEGER, INTEGER[::1], SHORT[::1])

project_all = compiled(binning.project_all, CACHE, PROJECT_ALL)
fill_bins = compiled(binning.fill_bins, CACHE, FILL_BINS)
