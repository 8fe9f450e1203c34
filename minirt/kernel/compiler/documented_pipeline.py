"""Compiler pipeline for inlined functions by numba's documented means alone: "Customizing the Compiler" in its manual.

It replaces `minirt.kernel.compiler.lean_pipeline` where numba's private interfaces have changed. A kernel of one sphere
then compiles in 5 s instead of 3 s; it renders as fast, the same picture.
"""

from __future__ import annotations

from typing import Any

from llvmlite import binding
from numba import config
from numba.core.compiler import CompilerBase, DefaultPassBuilder
from numba.core.compiler_machinery import PassManager
from numba.core.untyped_passes import DeadBranchPrune, IRProcessing

from minirt.kernel.compiler.none_pruning import NoneChecks


class InlinedCompiler(CompilerBase):
    """Compiles a function by numba's own pipeline, without code for parts of a scene that are None."""

    def define_pipelines(self) -> list[PassManager]:
        """Return numba's pipeline with two passes more, so that the pass added last comes first."""
        manager = DefaultPassBuilder.define_nopython_pipeline(self.state)
        manager.add_pass_after(DeadBranchPrune, IRProcessing)
        manager.add_pass_after(NoneChecks, IRProcessing)
        manager.finalize()
        return [manager]


def machine_code(entry: Any) -> bytes:
    """Return the object code of a C function that numba has compiled, from its LLVM code."""
    name = config.CPU_NAME or binding.get_host_cpu_name()
    features = binding.get_host_cpu_features().flatten() if config.CPU_FEATURES is None else config.CPU_FEATURES
    machine = binding.Target.from_default_triple().create_target_machine(name, features, opt=3)
    code: bytes = machine.emit_object(binding.parse_assembly(entry.inspect_llvm()))
    return code
