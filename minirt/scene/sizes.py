"""Sizes of the picture of a scene."""

from __future__ import annotations

from minirt.errors import check_whole
from minirt.scene.elements import DEFAULT_SIZE
from minirt.scene.scene import Scene


def size_of(scene: Scene) -> tuple[int, int]:
    """Width and height in pixels that a scene asks for, or the default."""
    return (scene.resolution.width, scene.resolution.height) if scene.resolution else DEFAULT_SIZE


def size_for(scene: Scene, width: int | None, height: int | None) -> tuple[int, int]:
    """The size of a picture of a scene: its own where none is asked for, and of its proportions where one side is.
    RenderError for an empty one."""
    own_width, own_height = size_of(scene)
    if width is not None:
        width = check_whole("width", width, 1)
    if height is not None:
        height = check_whole("height", height, 1)
    if width is None:
        width = own_width if height is None else max(1, round(height * own_width / own_height))
    return width, max(1, round(width * own_height / own_width)) if height is None else height
