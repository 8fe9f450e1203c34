"""The operators and verbs of the formulas, compiled.

Importing this module teaches numba what each of them becomes on float64, on lanes and on Vecs. An entry says for which
types of arguments it holds, which type comes out, and which LLVM instructions do it.
"""

from minirt.lanes import compiled_answers, compiled_operators, compiled_vec, compiled_verbs

__all__ = ["compiled_answers", "compiled_operators", "compiled_vec", "compiled_verbs"]
