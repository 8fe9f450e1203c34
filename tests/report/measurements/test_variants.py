"""What the ablation adds changes no pixel, and is what it says."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from minirt.rendering.packing.features import FEATURES, features
from minirt.report.measurements.variants import Variant, with_more, without_lists
from minirt.scene import Background, FurtherLight, ParallelLight, Scene
from minirt.shapes import ALL_KINDS
from tests.kernel.pictures import ALL, AMBIENT, EYE, LAMP, SHAPES, interpreted

BEHIND = FurtherLight((0, 0, -400), 0.5, (255, 255, 255))  # far behind the eye
PARALLEL = ParallelLight((0, -1, 0), 0.5, (255, 255, 255))


@pytest.mark.parametrize(
    "scene", [ALL, Scene((*ALL.elements, BEHIND, PARALLEL)), Scene((AMBIENT, EYE, LAMP, SHAPES[0]))]
)
def test_each_feature_and_each_kind_is_added_once(scene: Scene, tmp_path: Path) -> None:
    variants, used = list(with_more(scene, tmp_path)), features(scene)
    kinds = {type(shape) for shape in scene.shapes}
    names = [words for key, words in FEATURES.items() if key not in used]
    names += [kind.element.plural for kind in ALL_KINDS if kind.element not in kinds]
    assert [variant.name for variant in variants] == names
    parts = {"tinted glass", "Fresnel's equations"}  # which show no effect without glass
    keys = {words: key for key, words in FEATURES.items()} | {kind.element.plural: kind.element for kind in ALL_KINDS}
    for variant in variants:
        extra = features(variant.scene) - used
        assert keys[variant.name] in extra
        extra -= {"reflective", "transparent"} if variant.name in parts else set()
        assert len(extra) == 1


def variants_that_stay_dark(scene: Scene, folder: Path) -> list[Variant]:
    """Variants whose picture must be the same; a background may be seen."""
    return [each for each in with_more(scene, folder) if "background" not in each.name]


def test_what_is_added_is_behind_the_eye_and_all_lights(tmp_path: Path) -> None:
    for scene in (ALL, Scene((*ALL.elements, BEHIND))):
        forward = np.array(EYE.direction) / np.linalg.norm(EYE.direction)
        least = min(float(np.subtract(light.position, EYE.position) @ forward) for light in scene.lights)
        for variant in variants_that_stay_dark(scene, tmp_path):
            if variant.scene.camera.lens:  # one sample of a lens is that of a pinhole
                continue
            (added,) = variant.scene.elements[len(scene.elements) :]
            corners = added.bounds() if hasattr(added, "bounds") else (added.position,) * 2
            if corners:  # a plane has none, and faces away
                assert max(float(np.subtract(corner, EYE.position) @ forward) for corner in corners) < min(-0.9, least)


def test_the_picture_is_the_same(tmp_path: Path) -> None:
    scene, size = Scene((AMBIENT, EYE, LAMP, *SHAPES[:3])), (32, 16)
    _, right = interpreted(scene, *size)
    chosen = {"highlights", "mirrors and glass", "spots, parallel and fading light", "planes", "triangles", "tori"}
    for variant in variants_that_stay_dark(scene, tmp_path):
        if variant.name in chosen:
            _, light = interpreted(variant.scene, *size)
            assert np.array_equal(light, right), variant.name


def test_a_background_replaces_that_of_the_scene(tmp_path: Path) -> None:
    scene = Scene((*ALL.elements, Background((10, 20, 30))))
    (picture,) = (each for each in with_more(scene, tmp_path) if each.name == FEATURES["environment"])
    (background,) = picture.scene.of(Background)
    assert isinstance(background.paint, str)


def test_lists_of_a_scene() -> None:
    def names(scene: Scene) -> list[str]:
        return [variant.name.split()[0] for variant in without_lists(scene)]

    assert names(ALL) == ["tiles", "light"]
    assert names(Scene((AMBIENT, EYE, *SHAPES))) == ["tiles"]
    assert names(ALL.replace(ALL.shapes[0], mirror=0.5)) == ["tiles", "light", "boxes"]
