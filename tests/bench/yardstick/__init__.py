"""The yardstick: hand-written C++ with SIMD intrinsics for this processor that renders the same pictures."""

from __future__ import annotations

import json
import os
import shutil
from pathlib import Path

from tests.bench.system import INSTALL, MissingError, Setting, System
from tests.processes import run

HERE = Path(__file__).parent
FLAGS = [
    "-std=c++20",
    "-O3",
    "-march=native",
    "-fopenmp",
    "-ffp-contract=fast",
    "-fno-math-errno",
    "-fno-trapping-math",
]


def build(folder: Path) -> Path:
    """Compile the yardstick unless it is compiled; `MissingError` without a suitable compiler."""
    program = folder / "yardstick"
    sources = [*HERE.glob("*.cpp"), *HERE.glob("*.h")]
    if program.exists() and program.stat().st_mtime > max(source.stat().st_mtime for source in sources):
        return program
    compiler = os.environ.get("CXX") or next(filter(shutil.which, ("g++", "clang++", "c++")), None)
    if compiler is None:
        raise MissingError(f"C++ yardstick: no compiler is installed; {INSTALL}")
    folder.mkdir(parents=True, exist_ok=True)
    command = [*compiler.split(), *FLAGS, *map(str, sorted(HERE.glob("*.cpp"))), "-o", str(program)]
    ran = run(command, text=True)
    if ran.returncode:
        raise MissingError(f"C++ yardstick: {compiler} cannot compile it: {ran.stderr.strip().splitlines()[0]}")
    return program


class Yardstick(System):
    how = "frames on the same terms as miniRT's, in single precision"

    def __init__(self, setting: Setting) -> None:
        super().__init__(setting)
        self.program = build(setting.folder)
        self.name = "C++ yardstick"

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
