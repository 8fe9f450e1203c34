"""How numba compiles a function that only ever becomes a part of another.

A call of it is replaced by its body, so its own machine code would be made for nothing. Left out, a kernel compiles in
three quarters of the time.
"""

from __future__ import annotations

from typing import Any

from numba import _dynfunc
from numba.core.codegen import JITCodeLibrary
from numba.core.compiler import CompilerBase, DefaultPassBuilder
from numba.core.compiler_machinery import PassManager, register_pass
from numba.core.typed_passes import NativeLowering
from numba.core.untyped_passes import DeadBranchPrune, ReconstructSSA


class Part(JITCodeLibrary):
    """LLVM code that is linked into that of others and becomes machine code only there."""

    def _optimize_final_module(self) -> None:
        """The whole is optimised."""

    def _finalize_final_module(self) -> None:
        self._finalized = True


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


class Inlined(CompilerBase):
    """The steps of numba, with the last one replaced; `if x is None` is decided by the type of an argument x."""

    def define_pipelines(self) -> list[PassManager]:
        steps = PassManager("inlined")
        for step, why in DefaultPassBuilder.define_nopython_pipeline(self.state).passes:
            if step is ReconstructSSA:  # left out with the rewrites, which nothing here needs
                steps.add_pass(DeadBranchPrune, "what is done only with what is None")
            steps.add_pass(PartLowering if step is NativeLowering else step, why)
        steps.finalize()
        return [steps]
