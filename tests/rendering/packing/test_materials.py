"""Packing of materials, textures and environment maps."""

from __future__ import annotations

from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from PIL import Image as pillow  # noqa: N813

from minirt.element import fields_of
from minirt.errors import FileError
from minirt.materials import (
    Attributes,
    Bump,
    Checker,
    Clouds,
    Compound,
    Glass,
    Marble,
    Mirror,
    Placement,
    Specular,
    Tint,
    Wood,
)
from minirt.rendering.packing.features import FEATURES, features, shape_features
from minirt.rendering.packing.materials import pack_materials
from minirt.rendering.packing.shape_arrays import ShapeArrays
from minirt.rendering.settings import render
from minirt.scene import Ambient, Background, Camera, FurtherLight, Light, ParallelLight, Scene, SpotLight, load
from minirt.shapes import Plane, Shape, Sphere
from tests.kernel.pictures import EYE

GREY = (128, 128, 128)
BALL = Sphere((0, 0, 0), 1, GREY)


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """Two images: one of three channels, 3 x 2, and one of 16 bits, 2 x 1."""
    pillow.fromarray(np.arange(18, dtype=np.uint8).reshape(2, 3, 3)).save(tmp_path / "a.png")
    pillow.fromarray(np.array([[0, 65535]], np.uint16)).save(tmp_path / "b.png")
    return tmp_path


def scene_of(folder: Path, *shapes: Shape) -> Scene:
    return Scene((Camera((0, 0, -9), (0, 0, 1), 60), *shapes), folder / "scene.rt")


def arrays_of(*shapes: Shape) -> ShapeArrays:
    arrays = ShapeArrays()
    arrays.update(shapes)
    return arrays


def materials_of(scene: Scene) -> Any:
    """The packed materials of the primitives of a scene, by the names of their fields."""
    return SimpleNamespace(**pack_materials(scene, arrays_of(*scene.shapes), features(scene)))


def test_every_material_names_a_feature() -> None:
    for field in fields_of(Attributes):
        feature = field.record.feature if isinstance(field, Compound) else field.feature
        assert feature in FEATURES, f"{field.name} needs a feature in minirt/rendering/packing/features.py"


def test_a_material_that_no_face_uses_changes_nothing(tmp_path: Path) -> None:
    """Wherever its mesh stands in the scene, and whatever the material is."""
    every = "pattern:marble,0.5 checker:2 specular:1,9 glow:1 mirror:0.5 glass:1.5,0.2,3 tint:9,8,7 fresnel uv:2,2"
    corners = "v 0 0 0\nv 1 0 0\nv 0 1 0\n"
    (tmp_path / "a.mtl").write_text("newmtl red\nKd 1 0 0\nnewmtl none\nKd 0 1 0\nd 0.5\nKs 1 1 1\nNs 9\nillum 3\n")
    texts = (
        "",
        f"mtllib a.mtl\n{corners}usemtl red\nf 1 2 3\n",
        f"mtllib a.mtl\n{corners}usemtl none\nusemtl red\nf 1 2 3\n",
    )
    lines = "A 0.5 255,255,255", "C 0,0,-3 0,0,1 60", f"ob a.obj 0,0,0 1 255,255,255 {every}", "sp 0,0,9 1 9,9,9"
    for order in (lines, lines[::-1]):
        pictures = []
        for text in (*texts[1:], texts[1] + "usemtl none\n"):
            (tmp_path / "a.obj").write_text(text)
            (tmp_path / "a.rt").write_text("\n".join(order))
            pictures.append(render(load(tmp_path / "a.rt").scene, 16, 12).array)
        assert pictures[0].any()
        assert all(np.array_equal(each, pictures[0]) for each in pictures)


def test_each_image_is_packed_once(folder: Path) -> None:
    scene = scene_of(
        folder,
        BALL.replace(texture="a.png", bump=Bump("b.png", 0.5)),
        BALL,
        BALL.replace(texture="a.png", normal_map="a.png", bump=Bump("b.png", 0.0)),
    )
    maps = materials_of(scene).surface_maps
    assert np.array_equal(maps.textures, [1, 0, 1])
    assert np.array_equal(maps.bumps, [[2, 0.5], [0, 0], [0, 0]])
    assert np.array_equal(maps.normals, [0, 0, 1])
    assert np.array_equal(maps.used, [1, 0, 1])
    assert np.array_equal(maps.pictures, [[0, 3, 2, 3], [18, 2, 1, 1]])
    assert np.allclose(maps.texels, [*(np.arange(18) / 255), 0, 1], atol=1e-7)


def test_triangles_that_move_keep_their_rows_and_other_materials_replace_them(tmp_path: Path) -> None:
    (tmp_path / "a.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 1 2 4\n")
    lines = "A 0.2 9,9,9", "C 0,0,-3 0,0,1 60", "sp 0,0,9 1 9,9,9", "ob a.obj 0,0,0 1 9,9,9 mirror:0.5", ""
    (tmp_path / "a.rt").write_text("\n".join(lines))
    scene = load(tmp_path / "a.rt").scene
    ball, mesh = scene.shapes
    arrays = arrays_of(ball, mesh)

    def mirrors() -> np.ndarray:
        packed: np.ndarray = pack_materials(scene, arrays, {"reflective"})["reflective"]
        return packed

    before = mirrors()
    assert before[:, 0].tolist() == [0, 0.5, 0.5]
    arrays.update((ball, mesh.replace(position=(0, 1, 0))))
    assert mirrors() is before
    arrays.update((ball, mesh.replace(mirror=Mirror(0.25))))
    assert mirrors()[:, 0].tolist() == [0, 0.25, 0.25]
    arrays.update((mesh, ball))
    assert mirrors()[:, 0].tolist() == [0.5, 0.5, 0]


def test_a_missing_image_is_named(tmp_path: Path) -> None:
    scene = scene_of(tmp_path, BALL.replace(texture="gone.png"))
    with pytest.raises(FileError, match=r"gone\.png"):
        materials_of(scene)


# The features that a scene uses.


LIGHT = Ambient(0.2, GREY)
SUN = ParallelLight((0, -1, 0), 0.5)


def features_of(*elements: object) -> set[object]:
    return set(features(Scene((LIGHT, EYE, *elements))))  # type: ignore[arg-type]


def test_a_plain_scene_uses_only_its_kinds() -> None:
    assert features_of(BALL, Plane((0, 0, 0), (0, 1, 0), GREY), Light((0, 9, 0), 1)) == {Sphere, Plane}


def test_each_feature_is_found_where_it_is_used() -> None:
    assert features_of(BALL.replace(specular=Specular(0.5, 20))) == {Sphere, "specular"}
    assert features_of(BALL.replace(mirror=0.5)) == {Sphere, "reflective"}
    assert features_of(BALL.replace(mirror=Mirror(0.5, 9.0))) == {Sphere, "reflective", "fades"}
    assert features_of(BALL.replace(mirror=0.5, fresnel=1.0)) == {Sphere, "reflective", "fresnel"}
    glass = BALL.replace(glass=Glass(1.5))
    assert features_of(glass) == {Sphere, "reflective", "transparent"}
    assert features_of(glass.replace(glass=Glass(1.5, fade=9.0))) == {Sphere, "reflective", "transparent", "fades"}
    assert features_of(glass.replace(tint=Tint((9, 9, 9)))) == {Sphere, "reflective", "transparent", "media"}
    assert features_of(BALL.replace(glow=0.5)) == {Sphere, "glow"}
    assert features_of(BALL.replace(checker=Checker(0.5)), BALL) == {Sphere, "checks"}
    assert features_of(BALL.replace(marble=Marble(1.0), wood=Wood(1.0))) == {Sphere, "patterns"}
    assert features_of(BALL.replace(clouds=Clouds(1.0, height=0.1))) == {Sphere, "raised_patterns"}
    assert features_of(Background((0, 0, 9))) == {"background"}
    assert features_of(SUN) == {"spots", "parallel"}
    assert features_of(SpotLight((0, 9, 0), (0, -1, 0), 40, 1)) == {"spots"}
    assert features_of(FurtherLight((0, 9, 0), 1, fade=5.0)) == {"spots"}


FLOOR = Plane((0, 0, 0), (0, 1, 0), GREY)
GLOBE = BALL.replace(checker=Checker(0.125))


def test_the_kernel_has_the_feature_only_where_a_picture_is_placed() -> None:
    scaled = Placement(2, 2)
    assert "placements" in shape_features(GLOBE.replace(uv=scaled))
    assert "placements" not in shape_features(GLOBE.replace(uv=Placement(1, 1)))
    assert "placements" in shape_features(GLOBE.replace(axis=(1, 0, 0)))
    assert "placements" in shape_features(GLOBE.replace(roll=-90.0))
    assert "placements" not in shape_features(GLOBE.replace(roll=360.0))
    assert "placements" not in shape_features(GLOBE.replace(checker=None, specular=Specular(0.5, 9), roll=5.0))
    assert "placements" not in shape_features(GLOBE.replace(checker=None, marble=Marble(1.0), roll=5.0))
    assert "placements" not in shape_features(FLOOR.replace(checker=Checker(1), roll=5.0))


def test_elements_without_effect_use_no_feature() -> None:
    no_effect = BALL.replace(specular=Specular(0, 20), mirror=Mirror(0.0, 9.0), glass=Glass(1.5, 0), glow=0.0)
    needs_more = BALL.replace(tint=Tint((9, 9, 9)), fresnel=1.0)
    black = SpotLight((0, 9, 0), (0, -1, 0), 40, 0), ParallelLight((0, -1, 0), 1, (0, 0, 0))
    assert features_of(no_effect, Background((0, 0, 0)), *black, needs_more) == {Sphere}
