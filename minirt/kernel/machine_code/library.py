"""Library of kernels: finds the machine code of a function for a signature, or has it compiled.

A kernel is looked for in memory, among those that came with the package, and in this user's cache on disk.
"""

from __future__ import annotations

import json
import os
from collections.abc import Hashable, Iterable
from contextlib import ExitStack
from functools import cached_property
from threading import Lock
from typing import Any, TypeAlias

from minirt.kernel.machine_code import cache_folder, loader, shipped_code
from minirt.kernel.machine_code.code_cache import CodeCache, ObjectCode
from minirt.kernel.machine_code.compile_process import CompileProcess
from minirt.kernel.machine_code.entry import Entry
from minirt.kernel.machine_code.signature import key_of, signature_of

Call: TypeAlias = tuple[str, tuple[Any, ...]]  # the name of a function, "module:name", and arguments

REMEMBERED = 512  # identities, of some kilobytes each; when there are more, all are forgotten and made again
IN_MEMORY = 24  # kernels; one that was dropped is loaded from disk again


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
        folder = cache_folder.folder()
        return CodeCache(folder) if folder else None

    def identity(self, call: Call) -> str:
        """Return a text that two calls share only where they need the same kernel."""
        key = call[0], key_of(call[1])
        found = self.identities.get(key)
        if found is None:
            if len(self.identities) >= REMEMBERED:
                self.identities.clear()
            found = self.identities[key] = identity_of(*call, cache_folder.fingerprint())
        return found

    def find(self, identity: str) -> Entry | None:
        """Return a kernel; None where it must be compiled. The disk is searched once."""
        with self.lock:
            entry = self.entries.pop(identity, None) or self.loaded(identity)
            if entry:
                self.keep(identity, entry)
            return entry

    def has(self, identity: str) -> bool:
        """Whether a kernel can be found, without loading it."""
        with self.lock:
            return identity in self.entries or identity in self.seen or self.code(identity) is not None

    def loaded(self, identity: str) -> Entry | None:
        """Load a kernel from the package or the disk."""
        code = self.code(identity)
        return loader.load(*code) if code else None

    def code(self, identity: str) -> ObjectCode | None:
        """Return the object code of a kernel from the package or the disk, unless it was missing there before."""
        if identity in self.missing:
            return None
        code = shipped_code.read(identity) or (self.cache.read(identity) if self.cache else None)
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
        """Compile those of some kernels that are missing, in one process. RenderError where that fails."""
        # Each once and in one order: programs that wait for each other's locks would wait for ever.
        missing = sorted({each for each in identities if not self.find(each)})
        with ExitStack() as stack:
            if self.cache:
                for identity in missing:
                    stack.enter_context(self.cache.compiling_once(identity))
            codes = self.on_disk(missing)  # another process may have been first
            requests = [each for each in missing if each not in codes]
            codes |= zip(requests, process.compile(requests) if requests else [], strict=True)
            for identity in requests:
                if self.cache:
                    self.cache.write(identity, codes[identity])
        for identity, code in codes.items():
            with self.lock:  # no process is forked while LLVM, whose lock it would inherit, loads
                self.missing.discard(identity)
                self.keep(identity, loader.load(*code))

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
