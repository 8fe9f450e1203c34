"""Check of the scene that a function of the library is given."""

from __future__ import annotations

import os


def check_scene(scene: object, function: str) -> None:
    """TypeError, which says how to load a scene, where a function got the name of its file."""
    if isinstance(scene, (str, os.PathLike)):
        raise TypeError(
            f"minirt.{function} takes a scene, got the name of a file: use minirt.load({os.fspath(scene)!r})"
        )
