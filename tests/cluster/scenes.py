"""Scenes of these tests."""

from __future__ import annotations

from pathlib import Path

import minirt
from minirt import Scene
from tests.cli.program import SCENE

BALL = minirt.loads(SCENE)


def with_files(folder: Path) -> Scene:
    """A scene with two copies of a picture, one of them in a folder beside, and with a mesh."""
    inner = folder / "scenes"
    inner.mkdir(parents=True)
    picture = minirt.render(BALL, 20, 10)
    picture.save(folder / "beside.png")
    picture.save(inner / "copy.png")
    (inner / "corner.obj").write_text("v 0 0 0\nv 2 0 0\nv 0 2 0\nv 0 0 2\nf 1 2 3\nf 1 3 4\nf 1 4 2\nvn 0 0 1\n")
    (inner / "all.rt").write_text(
        SCENE
        + "bg copy.png\n"
        + "sp -1,1,1 2 255,255,255 texture:../beside.png bump:copy.png,0.05 mirror:0.2\n"
        + "ob corner.obj 0.5,0,0 1 200,100,50\n"
    )
    return minirt.load(inner / "all.rt")
