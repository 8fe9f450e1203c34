"""Ray tracers that are programs: a scene is translated to their language, and they tell how long it took."""

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
    """Red, green and blue of a source in [0, 1], its brightness included; black where there is none."""
    if source is None:
        return 0.0, 0.0, 0.0
    red, green, blue = (source.brightness * level / 255 for level in source.colour)
    return red, green, blue


def words(numbers: Iterable[float]) -> list[str]:
    """Numbers as they are written, without negative zeros."""
    return [f"{number + 0.0:.9g}" for number in numbers]


def ends(cylinder: Cylinder) -> tuple[Triple, Triple]:
    """The middles of bottom and top."""
    (x, y, z), (u, v, w), half = cylinder.centre, cylinder.axis, cylinder.height / 2
    return (x - half * u, y - half * v, z - half * w), (x + half * u, y + half * v, z + half * w)


class Command(System):
    """A ray tracer that is started for each frame. `MissingError` where it is not on the path."""

    command: str
    suffix: str
    translate: Callable[[Scene, int, int], Iterator[str]]

    def __init__(self, setting: Setting) -> None:
        super().__init__(setting)
        if not shutil.which(self.command):
            raise MissingError(f"{self.name}: {self.command} is not installed; {INSTALL}")

    @abstractmethod
    def arguments(self, file: Path, picture: Path) -> list[str]:
        """Of the command that renders a file into a picture."""

    @abstractmethod
    def milliseconds(self, printed: str) -> float:
        """What the command says that rendering took."""

    def frame_times(self, path: Path, seconds: float) -> list[float]:
        width, height, _, folder = self.setting
        file = folder / f"{path.stem}{self.suffix}"
        file.write_text("\n".join(self.translate(load(path), width, height)) + "\n", encoding="ascii")
        ran = run([self.command, *self.arguments(file, self.picture(path))], text=True)
        if ran.returncode:
            raise RuntimeError(f"{self.name} on {file}: {ran.stderr or ran.stdout}")
        return [self.milliseconds(ran.stdout + ran.stderr)]
