"""Options with which numba compiles kernels and the functions that they inline, and the compiler of these functions.

The compiler needs private interfaces of numba, see `minirt.kernel.compiler.lean_pipeline`. They are the same in the
versions that pyproject.toml allows. Where one is missing all the same, numba's own pipeline compiles the same
functions: kernels take about twice as long to compile, and draw the same pictures.
"""

from __future__ import annotations

import logging
import operator
from functools import cache
from importlib import import_module
from types import FunctionType, ModuleType
from typing import Any

import numba
from llvmlite import binding
from numba import config, types
from numba.core import ir
from numba.core.compiler import CompilerBase, DefaultPassBuilder
from numba.core.compiler_machinery import FunctionPass, PassManager, register_pass
from numba.core.ir_utils import get_definition, guard
from numba.core.untyped_passes import DeadBranchPrune, IRProcessing
from numba.extending import register_jitable

from minirt.lanes.compiled.types import REGISTERED

TESTED = "numba>=0.61,<0.69"


@register_pass(mutates_CFG=False, analysis_only=False)
class NoneChecks(FunctionPass):
    """Replace `x is None` and `x.y is None`, for an argument x, by True or False.

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
    is_binary = isinstance(expression, ir.Expr) and expression.op == "binop"
    if not is_binary or expression.fn not in (operator.is_, operator.is_not):
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


class InlinedCompiler(CompilerBase):
    """Compiles an inlined function."""

    def define_pipelines(self) -> list[PassManager]:
        """Return the lean pipeline, or numba's own with two passes more, of which the one added last comes first."""
        if not FAILED:
            return [lean.passes(NoneChecks)]
        manager = DefaultPassBuilder.define_nopython_pipeline(self.state)
        manager.add_pass_after(DeadBranchPrune, IRProcessing)
        manager.add_pass_after(NoneChecks, IRProcessing)
        manager.finalize()
        return [manager]


def machine_code(entry: Any) -> bytes:
    """Return the object code of a C function that numba has compiled."""
    if not FAILED:
        return bytes(lean.machine_code(entry))
    name = config.CPU_NAME or binding.get_host_cpu_name()
    features = binding.get_host_cpu_features().flatten() if config.CPU_FEATURES is None else config.CPU_FEATURES
    machine = binding.Target.from_default_triple().create_target_machine(name, features, opt=3)
    return bytes(machine.emit_object(binding.parse_assembly(entry.inspect_llvm())))


try:
    lean: Any = import_module("minirt.kernel.compiler.lean_pipeline")
    FAILED = ""
except (ImportError, AttributeError, KeyError, TypeError) as error:
    FAILED = str(error)
    logging.getLogger(__name__).warning(
        f"notice: kernels take twice as long to compile, as numba {numba.__version__} differs from what was tested "
        f"({FAILED}); pip install '{TESTED}' mends that"
    )

# error_model: x / 0 is infinite or NaN, as in IEEE 754. fastmath: a * b + c may round once, and nothing else.
FLAGS: dict[str, Any] = {"error_model": "numpy", "fastmath": {"contract"}, "nogil": True}
if not FAILED:
    FLAGS["_nrt"] = False  # The kernel allocates nothing: no reference counting.

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
    """Let compiled code inline a function, unless it has a compiled form of its own."""
    if function not in REGISTERED:
        register_jitable(**INLINED)(function)


def inline_functions_of(module: ModuleType) -> None:
    """Let compiled code inline the functions that a module defines itself."""
    for each in list(vars(module).values()):
        if isinstance(each, FunctionType) and each.__module__ == module.__name__:
            inline(each)
