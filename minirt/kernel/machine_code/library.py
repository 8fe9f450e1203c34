"""Library of kernels: finds the machine code of a function for a signature, loads it, or has it compiled.

A kernel is looked for in memory, among those that came with the package, and in this user's cache on disk. llvmlite
loads it. A call passes one address of memory, without the interpreter's lock.
"""

from __future__ import annotations

import ctypes
import json
import os
from collections.abc import Callable, Hashable, Iterable
from contextlib import ExitStack
from functools import cached_property, partial
from threading import Lock
from typing import Any, TypeAlias

from minirt.kernel.machine_code import cache
from minirt.kernel.machine_code.arguments import key_of, signature_of, words_of
from minirt.kernel.machine_code.cache import CodeCache, ObjectCode
from minirt.kernel.machine_code.compile_process import CompileProcess
from minirt.kernel.machine_code.fingerprint import fingerprint_of, processor

Call: TypeAlias = tuple[str, tuple[Any, ...]]  # the name of a function, "module:name", and arguments

FUNCTION = ctypes.CFUNCTYPE(None, ctypes.c_void_p)
REMEMBERED = 512  # identities, of some kilobytes each; when there are more, all are forgotten and made again
IN_MEMORY = 24  # kernels; one that was dropped is loaded from disk again


class Entry:
    """Entry point of a loaded kernel for one signature. The code lives as long as this object."""

    def __init__(self, address: int, code: object) -> None:
        """`address` of the entry point; `code` owns the machine code."""
        self.code = code
        self.call = FUNCTION(address)

    def __call__(self, *arguments: Any) -> None:
        """Run the kernel."""
        self.run(words_of(arguments))

    def run(self, words: bytes) -> None:
        """Run the kernel with the words of its arguments, which the caller keeps alive."""
        self.call(words)


def load(kernel: ObjectCode) -> Entry:
    """Load machine code into memory."""
    from llvmlite import binding  # 30 ms, which programs that draw nothing need not wait for

    binding.initialize_native_target()
    binding.initialize_native_asmprinter()
    machine = binding.Target.from_default_triple().create_target_machine()
    engine = binding.create_mcjit_compiler(binding.parse_assembly(""), machine)  # which owns the machine
    engine.add_object_file(binding.ObjectFileRef.from_data(kernel.code))
    engine.finalize_object()
    return Entry(engine.get_function_address(kernel.entry), engine)


class Library:
    """Kernels in memory, and where others are."""

    def __init__(self) -> None:
        self.identities: dict[Hashable, str] = {}
        self.entries: dict[str, Entry] = {}  # by identity, the one that was used last at the end
        self.seen: set[str] = set()  # identities of kernels that were found,
        self.missing: set[str] = set()  # and of those that were not
        self.lock = Lock()
        if hasattr(os, "register_at_fork"):  # a child process finds the lock free; Windows has no fork
            release = self.lock.release
            os.register_at_fork(before=self.lock.acquire, after_in_parent=release, after_in_child=release)

    @cached_property
    def cache(self) -> CodeCache | None:
        """The cache on disk; None where kernels cannot be kept."""
        folder = cache.folder()
        return CodeCache(folder) if folder else None

    def identity(self, call: Call) -> str:
        """Return a text that two calls share only where they need the same kernel."""
        key = call[0], key_of(call[1])
        found = self.identities.get(key)
        if found is None:
            if len(self.identities) >= REMEMBERED:
                self.identities.clear()
            found = self.identities[key] = identity_of(*call, fingerprint_of(processor()))
        return found

    def find(self, identity: str) -> Entry | None:
        """Return a kernel; None where it must be compiled. The disk is searched once."""
        with self.lock:
            entry = self.entries.pop(identity, None)
            if not entry and (code := self.code(identity)):
                entry = load(code)
            if entry:
                self.keep(identity, entry)
            return entry

    def has(self, identity: str) -> bool:
        """Whether a kernel can be found, without loading it."""
        with self.lock:
            return identity in self.entries or identity in self.seen or self.code(identity) is not None

    def code(self, identity: str) -> ObjectCode | None:
        """Return the object code of a kernel from the package or the disk, unless it was missing there before."""
        if identity in self.missing:
            return None
        code = CodeCache(cache.SHIPPED / processor()).read(identity) or self.on_disk([identity]).get(identity)
        if len(self.missing) >= REMEMBERED:
            self.missing.clear()
        (self.seen if code else self.missing).add(identity)
        return code

    def keep(self, identity: str, entry: Entry) -> None:
        """Keep a kernel in memory, and drop those that were not used for longest if they can be loaded again."""
        self.entries[identity] = entry
        if self.cache:
            for each in list(self.entries)[:-IN_MEMORY]:
                del self.entries[each]

    def compile(self, identities: Iterable[str], process: CompileProcess) -> None:
        """Compile those of the kernels `identities` that are not to be found, load them, and keep them in the cache.

        One `process` compiles all. A kernel that another program compiles meanwhile is waited for, and not compiled.
        RenderError where compiling fails.
        """
        # Each kernel once, and all in one order: programs that wait for each other's locks would wait for ever.
        missing = sorted({each for each in identities if not self.find(each)})
        with ExitStack() as stack:
            if self.cache:
                for identity in missing:
                    stack.enter_context(self.cache.compiling_once(identity))
            codes = self.on_disk(missing)  # another process may have been first
            requests = [each for each in missing if each not in codes]
            codes |= zip(requests, process.compile(requests) if requests else [], strict=True)
            if self.cache:
                self.cache.keep({each: codes[each] for each in requests})
        for identity, code in codes.items():
            with self.lock:  # no process is forked while LLVM, whose lock it would inherit, loads
                self.missing.discard(identity)
                self.keep(identity, load(code))

    def on_disk(self, identities: Iterable[str]) -> dict[str, ObjectCode]:
        """Return those of some kernels that the cache on disk has."""
        found = {each: self.cache.read(each) for each in identities} if self.cache else {}
        return {identity: code for identity, code in found.items() if code}

    def get(self, call: Call) -> Entry:
        """Return the kernel for a call, compiled if need be, which takes seconds. RenderError where that fails."""
        identity = self.identity(call)
        entry = self.find(identity)
        if not entry:
            self.compile([identity], CompileProcess())
            entry = self.find(identity)
        assert entry, "compiled and not found"
        return entry


def identity_of(function: str, arguments: tuple[Any, ...], fingerprint: str) -> str:
    """Return the identity of a kernel: JSON of the function, its signature and the fingerprint."""
    return json.dumps([function, [signature_of(each) for each in arguments], fingerprint])


LIBRARY = Library()


class CompiledFunction:
    """A function that is loaded or compiled, for the types of its arguments, when it is called."""

    def __init__(self, function: Callable[..., Any]) -> None:
        self.name = f"{function.__module__}:{function.__qualname__}"

    def __call__(self, *arguments: Any) -> None:
        """Call the compiled form. RenderError where it cannot be compiled."""
        LIBRARY.get((self.name, arguments))(*arguments)

    def call(self, *arguments: Any) -> Call:
        """Return the call with some arguments, to look for its kernel."""
        return self.name, arguments


def bound(function: Callable[..., None], *arguments: Any) -> Callable[[], None]:
    """Return the call of a function, compiled or interpreted, with some arguments, whose arrays may change but not
    move. Compiled, it takes 2 us. RenderError where it cannot be compiled."""
    if not isinstance(function, CompiledFunction):
        return partial(function, *arguments)
    entry, words = LIBRARY.get((function.name, arguments)), words_of(arguments)

    def call(kept: Any = arguments) -> None:
        entry.run(words)

    return call
