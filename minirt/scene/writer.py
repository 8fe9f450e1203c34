"""Writer of scene files: Scene -> text."""

from __future__ import annotations

import os

from minirt.scene import file_text
from minirt.scene.arguments import check_scene
from minirt.scene.scene import Scene


def dump(scene: Scene) -> str:
    """Return the text of a scene file."""
    return file_text.text_of(scene.pages)


def dumps(scene: Scene) -> str:
    """Return a scene as the text of a file, the same as `Scene.save` writes.

    print(minirt.dumps(scene))
    """
    check_scene(scene, "dumps")
    return dump(scene)


def save(scene: Scene, path: str | os.PathLike[str]) -> None:
    """Write a scene file as a whole or not at all; SceneError when that fails.

    An existing file keeps its permissions, and a symbolic link stays one.
    """
    file_text.write(scene.pages, path)
