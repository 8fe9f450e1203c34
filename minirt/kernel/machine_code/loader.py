"""Loads machine code into memory: an image by mmap and mprotect alone, other object code by llvmlite.

Importing llvmlite would take a third of the start of the program.
"""

from __future__ import annotations

import ctypes
import mmap
import os
import struct
from typing import Any

from minirt.errors import RenderError
from minirt.kernel.machine_code.entry import Entry

ADDRESS = struct.Struct("=Q")


def load(names: dict[str, Any], code: bytes) -> Entry:
    """Return the entry point of a kernel; `names` are those that `pack` of the container took."""
    return load_image(names, code) if "relocations" in names else load_object(names, code)


def load_image(names: dict[str, Any], code: bytes) -> Entry:
    """Return the entry point in an image: see `minirt.kernel.compiler.elf_image`. RenderError where the system does not
    allow programs to make code."""
    memory = mmap.mmap(-1, len(code))
    memory.write(code)
    base = ctypes.addressof(ctypes.c_char.from_buffer(memory))
    for place, target in names["relocations"]:
        ADDRESS.pack_into(memory, place, base + target)
    system = ctypes.CDLL(None, use_errno=True)
    if system.mprotect(ctypes.c_void_p(base), ctypes.c_size_t(len(code)), mmap.PROT_READ | mmap.PROT_EXEC):
        raise RenderError(f"the system does not let kernels run: {os.strerror(ctypes.get_errno())}")
    return Entry(base + names["entry"], names["results"], memory)


def load_object(names: dict[str, Any], code: bytes) -> Entry:
    """Return the entry point in object code of any platform."""
    from llvmlite import binding

    binding.initialize_native_target()
    binding.initialize_native_asmprinter()
    machine = binding.Target.from_default_triple().create_target_machine()
    engine = binding.create_mcjit_compiler(binding.parse_assembly(""), machine)  # which owns the machine
    engine.add_object_file(binding.ObjectFileRef.from_data(code))
    engine.finalize_object()
    return Entry(engine.get_function_address(names["entry"]), names["results"], engine)
