"""Lean pipeline: the passes for plain arithmetic, calls, branches and loops, which make no machine code.

A call of an inlined function is replaced by its body, so machine code of its own would be made for nothing: without it
a kernel compiles in three quarters of the time. Running only these of numba's passes saves another fifth.

numba promises none of the private interfaces that are used here. They are the same in the versions that pyproject.toml
allows; where one is not, `minirt.kernel.compiler.object_code` uses numba's own pipeline.
"""

from __future__ import annotations

from typing import Any

from numba import _dynfunc
from numba.core.codegen import JITCodeLibrary
from numba.core.compiler_machinery import PassManager, _pass_registry, register_pass
from numba.core.typed_passes import NativeLowering, NoPythonBackend, NopythonTypeInference, PreLowerStripPhis
from numba.core.untyped_passes import DeadBranchPrune, FixupArgs, IRProcessing, ReconstructSSA, TranslateByteCode


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


class LeanPassManager(PassManager):
    """Runs passes one after the other. numba's own manager verifies and analyses the code anew after each."""

    def run(self, state: Any) -> None:
        """Run all passes on a function."""
        for step, _ in self.passes:
            _pass_registry.get(step).pass_inst.run_pass(state)


def passes(none_checks: type) -> PassManager:
    """Return the passes for an inlined function; `none_checks` decides checks for None."""
    manager = LeanPassManager("inlined")
    for step in (TranslateByteCode, FixupArgs, IRProcessing, none_checks, DeadBranchPrune, ReconstructSSA):
        manager.add_pass(step, step.__name__)
    for step in (NopythonTypeInference, PreLowerStripPhis, InlinedLowering, NoPythonBackend):
        manager.add_pass(step, step.__name__)
    manager.finalize()
    return manager
