"""Scenes in the dialects of other miniRT programs are read with the meaning that they have there."""

from __future__ import annotations

from pathlib import Path

import pytest

from minirt.errors import SceneError
from minirt.materials import Bump, Checker, Glass, Mirror, Specular
from minirt.scene import Background, Camera, FurtherLight, Light, ParallelLight, Scene, SpotLight, load
from minirt.shapes.cone import Cone
from minirt.shapes.disc import Disc
from minirt.shapes.plane import Plane
from minirt.shapes.sphere import Sphere
from minirt.shapes.triangle import Triangle

WILD = Path(__file__).parent / "wild"
PICTURES = "../../../scenes/textures/"
UP, DOWN = (0, 1, 0), (0, -1, 0)


def wild(name: str, lenient: bool = False) -> Scene:
    """Load a scene of the folder `wild`."""
    return load(WILD / f"{name}.rt", lenient).scene


def test_every_scene_of_the_folder_is_tested() -> None:
    tried = Path(__file__).read_text()
    assert all(f'wild("{path.stem}"' in tried for path in WILD.glob("*.rt"))
    assert len(list(WILD.glob("*.rt"))) >= 6


# Lines that only a lenient reader accepts: two lights; comments, vectors of four numbers; blanks around commas.
LENIENT = {"cornell-box": [8], "party-hats": [1, 7], "pyramid": [3]}


@pytest.mark.parametrize("name", [path.stem for path in WILD.glob("*.rt")])
def test_lines_outside_the_format_are_errors(name: str) -> None:
    try:
        load(WILD / f"{name}.rt")
        odd = []
    except SceneError as error:
        odd = sorted({problem.line for problem in error.problems})
    assert odd == LENIENT.get(name, [])


def test_a_cornell_box_with_two_lights_l_in_capitals() -> None:
    scene = wild("cornell-box", lenient=True)
    assert scene.lights == (
        Light((0, 4.6, -1), 0.7, (255, 240, 220)),
        FurtherLight((-3, 3, -8), 0.25, (180, 200, 255)),
    )
    floor, *walls = scene.planes
    assert floor == Plane((0, 0, 0), UP, (220, 220, 220), checker=Checker(1, (60, 60, 70)))
    assert all(wall.checker is None for wall in walls)
    shine = Specular(0.8, 200)
    assert scene.spheres == (
        Sphere((-1.2, 1, 1), 2, (255, 255, 255), mirror=0.85, specular=shine),
        Sphere((1.3, 0.8, -1), 1.6, (255, 255, 255), glass=Glass(1.5, 0.9), specular=shine),
    )


def test_planets_with_textures_bump_maps_and_normal_maps() -> None:
    scene = wild("planets")
    assert scene.background == Background(f"{PICTURES}stars.png")
    earth, moon, mars = scene.spheres
    assert (earth.texture, earth.bump) == (
        f"{PICTURES}planet.png",
        Bump(f"{PICTURES}planet-height.png", 0.03),
    )
    assert moon.bump == Bump(f"{PICTURES}bricks-height.png", 0.02)
    assert (mars.texture, mars.normal_map) == (f"{PICTURES}bricks.png", f"{PICTURES}bricks-normal.png")
    assert mars.specular == Specular(0.4, 20)
    assert all(scene.beside(name).is_file() for name in (earth.texture, mars.normal_map))


def test_cones_by_all_aliases() -> None:
    scene = wild("party-hats", lenient=True)
    assert scene.cones == (
        Cone((0, 3, 0), DOWN, 2.5, 3, (255, 180, 0), specular=Specular(0.5, 40)),
        Cone((3, 2, 1), DOWN, 1.5, 2, (200, 0, 120), checker=Checker(0.125)),
        Cone((-3, 2.2, -1), DOWN, 2, 2.2, (20, 120, 220), mirror=0.2),
    )
    assert scene.planes[0].normal == UP
    assert scene.camera == Camera((0, 4, -14), (0, -0.2, 1), 60)


def test_a_pyramid_of_triangles() -> None:
    scene = wild("pyramid", lenient=True)
    top, a, b, c, d = (0, 3, 0), (-2.5, 0, -2.5), (2.5, 0, -2.5), (2.5, 0, 2.5), (-2.5, 0, 2.5)
    sand = (226, 200, 140)
    assert scene.triangles == tuple(Triangle(top, *side, sand) for side in ((a, b), (b, c), (c, d), (d, a)))
    assert scene.lights == (Light((10, 14, -4), 0.9, (255, 236, 200)),)
    assert scene.background == Background((120, 170, 230))


def test_a_stage_with_spots() -> None:
    scene = wild("stage")
    assert scene.lights == (
        SpotLight((-5, 8, 4), (0.5, -0.8, -0.4), 35, 0.8, (255, 60, 60)),
        SpotLight((5, 8, 4), (-0.5, -0.8, -0.4), 35, 0.8, (60, 90, 255), rim=0.5),
        SpotLight((0, 9, 0), DOWN, 30, 0.6, fade=20.0),
        ParallelLight((0.3, -1, -0.5), 0.1),
    )
    assert scene.cylinders[0].checker == Checker(0.125, (200, 30, 30))
    assert scene.spheres[0].specular == Specular(0.7, 90, blinn=True)
    assert (scene.planes[0].checker, scene.planes[0].mirror) == (Checker(2), Mirror(0.15))


def test_an_atom_with_all_spellings_of_numbers() -> None:
    scene = wild("atom")
    nucleus, electron, mirrored = scene.spheres
    assert nucleus.specular == Specular(1, 8)
    assert electron.glass == Glass(1.33)
    assert (mirrored.glass, mirrored.mirror) == (Glass(1.33, 0.5), Mirror(0.5))
    assert scene.camera == Camera((0, 0, -12), (0, 0, 1), 70)
    assert [ring.tube for ring in scene.tori] == [0.1] * 3
    assert scene.lights == (Light((5, 5, -5), 0.6, fade=40.0),)


def test_a_bar_with_further_shapes() -> None:
    scene = wild("bar")
    assert [type(shape).code for shape in scene.shapes] == ["pl", "bo", "pa", "hy", "di"]
    assert scene.of(Disc) == (Disc((0, 0.01, -1), UP, 1.2, (200, 30, 60), checker=Checker(0.125)),)
    assert [shape.glass for shape in scene.shapes[2:4]] == [Glass(1.5), Glass(1.5, 0.8)]
    assert scene.camera.roll == 3.0
