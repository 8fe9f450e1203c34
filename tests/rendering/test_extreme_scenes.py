"""Every scene that the reader accepts is packed and previewed without errors and warnings, however extreme its numbers.

`tests/fuzz` draws such scenes by the command.
"""

from __future__ import annotations

from contextlib import suppress
from itertools import product

import numpy as np
import pytest
from hypothesis import given, reject, settings
from hypothesis import strategies as st

from minirt.element import Element, fields_of
from minirt.errors import ElementError
from minirt.fields import FARTHEST, SMALLEST, Direction, Field, Length, Lengths, Point
from minirt.rendering.kernels import Kernels
from minirt.rendering.packing.materials import encloses
from minirt.rendering.queries.pick import pick, surface_normal
from minirt.rendering.queries.preview import render_interpreted
from minirt.rendering.queries.stiffness import lost_in_single
from minirt.rendering.scene_packing import Packing
from minirt.scene import Ambient, Camera, Light, Scene
from minirt.shapes import ALL_KINDS, Shape
from minirt.shapes.mesh import Mesh
from tests.kernel.pictures import LAMP
from tests.scene.strategies import SCENES, values
from tests.shapes.examples import example

WIDTH, HEIGHT = 8, 6
SEEDED = settings(max_examples=100, derandomize=True)
KINDS = [kind.element for kind in ALL_KINDS if kind.element is not Mesh]
LENGTHS = (SMALLEST, 1e-20, 1.0, FARTHEST)
PRECISIONS = "double", "single"

POINTS = ((0.0, 0.0, 0.0), (0.0, 0.0, 5.0), (5e-324, -5e-324, 0.0), (FARTHEST, -FARTHEST, FARTHEST))
DIRECTIONS = ((0.0, 1.0, 0.0), (0.0, 0.6, -0.8), (5e-324, 0.0, 1.0), (1e-160, 1e-160, 1e-160), (0.0, 5e-324, 0.0))


def pack(scene: Scene) -> None:
    """Pack a scene as for a picture in both precisions, with the notices about it."""
    for precision in PRECISIONS:
        packing = Packing(precision=precision)
        packing.pack(scene, WIDTH, HEIGHT)
        assert list(packing.notes)
        list(lost_in_single(scene, packing, WIDTH, HEIGHT))


def prepare(scene: Scene) -> None:
    """Pack a scene as for the process that compiles its kernel, which is not started."""
    for precision in PRECISIONS:
        assert Kernels(precision, 8).specialised(scene)


def pick_middle(scene: Scene) -> None:
    """Find the shape in the middle of a picture."""
    pick(scene, WIDTH, HEIGHT, WIDTH // 2, HEIGHT // 2)


def strategy(field: Field) -> st.SearchStrategy[object]:
    """Return a strategy for the values of a field, many of which are at the ends of its range."""
    if isinstance(field, Lengths):
        return st.tuples(*[st.sampled_from(LENGTHS)] * 3)
    ends = {Length: LENGTHS, Point: POINTS, Direction: DIRECTIONS}.get(type(field), ())
    return st.sampled_from(ends) | values(field) if ends else values(field)


@st.composite
def positional(draw: st.DrawFn, kind: type[Element]) -> Element:
    """Draw an element of a kind without attributes."""
    try:
        return kind(**{field.name: draw(strategy(field)) for field in fields_of(kind) if not field.keyed})
    except ElementError:
        reject()


ONE_OF_EACH = st.tuples(*map(positional, (Camera, Ambient, Light, *KINDS))).map(Scene)  # all need the same kernel


@given(SCENES | ONE_OF_EACH)
@SEEDED
def test_extreme_scenes_are_packed_without_warnings(scene: Scene) -> None:
    if scene.shapes:
        pack(scene)
        prepare(scene)
        pick_middle(scene)


@given(SCENES)
@settings(max_examples=30, derandomize=True)
def test_extreme_scenes_have_a_preview(scene: Scene) -> None:
    render_interpreted(scene, WIDTH, HEIGHT)


@pytest.mark.parametrize("kind", KINDS, ids=lambda kind: kind.code)
def test_lengths_may_be_as_small_and_as_large_as_the_reader_allows(kind: type[Shape]) -> None:
    camera = Camera((0, 0, -5), (0, 0, 1), 60)
    base = example(next(each for each in ALL_KINDS if each.element is kind), np.random.default_rng(1))
    aslant = {field.name: (0.1, 0.7, -0.7) for field in fields_of(kind) if isinstance(field, Direction)}
    fields = [field for field in fields_of(kind) if isinstance(field, Length | Lengths) and not field.keyed]
    values_of = [list(product(LENGTHS, repeat=3)) if isinstance(field, Lengths) else LENGTHS for field in fields]
    for lengths in product(*values_of):
        with suppress(ElementError):  # such as a tube thicker than its ring
            shape = base.replace(
                **aslant, **{field.name: length for field, length in zip(fields, lengths, strict=True)}
            )
            pack(Scene((camera, LAMP, shape)))
            encloses(shape, np.ones(3))
            surface_normal(shape, (0, 1, 0), (0, 0, 1))
