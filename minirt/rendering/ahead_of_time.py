"""Compiles the generic kernels ahead of time: `python -m minirt.rendering.ahead_of_time`.

They are written into a folder of the package, where `minirt.kernel.machine_code.library` finds them. Kernels that
are there already are not compiled again. With the argument `first` only those are compiled that draw a picture of any
scene in double precision, with `wheel` those for all processors that a wheel is for.
"""

from __future__ import annotations

import sys
from concurrent.futures import ThreadPoolExecutor
from itertools import chain
from pathlib import Path

from minirt.errors import MiniRTError
from minirt.helpers.progress import WorkState, progress
from minirt.kernel.machine_code.cache import SHIPPED, CodeCache
from minirt.kernel.machine_code.compile_process import CompileProcess
from minirt.kernel.machine_code.fingerprint import V3, V4, fingerprint_of, is_linux_on_x86_64, processor
from minirt.kernel.machine_code.library import Call, identity_of
from minirt.rendering.kernels import generic_call, packing_calls, ray_query
from minirt.rendering.packing.generic_kernels import GENERIC_KERNELS
from minirt.rendering.threads import usable_cores

FIRST = 2  # groups of kernels that can draw a picture of any scene


def calls() -> list[list[Call]]:
    """Return calls of the kernels to compile, in groups for one process each, the slowest of all first."""
    full, *others = map(generic_call, sorted(GENERIC_KERNELS, key=lambda each: (each.precision, each.name)))
    return [[full], packing_calls(), *([each] for each in others), [ray_query()]]


def build(folder: Path, target: str, most: int | None = None) -> int:
    """Compile the kernels for the processor `target` that are not in the folder; return how many were compiled.

    `most` is the number of groups, from the first one on, that are compiled; None for all. Kernels of other sources are
    deleted. RenderError where compiling fails; OSError where the folder cannot be written.
    """
    kernels, fingerprint = CodeCache(folder), fingerprint_of(target)
    folder.mkdir(parents=True, exist_ok=True)
    groups = [[identity_of(*call, fingerprint) for call in group] for group in calls()]
    missing = [[each for each in group if not kernels.read(each)] for group in groups[:most]]
    number = sum(map(len, missing))
    compiled: list[str] = []

    def compile(identities: list[str]) -> None:
        for identity, code in zip(identities, CompileProcess().compile(identities, target), strict=True):
            kernels.write(identity, code)
            compiled.append(identity)

    with (
        progress(lambda: WorkState(f"compiling kernels: {len(compiled)} of {number} done")),
        ThreadPoolExecutor(usable_cores()) as pool,
    ):
        list(pool.map(compile, filter(None, missing)))
    kernels.delete_others(chain.from_iterable(groups))
    return number


def main() -> int:
    which, targets = sys.argv[1:], [processor()]
    if which == ["wheel"]:
        targets = [V3, V4] if is_linux_on_x86_64() else []
    try:
        for target in targets:
            build(SHIPPED / target, target, FIRST if which == ["first"] else None)
    except (MiniRTError, OSError) as error:
        print(f"Error\n{error}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
