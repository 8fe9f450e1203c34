"""Checks of the arguments of functions that take scenes and elements."""

from __future__ import annotations

import os

from minirt.element import Element


def check_elements(function: str, *elements: object) -> None:
    """TypeError, which names what a function got in place of an element of a scene."""
    for each in elements:
        if not isinstance(each, Element):
            is_list = isinstance(each, list | tuple)
            found = (
                f"a {type(each).__name__}: {function}(*elements) takes them one by one" if is_list else f"{each!r:.60}"
            )
            raise TypeError(f"{function} takes elements such as minirt.Sphere, got {found}")


def check_scene(scene: object, function: str) -> None:
    """TypeError, which says how to load a scene, where a function got the name of its file."""
    if isinstance(scene, (str, os.PathLike)):
        name = os.fspath(scene)
        raise TypeError(f"minirt.{function} takes a scene, got the name of a file: use minirt.load({name!r})")
