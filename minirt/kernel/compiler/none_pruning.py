"""Compiler pass that decides at compile time whether an optional part of a scene is None.

numba itself drops branches on `x is None` only where x is an argument. Fields of a scene are None by type too, and what
a scene does not have must not be compiled: without this pass such code is not even well typed.
"""

from __future__ import annotations

import operator
from typing import Any

from numba import types
from numba.core import ir
from numba.core.compiler_machinery import FunctionPass, register_pass
from numba.core.ir_utils import get_definition, guard


@register_pass(mutates_CFG=False, analysis_only=False)
class NoneChecks(FunctionPass):
    """Replace `x is None` and `x.y is None`, for an argument x, by True or False.

    numba's pass DeadBranchPrune, which runs next, drops the branch that is never taken.
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
    if not (isinstance(expression, ir.Expr) and expression.op == "binop"):
        return None
    if expression.fn not in (operator.is_, operator.is_not):
        return None
    left, right = (guard(get_definition, state.func_ir, side) for side in (expression.lhs, expression.rhs))
    kind = type_of(state, left)
    if kind is None or not (isinstance(right, ir.Const) and right.value is None):
        return None
    return bool((kind == types.none) == (expression.fn is operator.is_))


def type_of(state: Any, definition: Any) -> Any:
    """Return the type of an argument or of a field of one; None for any other definition."""
    if isinstance(definition, ir.Arg):
        return state.args[definition.index]
    if not (isinstance(definition, ir.Expr) and definition.op == "getattr"):
        return None
    owner = type_of(state, guard(get_definition, state.func_ir, definition.value))
    return owner and state.typingctx.resolve_getattr(owner, definition.attr)
