"""Stiff scenes are found, with figures worked out by hand; easy scenes are not reported."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import minirt
from minirt.fields import MeshFile
from minirt.kernel.frame import ray_direction
from minirt.rendering.notices import notices_about
from minirt.rendering.packing.camera import pixel_rays
from minirt.rendering.packing.shape_arrays import ShapeArrays
from minirt.rendering.queries.stiffness import ACROSS, DOWN, Stiff, coincident, stiff_shapes
from minirt.rendering.scene_packing import Packing
from minirt.scene import Ambient, Camera, Light, Scene
from minirt.shapes import Cylinder, Disc, Mesh, Plane, Shape, Sphere, Square
from tests.paths import SCENES

GREY, RED = (128, 128, 128), (255, 0, 0)
EYE = Camera((0, 0, 0), (0, 0, 1), 90)
DOUBLE, SINGLE = 2.0**-53, 2.0**-24
HIT = "relative rounding of a hit, double"


def tables_of(scene: Scene) -> ShapeArrays:
    tables = ShapeArrays()
    tables.update(scene.shapes)
    return tables


def stiff(*shapes: Shape, eye: Camera = EYE) -> list[Stiff]:
    scene = Scene((eye, *shapes))
    return list(stiff_shapes(scene, tables_of(scene), 1000, 1000))


def close(*shapes: Shape) -> list[Stiff]:
    scene = Scene((EYE, *shapes))
    return list(coincident(scene, tables_of(scene)))


@pytest.mark.parametrize("name", ["demo", "subject", "figure-v4-everything", "eval-shadows-many"])
def test_usual_scenes_are_not_stiff(name: str) -> None:
    scene = minirt.load(SCENES / f"{name}.rt")
    tables = tables_of(scene)
    assert list(stiff_shapes(scene, tables, 1280, 720)) == []
    assert list(coincident(scene, tables)) == []


def test_tiny_and_far() -> None:
    small, thin = stiff(Sphere((0, 0, 1e6), 1e-6, GREY))
    assert (small.element, small.why) == ("sphere 1", "small for its coordinates or its distance")
    assert small.figures["size"] == 1e-6
    assert small.figures["distance"] == pytest.approx(1e6)
    # 16 roundings of the point (1e6) and of the shape's largest coordinate (1e6), seen from 0, over 1e-6.
    assert small.figures[HIT] == pytest.approx(16 * DOUBLE * 2e6 / 1e-6)
    assert small.figures["single"] == pytest.approx(16 * SINGLE * 2e6 / 1e-6)
    # At 90 degrees and distance 1 the picture is 2 wide: a pixel is 2e-3, here times 1e6.
    assert thin.figures == {"pixels": pytest.approx(1e-6 / 2e3)}


def test_squares_of_tiny_lengths_leave_the_range_of_float32() -> None:
    (tiny,) = stiff(Sphere((0, 0, 6e-24), 2e-24, GREY))
    assert tiny.figures["single"] == np.inf
    assert tiny.figures[HIT] < 1e-13
    assert stiff(Sphere((0, 0, 6e-15), 2e-15, GREY)) == []


def test_far_from_the_origin_only_double_suffers() -> None:
    at = 1e13
    (far,) = stiff(Sphere((at, 0, 5), 2, GREY), eye=Camera((at, 0, 0), (0, 0, 1), 90))
    assert far.figures[HIT] == pytest.approx(16 * DOUBLE * 3 * at / 2, rel=1e-3)
    assert far.figures["single"] < 1e-4  # which is relative to the eye


def test_close_above_something_huge() -> None:
    (huge,) = stiff(Sphere((0, -5e8 - 1.7, 0), 1e9, GREY))
    assert huge.why == "the eye is close to it for its size"
    assert huge.figures["distance"] == pytest.approx(1.7, rel=1e-6)
    assert 1e-7 < huge.figures[HIT] < 1e-5
    assert huge.figures["single"] > 100


def test_an_eye_on_a_plane() -> None:
    (on,) = stiff(Plane((0, 0, 9), (0, 1, 0), GREY))
    assert on.element == "plane 1"
    assert on.figures[HIT] == np.inf


def test_the_plane_that_a_disc_lies_in_is_not_the_disc() -> None:
    level = (0, 1, 0)
    assert stiff(Disc((0, 0, 9), level, 2, GREY), Square((3, 0, 9), level, 2, GREY)) == []
    (within,) = stiff(Disc((0, 0, 9), level, 20, GREY))
    assert within.figures["distance"] == 0


def test_a_mesh_is_one_shape(tmp_path: Path) -> None:
    # Two small triangles far apart, which are no smaller than the mesh; an eye on one of them.
    corners = "v 0 0 0\nv 1e-6 0 0\nv 0 0 1e-6\nv 9 9 9\nv 9.000001 9 9\nv 9 9.000001 9\n"
    (tmp_path / "two.obj").write_text(corners + "f 1 2 3\nf 4 5 6\n")
    mesh = Mesh(MeshFile(str(tmp_path / "two.obj")), (0, 0, 5), 1, GREY)
    assert stiff(mesh) == []
    assert close(mesh, Mesh(mesh.file, (0, 0, 7), 1, GREY)) == []
    (on,) = stiff(Sphere((0, 9, 9), 1, GREY), mesh.replace(position=(0, 0, 0)))
    assert (on.element, on.figures["distance"]) == ("mesh 1", 0)


def test_thin_things_count_by_their_shortest_length() -> None:
    _, wire = stiff(Cylinder((0, 0, 50), (0, 1, 0), 0.01, 40, GREY))
    assert wire.why.startswith("thinner than a pixel")
    assert wire.figures["pixels"] == pytest.approx(0.01 / (49.995 * 2e-3))
    behind = stiff(Cylinder((0, 0, -50), (0, 1, 0), 0.01, 40, GREY))
    assert not any("pixels" in each.figures for each in behind)


def test_the_worst_come_first_and_not_all_of_them() -> None:
    many = stiff(*(Sphere((0, 0, 10), 1e-3 / 2**i, GREY) for i in range(30)))
    thin = [each for each in many if "pixels" in each.figures]
    assert [each.element for each in thin] == ["sphere 30", "sphere 29", "sphere 28 and 27 more"]
    assert thin[0].figures["pixels"] < thin[1].figures["pixels"] < thin[2].figures["pixels"]
    few = [each for each in stiff(*(Sphere((0, 0, 10), 1e-3, GREY),) * 3) if "pixels" in each.figures]
    assert [each.element for each in few] == ["sphere 1", "sphere 2", "sphere 3"]


def test_planes_in_one_place() -> None:
    (same,) = close(Plane((0, 0, 9), (0, 0, 1), GREY), Plane((3, 1, 9), (0, 0, -1), RED))
    assert same.element == "plane 1 and plane 2"
    assert same.why == "taken for one surface in double and single precision: the first is shown"
    assert same.figures["share of the picture"] == 1
    assert same.figures["gap"] < 1e-14


def test_planes_that_only_float32_takes_for_one() -> None:
    (near,) = close(Plane((0, 0, 9), (0, 0, 1), GREY), Plane((0, 0, 9 + 1e-6), (0, 0, 1), RED))
    assert near.why == "taken for one surface in single precision: the first is shown"
    assert near.figures["gap"] == pytest.approx(1e-6, rel=1e-6)
    assert near.figures["in roundings, single"] < 1 < near.figures["in roundings, double"]
    assert close(Plane((0, 0, 9), (0, 0, 1), GREY), Plane((0, 0, 9.1), (0, 0, 1), RED)) == []


@pytest.mark.parametrize(("gap", "told"), [(1e-5, True), (1e-2, False), (0.0, False)])  # 0: in float64, too
def test_a_picture_in_single_precision_tells_surfaces_that_only_float32_takes_for_one(gap: float, told: bool) -> None:
    floor = Square((0, 0, 9), (0, 0, -1), 8, GREY)
    carpet = Square((0, 0, 9 - gap), (0, 0, -1), 5, RED)
    scene, packing = Scene((Ambient(1, GREY), EYE, Light((0, 0, -9), 1), floor, carpet)), Packing(precision="single")
    packing.pack(scene, 64, 36)
    notices = list(notices_about(scene, np.eye(36, 64, dtype=np.uint8)[..., None] * 255, (64, 36), packing))
    start = "single precision cannot show square 1 and square 2: taken for one surface in single precision"
    assert [each.startswith(start) for each in notices] == [True] * told


def test_a_cap_on_a_wall_is_found_and_surfaces_that_cross_are_not() -> None:
    wall = Plane((0, 0, 9), (0, 0, -1), GREY)
    (cap,) = close(wall, Cylinder((0, 0, 10), (0, 0, 1), 6, 2, RED))
    assert cap.element == "plane 1 and cylinder 1"
    assert cap.figures["share of the picture"] == pytest.approx(np.pi * 9 / (18 * 18 * DOWN / ACROSS), rel=0.05)
    camera = pixel_rays(EYE, ACROSS, DOWN)
    way = ray_direction(camera, 40.5, 10.5)  # one of the rays that are tried, onto the line where both planes cross
    across = Plane((9 * way.x, 9 * way.y, 9 * way.z), (0.3, 0.4711, -0.8), RED)
    assert close(wall, Sphere((0, 0, 9), 6, RED), across) == []
