"""Render the golden pictures again, with the reference renderer: `python -m tests.make_goldens`.

Look at each of them afterwards: the tests compare the program with them.
"""

from __future__ import annotations

from pathlib import Path

from minirt.rendering.image import Image
from minirt.scene import Scene, load
from tests.compare import Bytes
from tests.paths import scene_files
from tests.reference import render, to_bytes

GOLDENS = Path(__file__).parent / "goldens"
# The first is another scene's twin, the second takes the reference renderer half an hour, and the third has a mesh of
# glass, which that does not draw.
WITHOUT = {"subject-as-printed", "gallery-teapot", "gallery-table"}
SCENES = sorted(path for path in scene_files() if path.stem not in WITHOUT)
SIZE = (320, 180)


def golden(scene: Scene) -> Bytes:
    """Render the golden picture of a scene."""
    return to_bytes(render(scene, *SIZE), scene.camera.tone)


if __name__ == "__main__":
    for old in GOLDENS.glob("*.png"):
        old.unlink()
    for path in SCENES:
        Image(golden(load(path).scene)).save(GOLDENS / f"{path.stem}.png")
