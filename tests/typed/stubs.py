"""Stubs for type checkers, made of the registries: names of `minirt`, and the lists of a scene by their kinds."""

from __future__ import annotations

from pathlib import Path

import minirt
from minirt import Scene
from minirt.scene.registry import ELEMENTS
from tests.paths import PACKAGE

HEAD = '"""{}\n\nWritten by python -m tests.make_tables.\n"""\n\n'


def public_names() -> str:
    """The public names that `minirt` imports when they are asked for, each from its module."""
    homes = minirt.HOMES | {name: kind.__module__ for name, kind in minirt.registered().items()}
    lines = sorted(f"from {home} import {name} as {name}" for name, home in homes.items())
    return HEAD.format("The public names of `minirt`.") + "\n".join(lines) + "\n"


def scene_lists() -> str:
    """The lists of a scene that have the name of a kind, such as `spheres`, in the order of the registry."""
    kinds = [kind for kind in ELEMENTS.values() if kind.plural not in vars(Scene)]
    lines = sorted(f"from {kind.__module__} import {kind.__name__}" for kind in kinds)
    lists = [f"    {kind.plural}: tuple[{kind.__name__}, ...]" for kind in kinds]
    head = HEAD.format("The lists of a scene: its elements of each kind.")
    return head + "\n".join([*lines, "", "class ElementLists:", *lists, ""])


def stubs() -> dict[Path, str]:
    """The text of each stub, by its path."""
    return {PACKAGE / "public_names.pyi": public_names(), PACKAGE / "scene" / "element_lists.pyi": scene_lists()}
