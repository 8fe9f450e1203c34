"""Compiler pipeline for functions that are always inlined into a kernel, and the options of kernels."""

from __future__ import annotations

import operator
from functools import cache
from importlib import import_module
from types import FunctionType, ModuleType
from typing import Any

from numba import types
from numba.core import ir
from numba.core.compiler import CompilerBase, DefaultPassBuilder
from numba.core.compiler_machinery import FunctionPass, PassManager, register_pass
from numba.core.ir_utils import get_definition, guard
from numba.core.untyped_passes import DeadBranchPrune, IRProcessing
from numba.extending import register_jitable

from minirt.kernel.scene_arrays import has_rows
from minirt.lanes.compiled.types import REGISTERED


@register_pass(mutates_CFG=False, analysis_only=False)
class NoneChecks(FunctionPass):
    """Replace `x is None` and `x.y is None`, for an argument x, by True or False, and `has_rows` of None by False.

    numba's pass DeadBranchPrune, which runs next, drops the branch that is never taken. By itself it does so only where
    x is an argument. Fields of a scene are None by type too, and code for what a scene lacks is not even well typed.
    """

    _name = "none_checks"

    def __init__(self) -> None:
        FunctionPass.__init__(self)

    def run_pass(self, state: Any) -> bool:
        """Replace all checks in a function."""
        changed = False
        for block in state.func_ir.blocks.values():
            for assignment in block.find_insts(ir.Assign):
                answer = known_answer(state, assignment.value)
                if answer is not None:
                    assignment.value = ir.Const(answer, assignment.loc)
                    state.func_ir._definitions[assignment.target.name] = [assignment.value]
                    changed = True
        return changed


def known_answer(state: Any, expression: Any) -> bool | None:
    """Return the value of a check for None that types decide, or None for any other expression."""
    if not isinstance(expression, ir.Expr):
        return None
    if expression.op == "call":
        called = getattr(guard(get_definition, state.func_ir, expression.func), "value", None)
        return False if called is has_rows and type_of(state, expression.args[0]) == types.none else None
    if expression.op != "binop" or expression.fn not in (operator.is_, operator.is_not):
        return None
    kind, right = type_of(state, expression.lhs), guard(get_definition, state.func_ir, expression.rhs)
    if kind is None or not (isinstance(right, ir.Const) and right.value is None):
        return None
    return bool((kind == types.none) == (expression.fn is operator.is_))


def type_of(state: Any, variable: Any) -> Any:
    """Return the type of a variable that is an argument or a field of one; None for any other."""
    definition = guard(get_definition, state.func_ir, variable)
    if isinstance(definition, ir.Arg):
        return state.args[definition.index]
    if not (isinstance(definition, ir.Expr) and definition.op == "getattr"):
        return None
    owner = type_of(state, definition.value)
    return owner and state.typingctx.resolve_getattr(owner, definition.attr)


class InlinedCompiler(CompilerBase):
    """Compiles an inlined function."""

    lean = True  # until an interface of numba that the lean pipeline uses is missing

    def define_pipelines(self) -> list[PassManager]:
        """Return the lean pipeline, or numba's own with two passes more, of which the one added last comes first."""
        if self.lean:
            return [import_module("minirt.kernel.compiler.lean_pipeline").passes(NoneChecks)]
        manager = DefaultPassBuilder.define_nopython_pipeline(self.state)
        manager.add_pass_after(DeadBranchPrune, IRProcessing)
        manager.add_pass_after(NoneChecks, IRProcessing)
        manager.finalize()
        return [manager]


# error_model: x / 0 is infinite or NaN, as in IEEE 754. fastmath: a * b + c may round once, and nothing else. _nrt: the
# kernel allocates nothing, so there is no reference counting.
FLAGS: dict[str, Any] = {"error_model": "numpy", "fastmath": {"contract"}, "_nrt": False}

# Without wrappers for calls from Python there is 20 % less to compile. A call passes vectors through memory: inlined,
# functions are 1.5 to 2 times as fast.
INLINED: dict[str, Any] = {
    "no_cpython_wrapper": True,
    "no_cfunc_wrapper": True,
    "forceinline": True,
    "no_rewrites": True,
    "pipeline_class": InlinedCompiler,
}


@cache
def inline(function: FunctionType) -> None:
    """Let compiled code inline a function, or call it if it is outlined, unless it has a compiled form of its own."""
    if function not in REGISTERED:
        options = {**INLINED, "forceinline": not hasattr(function, "outlined")}
        register_jitable(**options)(function)


def inline_functions_of(module: ModuleType) -> None:
    """Let compiled code inline the functions that a module defines itself."""
    for each in list(vars(module).values()):
        if isinstance(each, FunctionType) and each.__module__ == module.__name__:
            inline(each)
