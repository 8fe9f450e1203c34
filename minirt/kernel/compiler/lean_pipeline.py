"""Lean compiler pipeline for functions that are always inlined into a kernel.

A call of such a function is replaced by its body, so machine code of its own would be made for nothing: without it a
kernel compiles in three quarters of the time. Of numba's passes only those run that plain arithmetic, calls, branches
and loops need, which saves another fifth.
"""

from __future__ import annotations

from typing import Any

from numba.core.compiler import CompilerBase
from numba.core.compiler_machinery import PassManager, register_pass

from minirt.kernel.compiler.none_pruning import NoneChecks
from minirt.kernel.compiler.numba_internals import (
    CodeLibrary,
    DeadBranchPrune,
    FixupArgs,
    IRProcessing,
    NativeLowering,
    NoPythonBackend,
    NopythonTypeInference,
    PreLowerStripPhis,
    ReconstructSSA,
    TranslateByteCode,
    callees_of,
    function_object,
    module_to_link,
    run_pass,
)


class InlinedCode(CodeLibrary):
    """LLVM code of one function, which becomes machine code only as a part of the kernel that links it."""

    linked: Any = None  # the module of this function and of all that it calls

    def finalize(self) -> None:
        """Finish without optimising: the kernel is optimised once, as a whole."""
        for function in self.module.functions:
            if not function.is_declaration:
                function.linkage = "linkonce_odr"  # copies that come with several callers are merged
        self.mark_finalized()

    def linked_module(self) -> Any:
        """Return the module of this function and of all that it calls."""
        if self.linked is None:
            self.linked = self.module.clone()
            for each in reversed(all_callees(self, [])):  # LLVM links only what earlier code refers to
                module = each.module if isinstance(each, InlinedCode) else module_to_link(each)
                self.linked.link_in(module, preserve=True)
        return self.linked


def all_callees(library: Any, callees: list[Any]) -> list[Any]:
    """Append to `callees` all libraries that a library calls, directly or not, callees before their callers."""
    for each in callees_of(library):
        if each not in callees:
            if isinstance(each, InlinedCode):
                all_callees(each, callees)
            callees.append(each)
    return callees


@register_pass(mutates_CFG=True, analysis_only=False)
class InlinedLowering(NativeLowering):
    """Lower a typed function to `InlinedCode`."""

    _name = "inlined_lowering"

    def run_pass(self, state: Any) -> bool:
        """Lower the function, without machine code."""
        state.library = library = InlinedCode(state.targetctx.codegen(), state.func_id.func_qualname)
        state.flags.no_compile = True
        super().run_pass(state)
        function = function_object(state.cr, library)
        state.targetctx.insert_user_function(function, state.cr.fndesc, [library])
        state.cr = state.cr._replace(cfunc=function)
        return True


PASSES = (
    (TranslateByteCode, "read the bytecode"),
    (FixupArgs, "number the arguments"),
    (IRProcessing, "find the lifetimes of variables"),
    (NoneChecks, "decide checks for None"),
    (DeadBranchPrune, "drop branches that are never taken"),
    (ReconstructSSA, "static single assignment"),
    (NopythonTypeInference, "infer types"),
    (PreLowerStripPhis, "replace phi nodes by assignments"),
    (InlinedLowering, "lower to LLVM code"),
    (NoPythonBackend, "hand over the result"),
)


class LeanPassManager(PassManager):
    """Runs passes one after the other. numba's own manager verifies and analyses the code anew after each."""

    def run(self, state: Any) -> None:
        """Run all passes on a function."""
        for step, _ in self.passes:
            run_pass(step, state)


class InlinedCompiler(CompilerBase):
    """Compiles a function by the lean pipeline."""

    def define_pipelines(self) -> list[PassManager]:
        """Return the one pipeline that there is."""
        manager = LeanPassManager("inlined")
        for step, description in PASSES:
            manager.add_pass(step, description)
        manager.finalize()
        return [manager]
