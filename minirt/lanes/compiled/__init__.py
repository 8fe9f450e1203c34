"""The operators and verbs of the formulas, compiled.

Importing this module teaches numba what each of them becomes on float64, on lanes and on Vecs. An entry says for which
types of arguments it holds, which type comes out, and which LLVM instructions do it.
"""

from minirt.lanes.compiled import operations, operators, reductions, vec

__all__ = ["operations", "operators", "reductions", "vec"]
