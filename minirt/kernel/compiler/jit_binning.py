"""Where the compiler is attached to the lists of what may be met where."""

from __future__ import annotations

from numba import types
from numba.extending import register_jitable

from minirt.kernel.compiler.code_cache import compiled
from minirt.kernel.compiler.jit import CACHE, INNER, own_functions
from minirt.kernel.culling import binning

for _function in own_functions(binning):
    if _function not in (binning.project_all, binning.fill_bins):
        register_jitable(**INNER)(_function)

# With the types said at once they are compiled when this module is imported.
NUMBER, WHOLE, SHORT = types.float64, types.int64, types.int32
GRID = types.NamedTuple([NUMBER[:, :, ::1], WHOLE, WHOLE, *[NUMBER] * 5, WHOLE, WHOLE], binning.Grid)
PROJECT_ALL = WHOLE(
    *(NUMBER[::1], GRID, NUMBER[:, ::1], NUMBER, WHOLE[::1], WHOLE[:, ::1]),
    *(SHORT[:, ::1], WHOLE, NUMBER[:, ::1], WHOLE[::1]),
)
FILL_BINS = types.void(SHORT[:, ::1], WHOLE[::1], WHOLE, WHOLE[::1], SHORT[::1])

project_all = compiled(binning.project_all, CACHE, PROJECT_ALL)
fill_bins = compiled(binning.fill_bins, CACHE, FILL_BINS)
