"""SIMD operations and operators, compiled: importing this module registers each with numba.

A registration says for which types of arguments it holds, which type results, and which LLVM instructions compute it.
"""

from minirt.lanes.compiled import memory, operations, operators

__all__ = ["memory", "operations", "operators"]
