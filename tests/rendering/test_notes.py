"""The notes of a packing describe its decisions for a scene."""

from __future__ import annotations

from minirt.rendering.notes import kernel_notes
from minirt.rendering.packing.features import FEATURES
from minirt.rendering.packing.generic_kernels import GENERIC_KERNELS
from minirt.rendering.scene_packing import Packing
from minirt.scene import Ambient, Camera, FurtherLight, Light, Scene
from minirt.shapes import ALL_KINDS
from minirt.shapes.plane import Plane
from minirt.shapes.sphere import Sphere

GREY = (128, 128, 128)
EYE = Camera((0, 0, -9), (0, 0, 1), 60)


def notes_of(*balls: Sphere) -> list[str]:
    lights = Light((0, 5, 0), 1), FurtherLight((0, 5, 0), 0), FurtherLight((0, -5, 0), 1)
    black = FurtherLight((0, 0, 9), 1, (0, 0, 0))
    planes = Plane((0, -9, 0), (0, 1, 0), GREY), Plane((0, -1, 0), (0, -1, 0), GREY)
    scene = Scene((Ambient(0.1, GREY), Camera((0, 0, -9), (0, 0, 1), 60), *lights, black, *planes, *balls))
    packing = Packing()
    assert packing.notes == []
    packing.pack(scene, 64, 48)
    return packing.notes


def test_kinds_and_features_that_a_kernel_lacks_are_named() -> None:
    scene = Scene((EYE, Sphere((0, 0, 0), 1, GREY), Plane((0, -9, 0), (0, 1, 0), GREY)))
    kernel, without, plain = kernel_notes(scene, generic=None, compiling=True)
    others = [kind.element.plural for kind in ALL_KINDS if kind.element not in (Sphere, Plane)]
    assert (kernel, without) == ("kernel for spheres, planes", f"kernel without {', '.join(others)}")
    assert plain == f"kernel without {', '.join(FEATURES.values())}"


def test_a_generic_kernel_is_named_with_what_it_waits_for() -> None:
    scene = Scene((EYE, Sphere((0, 0, 0), 1, GREY)))
    for generic in GENERIC_KERNELS:
        features = "all" if generic.name == "full" else "no"
        note = f"generic kernel for all kinds of shapes and {features} features"
        assert list(kernel_notes(scene, generic, compiling=False)) == [note]
        assert list(kernel_notes(scene, generic, compiling=True)) == [
            note,
            "the kernel for spheres alone is being compiled",
        ]


def test_shapes_and_lights_that_are_left_out_are_named_with_the_reason() -> None:
    tiles, buffer, *rest = notes_of(Sphere((0, 0, 0), 1, GREY))
    assert tiles.startswith("tiles: 12, ")
    assert buffer == "light buffer: none, every shape is tried (3 shapes)"
    assert rest == [
        "plane 1 hides nothing from light 1",
        "plane 2 hides nothing from light 1",
        "light 2 has brightness 0",
        "plane 1 hides nothing from light 3",
        "light 4 is black",
    ]


def test_a_fallback_to_double_precision_is_noted() -> None:
    packing = Packing(precision="single")
    for mirror in (None, 0.5):
        packing.pack(Scene((Camera((0, 0, -9), (0, 0, 1), 60), Sphere((0, 0, 0), 1, GREY, mirror=mirror))), 64, 48)
        assert ("double precision: single supports neither images nor a BVH" in packing.notes) is bool(mirror)


def test_the_size_of_the_light_buffer_is_noted() -> None:
    *_, buffer, _, _, _, _, _ = notes_of(*(Sphere((i, 0, 0), 1, GREY) for i in range(48)))
    assert buffer == "light buffer: 6 x 32 x 32 cells per light (50 shapes)"


def test_the_cells_of_every_light_are_noted() -> None:
    heap = [Sphere((i % 10, i // 10 % 10, i // 100), 0.5, GREY) for i in range(1000)]
    lights = Light((50, 20, -9), 1), FurtherLight((5, 5, 5), 1)
    for shown, cells in (
        (lights[:1], "128 x 128 cells in a frustum per light"),
        (lights[1:], "6 x 64 x 64 cells per light"),
        (lights, "6 x 64 x 64 cells or 128 x 128 cells in a frustum per light"),
        ((), "6 x 64 x 64 cells per light"),
    ):
        packing = Packing()
        packing.pack(Scene((Camera((0, 0, -9), (0, 0, 1), 60), *shown, *heap)), 64, 48)
        assert f"light buffer: {cells} (1000 shapes)" in packing.notes
