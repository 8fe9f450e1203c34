"""Packing of scenes: the arrays are those of the scene, and an edit packs only what it changes."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image

from minirt.kernel.machine_code.library import Entry
from minirt.kernel.scene_arrays import read
from minirt.materials import Checker, Glass, Specular, Tint
from minirt.rendering.frame import frame_rays
from minirt.rendering.packing import packed_shapes, runs, shape_arrays, visibility
from minirt.rendering.packing.packed_shapes import extents_from
from minirt.rendering.packing.runs import differing_shapes
from minirt.rendering.packing.shape_arrays import ShapeArrays
from minirt.rendering.packing.view import View
from minirt.rendering.packing.visibility import CHUNK, BinnedShapes, Bins
from minirt.rendering.renderer import PRECISIONS, Renderer
from minirt.rendering.scene_packing import Packing
from minirt.scene import Ambient, Camera, FurtherLight, Light, Scene, fast, parse
from minirt.scene.pages import PAGE_LENGTH
from minirt.shapes import ALL_KINDS, Cylinder, Plane, Sphere
from tests.kernel.pictures import ALL, EYE, SHAPES
from tests.random_scenes import random_scene
from tests.seeds import seed_of
from tests.shapes.examples import example


@pytest.fixture
def packed(monkeypatch: pytest.MonkeyPatch) -> list[Any]:
    """The shapes that were packed so far."""
    done: list[Any] = []
    monkeypatch.setattr(
        shape_arrays, "pack_shapes", lambda new, pack=shape_arrays.pack_shapes: done.extend(new) or pack(new)
    )
    return done


def assert_same(arrays: Any, scene: Scene, precision: str = "double") -> Packing:
    """Assert that arrays equal those of a fresh packing, and return it."""
    packing = Packing(precision=precision)
    fresh = packing.pack(scene, 24, 16)
    for name, value in zip(fresh._fields, fresh, strict=True):
        if name == "tile_shapes":  # which has room for more
            end = fresh.groups[-1].tile_starts[-1]
            assert np.array_equal(arrays.tile_shapes[:end], value[:end])
        elif name != "groups":
            found = getattr(arrays, name)
            pairs = zip(found, value, strict=True) if isinstance(value, tuple) else [(found, value)]
            assert all(np.array_equal(part, right) for part, right in pairs), name
    for group, expected in zip(arrays.groups, fresh.groups, strict=True):
        found, right = ((*each[:4], *(each.trees or ()), *(each.triangles or ())) for each in (group, expected))
        assert all(map(np.array_equal, found, right))
    return packing


def test_the_arrays_have_the_numbers_of_the_scene() -> None:
    blue = (0, 51, 255)
    lights = Light((1, 2, 3), 0.5, blue), FurtherLight((0, 0, 0), 0.0), FurtherLight((4, 5, 6), 1.0, (0, 0, 0))
    ball, wall = Sphere((1, 2, 3), 4, (255, 0, 51)), Plane((7, -9, 2), (0, 1, 0), blue)
    arrays = Packing().pack(Scene((Ambient(0.5, blue), EYE, *lights, wall, ball)), 24, 16)
    assert arrays.ambient.tolist() == [0, 0.1, 0.5]
    assert arrays.lights.tolist() == [[1, 2, 3, 0, 0.1, 0.5]]  # lights that are off or black are left out
    assert arrays.colours_and_extents.tolist() == [[0, 0.2, 1, 9], [1, 0, 0.2, 5]]
    assert arrays.slots.tolist() == [[1, 0], [0, 0]]  # kinds in the order of the registry
    ball_again = read(arrays.groups[0].rows, 0)
    assert (ball_again.centre.x, ball_again.centre.y, ball_again.centre.z, ball_again.radius) == (1, 2, 3, 2)


def test_a_scene_may_have_no_ambient_light_and_no_lights() -> None:
    arrays = Packing().pack(Scene((EYE, *SHAPES)), 24, 16)
    assert arrays.ambient.tolist() == [0, 0, 0]
    assert arrays.lights.shape == (0, 6)
    assert arrays.light_cones.shape == (0, len(SHAPES), 5)
    assert len(arrays.light_shapes) == 0
    assert all(group.light_starts.shape == (0, 1) for group in arrays.groups)


def test_an_edit_packs_again_only_what_it_changed(packed: list[Any]) -> None:
    packing = Packing()
    packing.pack(ALL, 24, 16)
    assert len(packed) == len(SHAPES)
    packed.clear()

    moved = ALL.replace(ALL.spheres[1], centre=(9, 9, 9))
    packing.pack(moved, 24, 16)
    assert packed == [moved.spheres[1]]
    packed.clear()
    packing.pack(moved, 24, 16)
    packing.pack(moved.replace(moved.camera, fov=30), 24, 16)
    packing.pack(moved.replace(moved.lights[0], brightness=0.1), 30, 20)
    assert packed == []
    packing.pack(ALL, 24, 16)
    assert packed == [ALL.spheres[1]]


def test_a_crowd_packed_in_columns_has_the_numbers_of_its_shapes_packed_one_by_one() -> None:
    seed = seed_of("a crowd")
    crowded = [kind for kind in ALL_KINDS if kind.element.columnar]
    assert crowded
    for kind in crowded:
        random = np.random.default_rng(seed)
        shapes = [example(kind, random, 10.0 ** (i % 9 - 4), i % 2) for i in range(99)]
        rows, boxes, balls = packed_shapes.pack_shapes(shapes)
        assert np.array_equal(rows, packed_shapes.packed_rows([shape.pack() for shape in shapes])), seed
        assert np.array_equal(boxes, packed_shapes.bounding_boxes(shapes)), seed
        assert np.array_equal(balls, packed_shapes.bounding_balls(shapes)), seed


@pytest.mark.parametrize("crowd", [0, 50_000])
def test_adding_and_removing_pack_only_the_page_that_they_change(
    packed: list[Any], crowd: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(shape_arrays, "CROWD", crowd)
    balls = [Sphere((i, 1, 2), 1, (i % 256, 0, 0)) for i in range(PAGE_LENGTH)]
    tubes = [Cylinder((i, 0, 0), (0, 1, 0), 1, 1, (0, i % 256, 0)) for i in range(PAGE_LENGTH)]
    scene = Scene((*balls, EYE, *SHAPES, *tubes, *SHAPES))
    arrays, anew, fewer = ShapeArrays(), ShapeArrays(), scene.edit(PAGE_LENGTH + 1)
    arrays.update(*scene.runs)
    for edited in (fewer, scene.edit(PAGE_LENGTH + 1, *SHAPES), fewer.edit(len(fewer.elements) - 1), scene):
        packed.clear()
        arrays.update(*edited.runs)
        assert set(packed) <= {*SHAPES, *tubes}
        anew.allocate()
        anew.update(*edited.runs)
        for name in ("boxes", "balls", "colours_and_extents", "planes", "tables", "listed", "slots"):
            assert all(map(np.array_equal, getattr(arrays, name), getattr(anew, name))), name
        for group, table in enumerate(arrays.tables):
            numbers = packed_shapes.packed_rows([arrays.shapes[i].pack() for i in arrays.primitives_of(group)])
            assert np.array_equal(table.view(np.float64).reshape(len(table), -1), numbers)


def test_shapes_that_nobody_asks_for_are_packed_without_being_made(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(fast, "MANY_LINES", 0)
    monkeypatch.setattr(runs, "JOINED", 2)
    lines = [f"sp {i},0,9 1 {i % 256},0,255" for i in range(4 * PAGE_LENGTH)]
    first = ["A 1 1,1,1", "C 0,0,0 0,0,1 70", "L 0,9,0 1 255,255,255", "pl 0,-9,0 0,1,0 9,9,9"]
    scene = parse("\n".join([*first, *["#"] * (PAGE_LENGTH - len(first)), *lines])).scene
    *_, crowd = scene.runs
    Renderer(1).render(scene, np.zeros((8, 8, 4), np.uint8))
    assert "elements" not in vars(crowd)
    arrays, others, lengths = ShapeArrays(), ShapeArrays(), []
    with monkeypatch.context() as patch:
        pack = shape_arrays.pack_shapes
        patch.setattr(shape_arrays, "pack_shapes", lambda new: lengths.append(len(new)) or pack(new))
        arrays.update(*scene.runs)
    assert lengths == [1, 2 * PAGE_LENGTH, 2 * PAGE_LENGTH]
    others.update(scene.shapes)
    assert "elements" in vars(crowd)
    assert all(map(np.array_equal, arrays.tables, others.tables))
    assert np.array_equal(arrays.colours_and_extents, others.colours_and_extents)


@pytest.mark.parametrize(
    "edit",
    [
        lambda s: s.replace(s.spheres[0], diameter=1),
        lambda s: s.replace(s.planes[0], colour=(1, 2, 3)),
        lambda s: s.replace(s.cylinders[1], axis=(0, 1, 0)),
        lambda s: s.replace(s.lights[1], position=(9, 9, 9)),
        lambda s: s.replace(s.lights[0], brightness=0),
        lambda s: s.replace(s.camera, position=(2, 3, -8)),
        lambda s: s.replace(s.spheres[0], Cylinder((0, 0, 0), (0, 1, 0), 1, 1, (255, 0, 0))),
        lambda s: Scene(item for item in s.items if item is not s.spheres[0]),
        lambda s: Scene((*s.items, Sphere((0, 1, 0), 1, (9, 9, 9)))),
        lambda s: Scene(item for item in s.items if item not in s.planes),
        lambda s: Scene((*s.items[:4], *reversed(s.items[4:]))),
        lambda s: Scene(s.items[:4]),
    ],
)
def test_after_an_edit_the_arrays_are_those_of_the_new_scene(edit: Any) -> None:
    packing = Packing()
    for scene in (ALL, edit(ALL), ALL):
        if scene.shapes:
            assert_same(packing.pack(scene, 24, 16), scene)


def test_using_the_arrays_of_another_scene_does_no_harm() -> None:
    edited = ALL.replace(ALL.spheres[0], centre=(0, 3, 2))
    packing = Packing()
    for scene, other in ((ALL, edited), (edited, ALL), (ALL, edited)):
        packing.pack(scene, 24, 16)
        assert packing.shape_arrays_for(other.shapes).shapes == other.shapes
        assert packing.notes == []
        assert_same(packing.pack(other, 24, 16), other)
        packing.shape_arrays_for(scene.shapes)
        assert_same(packing.pack(other, 24, 16), other)


def edited(seed: int) -> Iterator[Scene]:
    """Yield a scene of some shapes and lights, and edits of it: of shapes, of lights and their order, of the lens."""
    random = np.random.default_rng(seed)

    def place() -> Any:
        return tuple(random.uniform(-5, 5, 3).tolist())

    balls = [Sphere(place(), random.uniform(0.1, 2), (9, 99, 200)) for _ in range(20)]
    lamps = [FurtherLight(place(), 0.3, (255, 255, 255), fade=random.choice([None, 4.0])) for _ in range(3)]
    scene = Scene((Camera(place(), (0, 0, 1), 70), *lamps, Plane((0, -5, 0), (0, 1, 0), (200, 200, 200)), *balls))
    for _ in range(25):
        yield scene
        edit = random.integers(6)
        if edit < 3:
            scene = scene.replace(scene.spheres[random.integers(20)], centre=place(), diameter=random.uniform(0.1, 4))
        elif edit == 3:
            scene = scene.replace(random.choice(np.array(scene.lights, object)), position=place(), fade=3.0)
        elif edit == 4:
            rest = [each for each in scene.items if each not in scene.lights]
            lamps = [scene.lights[i] for i in random.permutation(len(scene.lights))[: random.integers(1, 4)]]
            scene = Scene((*rest, *lamps, FurtherLight(place(), 0.3, (255, 255, 255))))
        else:
            scene = scene.replace(scene.camera, fov=random.uniform(30, 90), lens=random.choice([None, 0.1]), focus=5.0)


def follow_edits(seed: int, precision: str) -> None:
    """Assert that one packing of scene after scene has the arrays of fresh ones."""
    packing = Packing(precision=precision)
    for scene in edited(seed):
        assert_same(packing.pack(scene, 24, 16), scene, precision)


@pytest.mark.parametrize("precision", ["double", "single"])
def test_lists_in_the_memory_of_those_before_are_those_of_the_new_scene(
    precision: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    seed = seed_of(f"edits in {precision}")
    monkeypatch.setattr(shape_arrays, "morton_order", lambda boxes: np.arange(len(boxes))[::-1])  # also after edits
    for each in range(seed, seed + 4):
        monkeypatch.setattr(shape_arrays, "CROWD", (50_000, 0)[each % 2])
        monkeypatch.setattr(visibility, "CHUNK", (CHUNK, 2)[each % 2])
        follow_edits(each, precision)
    monkeypatch.setattr(Bins, "fit", lambda *_: True)
    with pytest.raises((AssertionError, ValueError)):
        follow_edits(1, precision)


def test_a_shape_that_moves_is_binned_without_the_others(monkeypatch: pytest.MonkeyPatch) -> None:
    packing, scenes = Packing(), edited(5)
    packing.pack(next(scenes), 24, 16)
    bins = [packing.view.bins, *(each.bins for each in packing.cache.values() if isinstance(each, BinnedShapes))]
    for each in bins:
        monkeypatch.setattr(each, "pack", None)
        monkeypatch.setattr(each, "packing", None)
    scene = packing.last[0]
    ball = scene.spheres[3]
    scene = scene.replace(ball, centre=np.add(ball.centre, 1e-3))  # so little that the lists have room
    assert_same(packing.pack(scene, 24, 16), scene)
    assert len(bins) == 4


STEPS = 12


def walk(seed: int) -> Iterator[Scene]:
    """Yield a random scene from places near each other and far, looking anywhere, through planes and out of sight."""
    random, scene = np.random.default_rng(seed), random_scene(seed)
    ball, *_ = scene.shapes
    scene = scene.replace(ball, specular=Specular(0.5, 9.0))
    for step in range(STEPS):
        yield scene
        place = np.array(scene.camera.position) + random.normal(size=3) * (0.1, 1.0, 9.0)[step % 3]
        way = random.normal(size=3)
        pose = {"position": tuple(place.tolist()), "direction": tuple((way / np.abs(way).max()).tolist())}
        scene = scene.replace(scene.camera, **pose, roll=float(step), left_handed=step % 2 == 0)


def follows(seed: int, precision: str) -> int:
    """Assert that arrays that follow a camera are those of a fresh packing; return how often they did so."""
    packing, before, kept = Packing(precision=precision), None, 0
    for scene in walk(seed):
        arrays = packing.pack(scene, 24, 16)
        kept += arrays is before
        fresh = assert_same(arrays, scene, precision)
        assert packing.view.rays == pytest.approx(frame_rays(arrays, 1), abs=1e-5)
        assert np.array_equal(packing.view.rays, fresh.view.rays)
        before = arrays
    return kept


@pytest.mark.parametrize("precision", PRECISIONS)
def test_arrays_follow_a_camera_that_moves_and_turns(precision: str, monkeypatch: pytest.MonkeyPatch) -> None:
    seed = seed_of(f"walks in {precision}")
    assert sum(follows(seed + i, precision) for i in range(8)) > 8 * STEPS / 4
    follow = View.follow  # says where lists of lights and materials change, too
    monkeypatch.setattr(View, "follow", lambda *arguments: follow(*arguments) or True)
    with pytest.raises(AssertionError):
        sum(follows(seed + i, precision) for i in range(40))


def test_the_medium_of_the_eye_follows_it_into_tinted_glass_and_out() -> None:
    balls = [Sphere((0, 0, z), 2, (9, 9, 9), glass=Glass(1.5, 0.9), tint=Tint((255, z, 9), 1.0)) for z in (5, 6, 9)]
    scene, packing, media, kept = Scene((EYE, Plane((0, -9, 0), (0, 1, 0), (9, 9, 9)), *balls)), Packing(), [], 0
    before = packing.pack(scene, 24, 16)
    for z in (0, 4.5, 5.5, 6.5, 7.5, 9, 12):
        moved = scene.replace(scene.camera, position=(0, 0, z))
        arrays = packing.pack(moved, 24, 16)
        kept, before = kept + (arrays is before), arrays  # others where lists of shapes in view need more room
        assert np.array_equal(arrays.eye_medium, Packing().pack(moved, 24, 16).eye_medium)
        media.append(arrays.eye_medium[1])
    within = [media[1], media[2], media[3], media[5]]
    assert min(within) > 0.0 == media[0] == media[4] == media[6]
    assert media[2] == media[1] + media[3]
    assert kept > len(media) / 2


@pytest.mark.parametrize("precision", PRECISIONS)
def test_a_moving_camera_takes_one_compiled_call_and_none_of_numpy(
    precision: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    packing, calls, run = Packing(precision=precision), list[Any](), Entry.run
    scenes = [ALL.replace(ALL.camera, position=(0, 0, -9 - i / 99), direction=(i / 99, 0, 1)) for i in range(3)]
    for scene in scenes[:2]:
        arrays = packing.pack(scene, 24, 16)
    monkeypatch.setattr(Entry, "run", lambda *arguments: calls.append("compiled") or run(*arguments))

    def log(_frame: Any, event: str, called: Any) -> None:
        if event == "c_call" and "numpy" in f"{called.__module__} {type(called.__self__)}":
            calls.append(called)

    sys.setprofile(log)
    try:
        assert packing.pack(scenes[2], 24, 16) is arrays
    finally:
        sys.setprofile(None)
    assert calls == ["compiled"]


def test_single_precision_draws_checkers_but_no_pictures(tmp_path: Path) -> None:
    Image.new("RGB", (2, 2), (9, 9, 9)).save(tmp_path / "grey.png")
    ball = Sphere((0, 0, 5), 2, (1, 2, 3))
    for shape, number in (
        (ball.replace(checker=Checker(1, (4, 5, 6))), np.float32),
        (ball.replace(texture="grey.png"), np.float64),
    ):
        packing = Packing(precision="single")
        assert packing.pack(Scene((EYE, shape), tmp_path / "scene.rt"), 24, 16).camera.dtype == number
        assert packing.computed_in.startswith("double precision" if number is np.float64 else "single precision")


# Shapes as structure of arrays: differences are found, and an edit writes only the shapes that it changes.


MANY = tuple(Sphere((i, 2.0 * i, 3), 1 + i, (i % 256, 0, 0)) for i in range(99))


@pytest.mark.parametrize("indices", [(), (0,), (9,), (7, 8, len(MANY) - 1)])
def test_differing_shapes_are_found(indices: tuple[int, ...]) -> None:
    new = list(MANY)
    for index in indices:
        new[index] = replace(new[index], diameter=9e9)
    old, changed = ([tuple(each[:9]), tuple(each[9:])] for each in (MANY, new))
    assert [*differing_shapes(old, changed)] == [(index, MANY[index], new[index]) for index in indices]


def test_many_shapes_have_the_numbers_of_each() -> None:
    mixed = [shape.replace(colour=(i % 256, 7, 9)) for i, shape in enumerate(SHAPES * 5)]
    arrays = ShapeArrays()
    assert arrays.update(tuple(mixed))
    for i, shape in enumerate(mixed):
        kind, number = arrays.slots[i]
        packed = [c for part in shape.pack() for c in ((part.x, part.y, part.z) if hasattr(part, "x") else (part,))]
        assert np.hstack([np.ravel(part) for part in arrays.rows[kind][number]]).tolist() == packed
        assert arrays.colours_and_extents[i, :3].tolist() == [c / 255 for c in shape.colour]
        balls = arrays.balls[arrays.first_ball[i] : arrays.first_ball[i + 1]]
        assert balls[:, :3].tolist() == [list(centre) for centre, _ in shape.balls()]
        for ball, (centre, radius) in zip(balls, shape.balls(), strict=True):
            assert radius + 1e-13 * max(map(abs, centre)) < ball[3] < radius + 1e-11 * (radius + max(map(abs, centre)))
    assert [mixed[i] for i in arrays.plane_indices] == [shape for shape in mixed if isinstance(shape, Plane)]
    assert [arrays.planes[i, :3].tolist() for i in range(10)] == [list(mixed[i].normal) for i in arrays.plane_indices]
    assert not arrays.update(tuple(arrays.shapes))
    assert not arrays.update((*mixed,))


def test_extents_and_boxes_of_several_shapes() -> None:
    shapes = [Cylinder((1, -7, 3), (0, 1, 0), 4, 6, (0, 0, 0)), Cylinder((1, -7, 3), (1, 0, 0), 4, 40, (0, 0, 0))]
    arrays = ShapeArrays()
    arrays.update(tuple(shapes))
    assert arrays.colours_and_extents[:, 3].tolist() == [10, 21]
    assert arrays.boxes.tolist() == [[[-1, -10, 1], [3, -4, 5]], [[-19, -9, 1], [21, -5, 5]]]
    assert extents_from(np.array([1.0, -7.0, 0.0]), arrays.boxes).tolist() == [6, 23]
