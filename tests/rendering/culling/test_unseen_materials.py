"""Materials that no pixel can show are left out, and change no bit of the picture."""

from __future__ import annotations

import numpy as np
import pytest

from minirt.kernel.scene_arrays import SceneArrays
from minirt.materials import Glass, Specular, Tint
from minirt.rendering import Renderer
from minirt.rendering.culling import unseen_materials
from minirt.rendering.scene_packing import Packing
from minirt.scene import FurtherLight, Scene
from minirt.shapes.plane import Plane
from minirt.shapes.sphere import Sphere
from minirt.shapes.square import Square
from tests.kernel.pictures import ALL, EYE, ONE, TWO, interpreted, linear

SIZE = (48, 32)
GREY, SHINY = (128, 128, 128), Specular(0.5, 30.0)
BEHIND = Sphere((1, 2.5, -14), 3.0, GREY, mirror=0.4, specular=SHINY)
HIDDEN = Scene((*ALL.elements, BEHIND))
MIRROR = HIDDEN.shapes[1]  # in the middle of the picture
SHINING = Scene((*ALL.elements, BEHIND.replace(mirror=None)))


def packed(scene: Scene, precision: str = "double") -> SceneArrays:
    return Packing(precision=precision).pack(scene, *SIZE)


def rows(scene: Scene) -> tuple[int, int]:
    """The rows of highlights and of mirrors that the kernel gets."""
    arrays = packed(scene)
    return len(arrays.specular), len(arrays.reflective)


def test_what_is_behind_the_eye_has_no_rows() -> None:
    count = len(HIDDEN.shapes)
    assert rows(HIDDEN) == (0, 0)
    assert rows(HIDDEN.replace(HIDDEN.shapes[2], specular=SHINY)) == (count, 0)
    turned = HIDDEN.replace(EYE, direction=(0, 0, -1))
    assert rows(turned) == (count, count)


@pytest.mark.parametrize("shape", [MIRROR.replace(mirror=0.5), MIRROR.replace(glass=Glass(ior=1.3, share=0.5))])
def test_what_a_mirror_or_glass_may_show_stays(shape: Sphere) -> None:
    """The highlight behind the eye is seen in the mirror: without its rows the picture would be another one."""
    scene = HIDDEN.replace(MIRROR, shape)
    assert rows(scene) == (len(scene.shapes), len(scene.shapes))


def test_a_wrong_rule_would_be_seen(monkeypatch: pytest.MonkeyPatch) -> None:
    """Culling highlights by what the eye alone sees changes the picture in a mirror."""
    wide = BEHIND.replace(specular=Specular(1.0, 1.0), diameter=6.0)
    scene = Scene((*ALL.elements, wide)).replace(MIRROR, mirror=0.9)
    _, right = interpreted(scene, *SIZE)

    def wrong(materials, changed, seen):  # type: ignore[no-untyped-def]
        return materials._replace(specular=materials.specular[:0])

    monkeypatch.setattr("minirt.rendering.scene_packing.without_unseen", wrong)
    _, found = interpreted(Scene(scene.elements), *SIZE)
    assert not np.array_equal(found, right)


@pytest.mark.parametrize(("renderer", "scene"), [(ONE, HIDDEN), (TWO, HIDDEN), (Renderer(1, "single"), SHINING)])
def test_no_bit_of_the_picture_changes(renderer: Renderer, scene: Scene, monkeypatch: pytest.MonkeyPatch) -> None:
    """Also while the eye turns towards what was hidden, and back."""
    turned = scene.replace(EYE, direction=(0.9, 0, -0.4))
    found = [linear(each, *SIZE, 2, renderer) for each in (scene, turned, scene)]
    with monkeypatch.context() as patch:
        patch.setattr("minirt.rendering.scene_packing.without_unseen", lambda materials, changed, seen: materials)
        right = [linear(Scene(each.elements), *SIZE, 2, renderer) for each in (scene, turned, scene)]
    for some, others in zip(found, right, strict=True):
        assert np.array_equal(some, others)


def test_planes_that_reach_into_the_picture_are_seen() -> None:
    floor = Plane((0, -1.5, 0), (0, 1, 0), GREY, mirror=0.5)
    sky = Plane((0, 0, -60), (0, 0, 1), GREY, mirror=0.5)
    assert len(packed(Scene((*ALL.elements, floor))).reflective) == len(ALL.shapes) + 1
    assert len(packed(Scene((*ALL.elements, sky))).reflective) == 0


def test_single_precision() -> None:
    assert packed(SHINING, "single").specular.shape == (0, 3)
    assert packed(SHINING, "single").specular.dtype == np.float32


def test_light_shines_through_glass_that_is_not_seen() -> None:
    """A pane behind the eye, before the lamp: without its rows its shadow would be black."""
    lamp = FurtherLight((1, 3, -30), 1.0, (255, 255, 255))
    pane = Square((1, 2.5, -14), (0, 0, 1), 30, GREY, glass=Glass(1.0, 0.5), tint=Tint((255, 128, 0)))
    dark, lit = (
        interpreted(Scene((*ALL.elements, lamp, *more)), *SIZE)[1] for more in ((pane.replace(glass=None),), (pane,))
    )
    bright = interpreted(Scene((*ALL.elements, lamp)), *SIZE)[1]
    assert len(packed(Scene((*ALL.elements, lamp, pane))).reflective) == 0
    assert np.allclose(lit - dark, (bright - dark) * 0.5 * np.divide((255, 128, 0), 255), atol=1e-12)
    assert (lit != dark).any()


def test_the_notes_tell() -> None:
    packing = Packing()
    packing.pack(HIDDEN, *SIZE)
    assert {"no pixel can show highlights: skipped", "no pixel can show mirrors and glass: skipped"} <= {*packing.notes}


def test_effective_materials() -> None:
    nothing = unseen_materials.Materials()
    assert unseen_materials.effective(nothing) == (None, None)
    assert unseen_materials.without_unseen(nothing, unseen_materials.effective(nothing), np.arange(3)) is nothing
