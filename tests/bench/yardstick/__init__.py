"""The yardstick: hand-written C++ with SIMD intrinsics for this processor that renders the same pictures."""

from __future__ import annotations

import json
from pathlib import Path

from tests.bench.compiler import compiled
from tests.bench.system import Setting, System
from tests.processes import run

HERE = Path(__file__).parent


class Yardstick(System):
    name = "C++ yardstick"
    how = "frames on the same terms as miniRT's, in single precision"

    def __init__(self, setting: Setting) -> None:
        super().__init__(setting)
        self.program = compiled(setting.folder / "yardstick", [*HERE.glob("*.cpp")], [*HERE.glob("*.h")], self.name)

    def run(self, path: Path, *arguments: str) -> dict[str, float]:
        """Run the program on a scene file and return the figures that it prints."""
        size = f"{self.setting.width}x{self.setting.height}"
        command = [str(self.program), str(path), "--size", size, "--threads", str(self.setting.threads), *arguments]
        ran = run(command, text=True)
        if ran.returncode:
            raise RuntimeError(f"{self.name} on {path}: {ran.stderr}")
        printed: dict[str, float] = json.loads(ran.stdout)
        return printed

    def renders(self, path: Path) -> bool:
        return "\nob " not in path.read_text(encoding="utf-8")

    def frame_times(self, path: Path, seconds: float) -> list[float]:
        return [self.run(path, "--seconds", str(seconds))["ms_median"]]
