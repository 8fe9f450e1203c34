"""Types of the public names: a program that uses all of them runs, and type checkers find no error in it."""

from __future__ import annotations

import inspect
import re
import sys
from pathlib import Path

import numpy as np

import minirt
from minirt import materials, shapes
from minirt.element import fields_of
from minirt.scene import elements
from minirt.scene.registry import ELEMENTS
from tests.paths import ROOT, TESTS
from tests.processes import run

PROGRAM = TESTS / "typed" / "every_name.py"
SETTINGS = {"DEFAULT_ERROR", "DEFAULT_SIZE"}


def test_the_program_uses_every_public_name_but_kinds_that_are_typed_as_others_are() -> None:
    used = set(re.findall(r"minirt\.(\w+)", PROGRAM.read_text(encoding="utf-8")))
    assert used >= set(minirt.__all__) - SETTINGS - set(minirt.registered())
    assert all(used & set(module.PUBLIC) for module in (shapes, materials, elements))
    assert used <= set(minirt.__all__)


def test_the_program_runs(tmp_path: Path) -> None:
    ended = run([sys.executable, str(PROGRAM), str(tmp_path)], cwd=ROOT, text=True)
    assert (ended.returncode, ended.stderr) == (0, "")


def test_every_public_name_has_help() -> None:
    for name in set(minirt.__all__) - SETTINGS - {"Triple"}:
        thing = getattr(minirt, name)
        assert len(inspect.getdoc(thing) or "") >= 30, name
        assert (isinstance(thing, type) and issubclass(thing, Exception)) or inspect.signature(thing), name


def test_help_names_all_fields_with_their_range() -> None:
    for kind in ELEMENTS.values():
        for field in fields_of(kind):
            (line,) = re.findall(rf"^- `{field.name}: .*$", inspect.getdoc(kind) or "", re.MULTILINE)
            assert all(each in line for each in (field.doc, field.range, field.unit)), line


def test_a_representation_is_short_and_makes_the_element_again() -> None:
    ball = minirt.Sphere((0, 0, 5), 2, (255, 0, 0), mirror=0.3)
    shown = "Sphere(centre=(0.0, 0.0, 5.0), diameter=2.0, colour=(255, 0, 0), mirror=Mirror(share=0.3))"
    assert repr(ball) == shown
    assert eval(shown, {name: getattr(minirt, name) for name in minirt.__all__}) == ball
    assert len(repr(minirt.example("demo"))) < 100
    assert len(repr(minirt.Image(np.zeros((3, 4, 3), np.uint8)))) < 100


def test_completion_lists_the_public_names_and_the_plurals_of_a_scene() -> None:
    assert set(dir(minirt)) >= set(minirt.__all__)
    assert {"add", "spheres", "planes", "shapes", "save", "spot_lights"} <= set(dir(minirt.example()))
