"""Writers of every sort of file that is replaced as a whole: pictures, films, scenes, reports."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np

from minirt.formats.table import FORMATS, is_installed
from minirt.image import Image
from minirt.movie import save_movie
from minirt.report.document import write_files
from minirt.scene import parse
from tests.formats.pictures import picture
from tests.report.made_up import FINDINGS, ROWS

Writer = Callable[[Path], object]  # writes into an empty folder, or one in which it has written before

SIZE = HEIGHT, WIDTH = 18, 32
SCENE = "A 1 255,255,255\nC 0,0,0 0,0,1 60\n" + "".join(f"sp 0,0,{n} 4 10,20,30\n" for n in range(5, 90))
BLACK = np.zeros((20, 32, 3))


def still(suffix: str) -> Writer:
    """Return a writer of a picture."""
    return lambda folder: picture(*SIZE).save(folder / f"still{suffix}")


def film(suffix: str) -> Writer:
    """Return a writer of a film, or of numbered pictures."""

    def write(folder: Path) -> None:
        levels = picture(*SIZE).array
        save_movie((Image(np.roll(levels, 5 * n, axis=1)) for n in range(4)), folder / f"film{suffix}")

    return write


def scene(folder: Path) -> None:
    """Save a scene, as the editor does."""
    parse(SCENE, "scene.rt").scene.save(folder / "scene.rt")


def report(folder: Path) -> None:
    """Write the report of a scene."""
    write_files(folder, FINDINGS, {ROWS[0].name: BLACK}, BLACK)


def writers() -> dict[str, Writer]:
    """Return the writers by the names of what they write."""
    found: dict[str, Writer] = {"scene": scene, "report": report, "numbered": film(".png")}
    for name, each in FORMATS.items():
        if is_installed(name):
            if each.is_still:
                found[f"{name} still"] = still(each.suffixes[0])
            if each.is_film:
                found[f"{name} film"] = film(each.suffixes[0])
    return found
