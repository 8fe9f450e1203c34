"""Every scene that the reader accepts is packed and previewed without errors and warnings, however extreme its numbers.

`tests/fuzz` makes such scenes, and draws them by the command.
"""

from __future__ import annotations

from contextlib import suppress
from itertools import product

import numpy as np
import pytest

from minirt.element import fields_of
from minirt.errors import ElementError
from minirt.fields import FARTHEST, Direction, Length, Lengths
from minirt.fields.scalars import SMALLEST
from minirt.rendering.kernels import Kernels
from minirt.rendering.packing.materials import encloses
from minirt.rendering.queries.pick import pick, surface_normal
from minirt.rendering.queries.preview import render_interpreted
from minirt.rendering.queries.stiffness import lost_in_single
from minirt.rendering.scene_packing import Packing
from minirt.scene import Camera, Scene
from minirt.shapes import ALL_KINDS, Mesh, Shape
from tests.fuzz.mutations import seeded
from tests.fuzz.scenes import make_extreme, read
from tests.kernel.pictures import LAMP
from tests.seeds import seed_of
from tests.shapes.examples import example

WIDTH, HEIGHT = 8, 6
KINDS = [kind.element for kind in ALL_KINDS if kind.element is not Mesh]
LENGTHS = (SMALLEST, 1e-20, 1.0, FARTHEST)
PRECISIONS = "double", "single"


def pack(scene: Scene) -> None:
    """Pack a scene as for a picture in both precisions, with the notices about it."""
    for precision in PRECISIONS:
        packing = Packing(precision=precision)
        packing.pack(scene, WIDTH, HEIGHT)
        assert list(packing.notes)
        list(lost_in_single(scene, packing, WIDTH, HEIGHT))


def test_kernels_previews_and_clicks_take_extreme_scenes() -> None:
    """The scene is packed as for the process that compiles its kernel, which is not started."""
    seed = seed_of("extreme scenes")
    for number in range(60):
        print(seed, number)  # in the report of a failure
        scene = read(make_extreme(seeded("prepare", seed + number)))
        assert scene
        render_interpreted(scene, WIDTH, HEIGHT)
        if scene.shapes:
            assert all(Kernels(precision, 8).specialised(scene) for precision in PRECISIONS)
            pick(scene, WIDTH, HEIGHT, WIDTH // 2, HEIGHT // 2)


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
