"""Cache of compiled kernels on disk: machine code and the names by which it is found.

numba's own cache unpickles what it reads, writes LLVM code for other compiled functions to link, looks for a function
only when all that a compiler needs is loaded, and holds machine code in memory until the program ends. Only Python
calls a kernel, and an editor meets ever new combinations of shapes: so machine code alone is written, it is loaded
without a compiler, and each kernel has an engine of its own, whose memory is freed with the last reference to it.

No fault of the disk prevents a picture: a kernel that cannot be read is compiled, one that cannot be written stays in
memory, each with one notice.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from hashlib import sha256
from pathlib import Path
from typing import Any

from minirt.kernel.compiler import container, private_files
from minirt.kernel.compiler.cache_folder import notice
from minirt.kernel.compiler.numba_internals import is_plain, names_and_code, processor_of, rebuilt


class CodeCache:
    """Writes and finds the machine code of a function, one file for each combination of argument types."""

    def __init__(self, function: Callable[..., Any], folder: Path) -> None:
        self.function = function
        self.cache_path = folder

    def identity(self, signature: Any, target: Any) -> str:
        """Return a text that differs for kernels that differ: function, argument types and processor."""
        bytecode = sha256(self.function.__code__.co_code).hexdigest()
        kinds = [str(each) for each in arguments_of(signature)]
        return json.dumps([self.function.__module__, self.function.__qualname__, bytecode, kinds, processor_of(target)])

    def file_of(self, identity: str) -> Path:
        """Return the path of the file of a kernel."""
        return self.cache_path / f"{self.function.__qualname__}-{sha256(identity.encode()).hexdigest()[:24]}.kernel"

    def read(self, identity: str) -> tuple[dict[str, Any], bytes] | None:
        """Return the names and the object code of a kernel; None without a good file. A bad file is deleted."""
        path = self.file_of(identity)
        try:
            data = private_files.read(path)
            return container.unpack(private_files.key_of(self.cache_path), identity, data)
        except FileNotFoundError:
            return None
        except (OSError, container.DamagedError) as error:
            notice("a kernel in %s is deleted and compiled anew: %s", self.cache_path, error)
            with suppress(OSError):
                path.unlink()
            return None

    def contains(self, signature: Any, target: Any) -> bool:
        """Whether the kernel for arguments of these types is on disk, undamaged."""
        return self.read(self.identity(signature, target)) is not None

    @contextmanager
    def compiling_once(self, signature: Any, target: Any) -> Iterator[None]:
        """Let other processes that need a kernel wait during this block, unless it is on disk already."""
        if self.contains(signature, target):
            yield
        else:
            with private_files.locked(self.file_of(self.identity(signature, target)).with_suffix(".lock")):
                yield

    def load_overload(self, signature: Any, target: Any) -> Any:
        """Return the function for arguments of these types, or None."""
        found = self.read(self.identity(signature, target))
        result = getattr(signature, "return_type", None)
        return found and rebuilt(self.function, target, arguments_of(signature), result, *found)

    def save_overload(self, signature: Any, compiled: Any) -> None:
        """Write the machine code of a function; do nothing but give a notice where it cannot be written."""
        if self.function.__closure__ or not is_plain(compiled):
            return
        identity = self.identity(signature, compiled.target_context)
        try:
            data = container.pack(private_files.key_of(self.cache_path), identity, *names_and_code(compiled))
            private_files.write(self.file_of(identity), data)
        except OSError as error:
            notice("every run compiles anew, a kernel cannot be kept in %s: %s", self.cache_path, error)


def arguments_of(signature: Any) -> tuple[Any, ...]:
    """Return the types of the arguments in a signature, which may be nothing but these types."""
    return tuple(getattr(signature, "args", signature))
