"""Buffers and camera rays, compared with the reference renderer, which shares no formula with them."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import minirt
from minirt.rendering.buffers import Buffers
from tests import reference
from tests.reference.hits import first_hits
from tests.reference.texturing import colour_and_normal
from tests.reference.uv_mapping import normals, placed, surface_point

SIZE = (48, 32)
WHITE = (255, 255, 255)
CAMERA = minirt.Camera((0.3, 0.2, -4), (0.1, 0, 1), 55, roll=20)
TURNED = minirt.Sphere(
    (0, 0, 1), 3, (200, 90, 30), axis=(0.6, 0.8, 0), roll=30, uv=minirt.Placement(2, 3, 0.1, 0.2, 40)
)
MADE = minirt.Scene((minirt.Ambient(0.1, WHITE), CAMERA, minirt.Light((9, 9, -9), 1), TURNED))
SCENES = {
    "turned": MADE,
    "from afar": MADE.replace(CAMERA, position=(1e3, 5, -7), direction=(-0.98, -0.01, 0.01), fov=1),
    "checkered": MADE.replace(TURNED, mirror=0.5, checker=minirt.Checker(0.2)),
    "exposed": MADE.replace(CAMERA, tone="filmic", exposure=3).replace(TURNED, specular=minirt.Specular(1, 5)),
    **{name: minirt.example(name) for name in ("shapes", "material-texture", "material-glass")},
}


def seen(scene: minirt.Scene) -> Buffers:
    """Buffers of a small picture."""
    return minirt.buffers(scene, *SIZE)


@pytest.mark.parametrize("name", SCENES)
def test_rays_are_those_of_the_reference(name: str) -> None:
    rays, expected = minirt.camera_rays(SCENES[name], *SIZE), reference.camera_rays(SCENES[name].camera, *SIZE)
    assert all(np.allclose(one, other, rtol=0, atol=1e-12) for one, other in zip(rays, expected, strict=True))


def test_a_triangle_of_a_mesh_has_the_buffers_of_a_triangle(tmp_path: Path) -> None:
    (tmp_path / "one.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    mesh = minirt.Mesh(minirt.MeshFile(str(tmp_path / "one.obj")), (-1, -1, 0), 3, WHITE)
    triangle = minirt.Triangle((-1, -1, 0), (2, -1, 0), (-1, 2, 0), WHITE)
    one, other = (seen(MADE.replace(TURNED, each)) for each in (mesh, triangle))
    assert (one.shape == 0).sum() > 100
    assert np.array_equal(one.shape, other.shape)
    assert np.allclose(one.uv, other.uv, rtol=0, atol=1e-9, equal_nan=True)


@pytest.mark.parametrize("name", SCENES)
def test_geometry_is_that_of_the_reference(name: str) -> None:
    scene, buffers = SCENES[name], seen(SCENES[name])
    origins, directions = reference.camera_rays(scene.camera, *SIZE)
    distance, owner = first_hits(scene.shapes, origins.reshape(-1, 3), directions.reshape(-1, 3))
    same = owner.reshape(buffers.shape.shape) == buffers.shape
    assert same.mean() > 0.998  # at rims rounding decides
    hit = same & (buffers.shape >= 0)
    far = distance.reshape(hit.shape)
    assert np.allclose(buffers.distance[hit], far[hit], rtol=1e-9)
    assert np.allclose(buffers.depth[hit], far[hit] * (directions @ np.array(scene.camera.direction))[hit], rtol=1e-9)
    assert np.allclose(buffers.point[hit], (origins + far[..., None] * directions)[hit], atol=1e-7)
    assert np.isinf(buffers.distance[buffers.shape < 0]).all()
    assert np.isnan(buffers.uv[buffers.shape < 0]).all()
    for index in np.unique(buffers.shape[hit]):
        here = buffers.shape == index
        expected = normals(scene.shapes[index], buffers.point[here])
        assert np.allclose(np.abs((buffers.normal[here] * expected).sum(axis=-1)), 1, atol=1e-7)


@pytest.mark.parametrize("name", SCENES)
def test_coordinates_are_those_of_the_reference(name: str) -> None:
    scene, buffers = SCENES[name], seen(SCENES[name])
    for index in np.unique(buffers.shape[buffers.shape >= 0]):
        shape, here = scene.shapes[index], buffers.shape == index
        expected = placed(surface_point(shape, buffers.point[here]), shape.uv)
        off = buffers.uv[here] - np.stack([expected.u, expected.v], axis=-1)
        assert (np.abs(off).max(axis=-1) < 1e-6).mean() > 0.99  # but at the seam, where u jumps by 1


@pytest.mark.parametrize("name", ["turned", "checkered", "exposed", "material-texture"])
def test_albedo_is_the_colour_of_the_reference(name: str) -> None:
    scene, buffers = SCENES[name], seen(SCENES[name])
    before = reference.DECODED.set(scene.camera.tone != "plain")
    for index in np.unique(buffers.shape[buffers.shape >= 0]):
        here = buffers.shape == index
        points, normal = buffers.point[here], buffers.normal[here]
        colour, _ = colour_and_normal(scene, scene.shapes[index], points, normal)
        close = np.abs(buffers.albedo[here] - colour).max(axis=-1) < 1e-6
        assert close.mean() > 0.97  # but at edges of a texture's repeat
    reference.DECODED.reset(before)
    assert (buffers.albedo[buffers.shape < 0] == 0).all()


def test_hits_are_columns_of_a_table() -> None:
    origins, directions = minirt.camera_rays(MADE, *SIZE)
    hits = minirt.trace(MADE, origins.reshape(-1, 3), directions.reshape(-1, 3))
    columns = hits.columns()
    assert {column.shape for column in columns.values()} == {(SIZE[0] * SIZE[1],)}
    assert np.array_equal(np.stack([columns[f"point_{axis}"] for axis in "xyz"], axis=-1), hits.point, equal_nan=True)
    assert list(columns) == ["distance", "owner", *(f"{name}_{axis}" for name in ("point", "normal") for axis in "xyz")]
    assert len(repr(hits)) < 80


@pytest.mark.parametrize("size", [(0, 4), (4, -1)])
def test_a_size_below_1_is_an_error(size: tuple[int, int]) -> None:
    for function in (minirt.buffers, minirt.camera_rays):
        with pytest.raises(minirt.RenderError, match="must be a whole number of at least 1"):
            function(MADE, *size)


def test_a_scene_without_shapes_has_empty_buffers() -> None:
    buffers = seen(minirt.Scene((CAMERA,)))
    assert (buffers.shape == -1).all()
    assert (buffers.albedo == 0).all()
