"""Small functions that compile in a moment, and a compiler of them in this process: kernels as libraries keep them."""

from __future__ import annotations

import json
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from minirt.kernel.machine_code.arguments import signature_of
from minirt.kernel.machine_code.cache import CodeCache, ObjectCode
from minirt.kernel.machine_code.compile_process import CompileProcess
from minirt.kernel.machine_code.library import Call, Entry, Library

ARGUMENT = 1.5


class Inner(NamedTuple):
    line: Any
    number: int


class Outer(NamedTuple):
    table: Any
    deep: Any
    inner: Inner
    parts: Any = ()
    absent: Any = None


def double(x: Any) -> None:
    x[0] = x[0] + x[0]


def square(x: Any) -> None:
    x[0] = x[0] * x[0]


def count(x: Any) -> None:
    x[0] = x.shape[0] + 40.0


def as_kernel(function: Any) -> Callable[..., Any]:
    """Return the compiled form of a function, which may be local, as kernels are compiled."""
    entries: dict[str, Entry] = {}

    def call_compiled(*arguments: Any) -> Any:
        from minirt.kernel.compiler.object_code import compiled_entry
        from minirt.kernel.compiler.pipeline import inline

        inline(function)
        signatures = [signature_of(each) for each in arguments]
        key = json.dumps(signatures)
        if key not in entries:
            code = compiled_entry(function, signatures)
            entries[key] = Entry(code.address, code)
        entries[key](*arguments)

    return call_compiled


class Compiler(CompileProcess):
    """Compiles small kernels in this process, and counts them."""

    def __init__(self) -> None:
        super().__init__()
        self.compiled: list[str] = []

    def compile(self, requests: list[str], target: str | None = None) -> list[ObjectCode]:
        self.compiled += requests
        return [object_code_of(*json.loads(each)[:1], json.dumps(json.loads(each)[1])) for each in requests]


@cache
def object_code_of(name: str, signatures: str) -> ObjectCode:
    """Return the object code of a function for signatures in JSON."""
    from minirt.kernel.compiler.object_code import object_code

    return object_code(name, json.loads(signatures))


def call(function: Callable[..., Any], *arguments: Any) -> Call:
    """Return a call of a small kernel."""
    return f"{function.__module__}:{function.__name__}", arguments or (np.array([ARGUMENT]),)


def library(folder: Path | None) -> Library:
    """Return a library that keeps its kernels in a folder, or in memory alone."""
    made = Library()
    made.cache = CodeCache(folder) if folder else None
    return made


def compiled(kernels: Library, wanted: Call, compiler: CompileProcess) -> Entry:
    """Return the kernel for a call, compiled if need be."""
    identity = kernels.identity(wanted)
    kernels.compile([identity], compiler)
    entry = kernels.find(identity)
    assert entry
    return entry


def is_found(function: Callable[..., Any], folder: Path | None) -> bool:
    """Load a small kernel, or compile it, by a new library; return whether it was loaded. Its result is right."""
    kernels, compiler = library(folder), Compiler()
    entry = compiled(kernels, call(function), compiler)
    expected, found = np.array([ARGUMENT]), np.array([ARGUMENT])
    function(expected)
    entry(found)
    assert found == expected
    return not compiler.compiled


def file_of(function: Callable[..., Any], folder: Path) -> Path:
    """Return the path of the file of a small kernel."""
    return CodeCache(folder).file_of(Library().identity(call(function)))
