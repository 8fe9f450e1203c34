"""The yardstick: hand-written C++ with SIMD intrinsics for this processor that renders the same pictures."""

from __future__ import annotations

import json
import os
import shutil
from collections.abc import Collection
from pathlib import Path

from tests.bench.measure import GLASS, INSTALL, MESH, MIRROR, MissingError, Setting, System
from tests.processes import run

FLAGS = [
    "-std=c++20",
    "-O3",
    "-march=native",
    "-fopenmp",
    "-ffp-contract=fast",
    "-fno-math-errno",
    "-fno-trapping-math",
]


def compiled(target: Path, sources: Collection[Path], headers: Collection[Path], name: str, *flags: str) -> Path:
    """Compile sources into `target` unless it is newer than they; `MissingError` without a suitable compiler."""
    if target.exists() and target.stat().st_mtime > max(
        each.stat().st_mtime for each in (*sources, *headers, Path(__file__))
    ):
        return target
    compiler = os.environ.get("CXX") or next(filter(shutil.which, ("g++", "clang++", "c++")), None)
    if compiler is None:
        raise MissingError(f"{name}: no C++ compiler is installed; {INSTALL}")
    target.parent.mkdir(parents=True, exist_ok=True)
    unfinished = target.with_suffix(".part")
    ran = run([*compiler.split(), *FLAGS, *flags, *map(str, sorted(sources)), "-o", str(unfinished)], text=True)
    if ran.returncode:
        raise MissingError(f"{name}: {compiler} cannot compile it: {ran.stderr.strip().splitlines()[0]}")
    return unfinished.replace(target)


HERE = Path(__file__).parent


class Yardstick(System):
    """The yardstick in a precision: the same source, whose lanes are as many as a register holds."""

    how = "frames on the same terms as miniRT's, lists of lamps kept"
    lacks = MESH, MIRROR, GLASS

    def __init__(self, setting: Setting, precision: str = "single") -> None:
        super().__init__(setting)
        self.name = f"yardstick, {precision}"
        flags = ["-DDOUBLE"] if precision == "double" else []
        target = setting.folder / f"yardstick-{precision}"
        self.program = compiled(target, [*HERE.glob("*.cpp")], [*HERE.glob("*.h")], self.name, *flags)

    def run(self, path: Path, *arguments: str) -> dict[str, float]:
        """Run the program on a scene file and return the figures that it prints."""
        size = f"{self.setting.width}x{self.setting.height}"
        command = [str(self.program), str(path), "--size", size, "--threads", str(self.setting.threads), *arguments]
        ran = run(command, text=True)
        if ran.returncode:
            raise RuntimeError(f"{self.name} on {path}: {ran.stderr}")
        printed: dict[str, float] = json.loads(ran.stdout)
        return printed

    def frame_times(self, path: Path, seconds: float) -> list[float]:
        return [self.run(path, "--seconds", str(seconds))["ms_median"]]
