"""What a packing says of the scene that it packed."""

from __future__ import annotations

from minirt.rendering.packing.features import FEATURES
from minirt.rendering.scene_packing import Packing
from minirt.scene import Ambient, Camera, FurtherLight, Light, Scene
from minirt.shapes import ALL_KINDS
from minirt.shapes.plane import Plane
from minirt.shapes.sphere import Sphere

GREY = (128, 128, 128)


def said(*balls: Sphere) -> list[str]:
    lights = Light((0, 5, 0), 1), FurtherLight((0, 5, 0), 0), FurtherLight((0, -5, 0), 1)
    black = FurtherLight((0, 0, 9), 1, (0, 0, 0))
    planes = Plane((0, -9, 0), (0, 1, 0), GREY), Plane((0, -1, 0), (0, -1, 0), GREY)
    scene = Scene((Ambient(0.1, GREY), Camera((0, 0, -9), (0, 0, 1), 60), *lights, black, *planes, *balls))
    packing = Packing()
    assert packing.notes == []
    packing.pack(scene, 64, 48)
    return packing.notes


def test_what_is_left_out_and_why() -> None:
    kernel, without, plain, tiles, buffer, *rest = said(Sphere((0, 0, 0), 1, GREY))
    others = [kind.element.plural for kind in ALL_KINDS if kind.element not in (Sphere, Plane)]
    assert (kernel, without) == ("kernel for spheres, planes", f"kernel without {', '.join(others)}")
    assert plain == f"kernel without {', '.join(FEATURES.values())}"
    assert tiles.startswith("tiles: 12, ")
    assert buffer == "light buffer: none, every shape is tried (3 shapes)"
    assert rest == [
        "plane 1 hides nothing from light 1",
        "plane 2 hides nothing from light 1",
        "light 2 has brightness 0",
        "plane 1 hides nothing from light 3",
        "light 4 is black",
    ]


def test_single_precision_where_there_is_none() -> None:
    packing = Packing(precision="single")
    for mirror in (None, 0.5):
        packing.pack(Scene((Camera((0, 0, -9), (0, 0, 1), 60), Sphere((0, 0, 0), 1, GREY, mirror=mirror))), 64, 48)
        told = packing.notes[0]
        assert told == (
            "double precision: single has neither pictures nor a tree of shapes" if mirror else "kernel for spheres"
        )


def test_the_size_of_the_light_buffer() -> None:
    *_, buffer, _, _, _, _, _ = said(*(Sphere((i, 0, 0), 1, GREY) for i in range(48)))
    assert buffer == "light buffer: 6 x 32 x 32 cells a lamp (50 shapes)"


def test_which_cells_lamps_have() -> None:
    heap = [Sphere((i % 10, i // 10 % 10, i // 100), 0.5, GREY) for i in range(1000)]
    lamps = Light((50, 20, -9), 1), FurtherLight((5, 5, 5), 1)
    for shown, cells in (
        (lamps[:1], "128 x 128 cells ahead of a lamp"),
        (lamps[1:], "6 x 64 x 64 cells a lamp"),
        (lamps, "6 x 64 x 64 cells or 128 x 128 cells ahead of a lamp"),
        ((), "6 x 64 x 64 cells a lamp"),
    ):
        packing = Packing()
        packing.pack(Scene((Camera((0, 0, -9), (0, 0, 1), 60), *shown, *heap)), 64, 48)
        assert f"light buffer: {cells} (1000 shapes)" in packing.notes
