"""Peers that are programs: translate a scene to their language, run them, and read the time that they print."""

from __future__ import annotations

import shutil
from abc import abstractmethod
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path

from minirt import load
from minirt.fields import Triple
from minirt.scene import Ambient, Light, Scene
from minirt.shapes.cylinder import Cylinder
from tests.bench.system import INSTALL, MissingError, Setting, System
from tests.processes import run


def light(source: Ambient | Light | None) -> Triple:
    """Return the radiance of a light source, red green blue in [0, 1]; black for None."""
    if source is None:
        return 0.0, 0.0, 0.0
    red, green, blue = (source.brightness * level / 255 for level in source.colour)
    return red, green, blue


def words(numbers: Iterable[float]) -> list[str]:
    """Format numbers, without negative zeros."""
    return [f"{number + 0.0:.9g}" for number in numbers]


def ends(cylinder: Cylinder) -> tuple[Triple, Triple]:
    """Return the centres of the bottom and the top cap."""
    (x, y, z), (u, v, w), half = cylinder.centre, cylinder.axis, cylinder.height / 2
    return (x - half * u, y - half * v, z - half * w), (x + half * u, y + half * v, z + half * w)


class Command(System):
    """A ray tracer that is started for each frame; `MissingError` if it is not on the PATH."""

    command: str
    suffix: str
    translate: Callable[[Scene, int, int], Iterator[str]]

    def __init__(self, setting: Setting) -> None:
        super().__init__(setting)
        if not shutil.which(self.command):
            raise MissingError(f"{self.name}: {self.command} is not installed; {INSTALL}")

    @abstractmethod
    def arguments(self, file: Path, picture: Path) -> list[str]:
        """Return the arguments of the command that renders a file into a picture."""

    @abstractmethod
    def milliseconds(self, printed: str) -> float:
        """Read the render time from the command's output."""

    def prepared(self, path: Path) -> list[str]:
        """Translate a scene and return the command that renders it."""
        width, height, _, folder = self.setting
        file = folder / f"{path.stem}-{width}x{height}{self.suffix}"
        file.write_text("\n".join(self.translate(load(path), width, height)) + "\n", encoding="ascii")
        return [self.command, *self.arguments(file, self.picture(path))]

    def frame_times(self, path: Path, seconds: float) -> list[float]:
        ran = run(self.prepared(path), text=True)
        if ran.returncode:
            raise RuntimeError(f"{self.name} on {path}: {ran.stderr or ran.stdout}")
        return [self.milliseconds(ran.stdout + ran.stderr)]
