"""Compiler pipeline for functions that are always inlined into a kernel, and the options of kernels.

Its passes are those for plain arithmetic, calls, branches and loops, and make no machine code: a call of an inlined
function is replaced by its body. So a kernel compiles in three fifths of the time that all of numba's passes take.

numba promises none of the private interfaces that are used here: pyproject.toml allows the versions that have them.
"""

from __future__ import annotations

import operator
from functools import cache
from types import FunctionType, ModuleType
from typing import Any

from numba import _dynfunc, types
from numba.core import ir
from numba.core.codegen import JITCodeLibrary
from numba.core.compiler import CompilerBase
from numba.core.compiler_machinery import FunctionPass, PassManager, _pass_registry, register_pass
from numba.core.ir_utils import get_definition, guard
from numba.core.typed_passes import NativeLowering, NoPythonBackend, NopythonTypeInference, PreLowerStripPhis
from numba.core.untyped_passes import DeadBranchPrune, FixupArgs, IRProcessing, ReconstructSSA, TranslateByteCode
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


class InlinedCode(JITCodeLibrary):
    """LLVM code of one function, which becomes machine code only as a part of the kernel that links it."""

    linked: Any = None  # the module of this function and of all that it calls
    outlined = False  # whether it is called: a kernel that contained it would round it in another way

    def add_ir_module(self, ir_module: Any) -> None:
        """Take the code of the function, and mark it if LLVM must not inline it."""
        for each in ir_module.functions:
            if self.outlined and not each.is_declaration:
                each.attributes.add("noinline")
        super().add_ir_module(ir_module)

    def finalize(self) -> None:
        """Finish without optimising: the kernel is optimised once, as a whole."""
        for function in self._final_module.functions:
            if not function.is_declaration:
                function.linkage = "linkonce_odr"  # copies that come with several callers are merged
        self._finalized = True

    def _get_module_for_linking(self) -> Any:
        if self.linked is None:
            self.linked = self._final_module.clone()
            for each in reversed(all_callees(self, [])):  # LLVM links only what earlier code refers to
                module = each._final_module if isinstance(each, InlinedCode) else each._get_module_for_linking()
                self.linked.link_in(module, preserve=True)
            keep_inside(self.linked, {each.name for each in self._final_module.functions if not each.is_declaration})
        return self.linked


def keep_inside(module: Any, seen: set[str]) -> None:
    """Make all functions of an LLVM module its own, except those that are `seen` from outside.

    The loader finds a function that a kernel calls, and did not inline, only so.
    """
    for each in module.functions:
        if not each.is_declaration and each.name not in seen:
            each.linkage = "internal"


def all_callees(library: Any, callees: list[Any]) -> list[Any]:
    """Append to `callees` all libraries that a library calls, directly or not, callees before their callers."""
    for each in library._linking_libraries:
        if each not in callees:
            if isinstance(each, InlinedCode):
                all_callees(each, callees)
            callees.append(each)
    return callees


@register_pass(mutates_CFG=True, analysis_only=False)
class InlinedLowering(NativeLowering):
    """Lower a typed function to `InlinedCode`. Calls of it from Python are not possible."""

    _name = "inlined_lowering"

    def run_pass(self, state: Any) -> bool:
        """Lower the function, without machine code."""
        state.library = library = InlinedCode(state.targetctx.codegen(), state.func_id.func_qualname)
        library.outlined = not state.flags.forceinline
        state.flags.no_compile = True
        super().run_pass(state)
        place = state.cr.fndesc
        function = _dynfunc.make_function(place.lookup_module(), place.qualname, "", 0, state.cr.env, library)
        state.targetctx.insert_user_function(function, place, [library])
        state.cr = state.cr._replace(cfunc=function)
        return True


class PlainPassManager(PassManager):
    """Runs passes one after the other. numba's own manager verifies and analyses the code anew after each."""

    def run(self, state: Any) -> None:
        """Run all passes on a function."""
        for step, _ in self.passes:
            _pass_registry.get(step).pass_inst.run_pass(state)


class InlinedCompiler(CompilerBase):
    """Compiles an inlined function."""

    def define_pipelines(self) -> list[PassManager]:
        """Return the passes."""
        manager = PlainPassManager("inlined")
        for step in (TranslateByteCode, FixupArgs, IRProcessing, NoneChecks, DeadBranchPrune, ReconstructSSA):
            manager.add_pass(step, step.__name__)
        for step in (NopythonTypeInference, PreLowerStripPhis, InlinedLowering, NoPythonBackend):
            manager.add_pass(step, step.__name__)
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
