"""Loads object code into memory, by the part of llvmlite that is not a compiler."""

from __future__ import annotations

from typing import Any

from minirt.kernel.machine_code.entry import Entry


def load(names: dict[str, Any], code: bytes) -> Entry:
    """Return the entry point of a kernel in object code; `names` are those that `pack` of the container took."""
    from llvmlite import binding

    engine = binding.create_mcjit_compiler(binding.parse_assembly(""), target_machine())
    engine.add_object_file(binding.ObjectFileRef.from_data(code))
    engine.finalize_object()
    return Entry(engine.get_function_address(names["entry"]), names["results"], engine)


def target_machine() -> Any:
    """Return a description of this machine, which the engine that gets it owns."""
    from llvmlite import binding

    binding.initialize_native_target()
    binding.initialize_native_asmprinter()
    return binding.Target.from_default_triple().create_target_machine()
