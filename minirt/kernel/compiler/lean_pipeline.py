"""How numba compiles a function that only ever becomes a part of another.

A call of it is replaced by its body, so its own machine code would be made for nothing: left out, a kernel compiles in
three quarters of the time. Of the steps that numba takes only those are taken that plain arithmetic, calls, branches
and loops need, which saves another fifth.
"""

from __future__ import annotations

import operator
from typing import Any

from numba import _dynfunc, types
from numba.core import ir
from numba.core.codegen import JITCodeLibrary
from numba.core.compiler import CompilerBase
from numba.core.compiler_machinery import FunctionPass, PassManager, _pass_registry, register_pass
from numba.core.ir_utils import get_definition, guard
from numba.core.typed_passes import NativeLowering, NoPythonBackend, NopythonTypeInference, PreLowerStripPhis
from numba.core.untyped_passes import DeadBranchPrune, FixupArgs, IRProcessing, ReconstructSSA, TranslateByteCode


class Part(JITCodeLibrary):
    """LLVM code that is linked into that of others and becomes machine code only there."""

    whole: Any = None  # with all that it calls

    def finalize(self) -> None:
        """The whole is optimised, and each part linked into it once."""
        for function in self._final_module.functions:
            if not function.is_declaration:
                function.linkage = "linkonce_odr"  # the same in several parts is one in the whole
        self._finalized = True

    def _get_module_for_linking(self) -> Any:
        """The part with all parts of it."""
        if self.whole is None:
            self.whole = self._final_module.clone()
            for each in reversed(called(self, [])):  # linked is only what something refers to that is there already
                module = each._final_module if isinstance(each, Part) else each._get_module_for_linking()
                self.whole.link_in(module, preserve=True)
        return self.whole


def called(library: Any, found: list[Any]) -> list[Any]:
    """What is found already and what a library calls, directly or not; callers come after all that they call."""
    for each in library._linking_libraries:
        if each not in found:
            if isinstance(each, Part):
                called(each, found)
            found.append(each)
    return found


@register_pass(mutates_CFG=False, analysis_only=False)
class Presence(FunctionPass):
    """Decides `x is None` and `x.y is None` by the type of an argument x, for the next step to see."""

    _name = "presence"

    def __init__(self) -> None:
        FunctionPass.__init__(self)

    def run_pass(self, state: Any) -> bool:
        for block in state.func_ir.blocks.values():
            for found in block.find_insts(ir.Assign):
                decided = decision(state, found.value)
                if decided is not None:
                    found.value = ir.Const(decided, found.loc)
                    state.func_ir._definitions[found.target.name] = [found.value]
        return False


def decision(state: Any, asked: Any) -> bool | None:
    """What the answer always is, or None where something else is asked or the answer is not known."""
    if not (isinstance(asked, ir.Expr) and asked.op == "binop" and asked.fn in (operator.is_, operator.is_not)):
        return None
    left, right = (guard(get_definition, state.func_ir, side) for side in (asked.lhs, asked.rhs))
    kind = kind_of(state, left)
    if kind is None or not (isinstance(right, ir.Const) and right.value is None):
        return None
    return bool((kind == types.none) == (asked.fn is operator.is_))


def kind_of(state: Any, definition: Any) -> Any:
    """The type of an argument, or of a field of one; None for all else."""
    if isinstance(definition, ir.Arg):
        return state.args[definition.index]
    if not (isinstance(definition, ir.Expr) and definition.op == "getattr"):
        return None
    owner = kind_of(state, guard(get_definition, state.func_ir, definition.value))
    return owner and state.typingctx.resolve_getattr(owner, definition.attr)


@register_pass(mutates_CFG=True, analysis_only=False)
class PartLowering(NativeLowering):
    """Makes a Part of a function whose types are known."""

    _name = "part_lowering"

    def run_pass(self, state: Any) -> bool:
        state.library = part = Part(state.targetctx.codegen(), state.func_id.func_qualname)
        state.flags.no_compile = True
        super().run_pass(state)
        lowered = state.cr
        # What numba knows a compiled function by; nobody calls it.
        name = _dynfunc.make_function(lowered.fndesc.lookup_module(), lowered.fndesc.qualname, "", 0, lowered.env, part)
        state.targetctx.insert_user_function(name, lowered.fndesc, [part])
        state.cr = lowered._replace(cfunc=name)
        return True


STEPS = (
    (TranslateByteCode, "what the function does"),
    (FixupArgs, "its arguments"),
    (IRProcessing, "where its variables live"),
    (Presence, "what of its arguments is there"),
    (DeadBranchPrune, "without what is never done then"),
    (ReconstructSSA, "a variable for each value"),
    (NopythonTypeInference, "the types of all"),
    (PreLowerStripPhis, "one variable where ways meet"),
    (PartLowering, "LLVM code"),
    (NoPythonBackend, "the result"),
)


class Steps(PassManager):
    """Takes the steps one after the other. numba's own manager goes through the code anew after each."""

    def run(self, state: Any) -> None:
        for step, _ in self.passes:
            _pass_registry.get(step).pass_inst.run_pass(state)


class Inlined(CompilerBase):
    """Compiles by these steps."""

    def define_pipelines(self) -> list[PassManager]:
        steps = Steps("inlined")
        for step, what in STEPS:
            steps.add_pass(step, what)
        steps.finalize()
        return [steps]
