"""The ablation tells by how much a part changes the time of a frame, and whether the picture is the same."""

from __future__ import annotations

from math import isnan, nan
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from minirt.kernel.bvh_nodes import NODE, REFERENCES
from minirt.kernel.machine_code.library import LIBRARY
from minirt.materials import Specular
from minirt.rendering.kernels import packing_calls
from minirt.rendering.packing.features import APERTURES, WORDS, features
from minirt.rendering.renderer import Renderer
from minirt.rendering.scene_packing import BOXES, LIGHT_BUFFERS, TILES, Packing
from minirt.report import ablation
from minirt.report.ablation import Ablation, Part
from minirt.report.variants import Variant, with_more, without_lists, without_unseen
from minirt.scene import FurtherLight, ParallelLight, Scene
from minirt.shapes import ALL_KINDS, Plane, Sphere, Torus
from tests.kernel.pictures import ALL, AMBIENT, EYE, LAMP, SHAPES, interpreted, linear
from tests.random_scenes import random_scene
from tests.simulated_clock import PROCESSOR_SHARE, Clock, packets, simulate_clock

WIDTH, HEIGHT = 32, 20
ALL_LISTS = (TILES, LIGHT_BUFFERS, BOXES)
DIMMER = Variant("feature", "dimmer light", "added", ALL.replace(ALL.lights[0], brightness=0.1))


@pytest.fixture(autouse=True)
def clock(monkeypatch: pytest.MonkeyPatch) -> Clock:
    """Simulate a clock that only rendering moves on."""
    return simulate_clock(monkeypatch)


def parts(*variants: Variant) -> list[Part]:
    return list(Ablation(ALL, WIDTH, HEIGHT, 1, 0.0).parts(variants, lambda name: None))


def test_lists_change_the_time_and_not_the_picture(clock: Clock, monkeypatch: pytest.MonkeyPatch) -> None:
    """Pictures without a list take a quarter longer."""
    render = Renderer.render

    def slow(renderer: Renderer, *arguments: Any) -> object:
        clock.slowness = 1.25 if renderer.without else 1.0
        return render(renderer, *arguments)

    monkeypatch.setattr(Renderer, "render", slow)
    scene, *lists = parts(*without_lists(ALL))
    assert (scene.sort, scene.change) == ("scene", "as it is")
    assert scene.frame_ms == pytest.approx(packets(WIDTH, HEIGHT) * 1e-3 * PROCESSOR_SHARE)
    assert [part.name for part in lists][-1] == "culling"
    assert len(lists) == 3
    for part in lists:
        assert part.percent == pytest.approx(25)
        assert part.percent_low == pytest.approx(25)
        assert part.frame_ms == pytest.approx(1.25 * scene.frame_ms)
        assert (part.same, part.remark) == (True, "")
        assert isnan(part.compile_s)


def test_a_variant_with_a_kernel_of_its_own(monkeypatch: pytest.MonkeyPatch) -> None:
    """The compiler is asked for the scene as it is and for the variant; a different picture is told."""
    seconds = {id(ALL): 4.0, id(DIMMER.scene): 5.0}
    monkeypatch.setattr(ablation, "compile_seconds", lambda scene: seconds[id(scene)])
    scene, dimmer = parts(DIMMER)
    assert (scene.compile_s, dimmer.compile_s) == (4.0, 5.0)
    assert dimmer.compile_percent == pytest.approx(25)
    assert dimmer.percent == pytest.approx(0)
    assert not dimmer.same


def test_a_variant_that_fails_is_told(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("minirt.rendering.packing.visibility.MOST_MEMBERS", 1)
    _, tiles, lights, _ = parts(*without_lists(ALL))
    assert tiles.remark.startswith("failed: 6 shapes in each of")
    assert isnan(tiles.percent)
    assert not isnan(lights.percent)


def test_the_compiler_is_timed_whether_or_not_the_kernel_was_there(monkeypatch: pytest.MonkeyPatch) -> None:
    """The kernel that is compiled fastest stands for all."""
    call = min(packing_calls(), key=lambda call: len(LIBRARY.identity(call)))
    monkeypatch.setattr(ablation, "calls_for", lambda *_: [call])
    for _ in range(2):
        assert ablation.compile_seconds(ALL) > 0
        assert LIBRARY.find(LIBRARY.identity(call))


# What the ablation adds changes no pixel, and is what it says.


BEHIND = FurtherLight((0, 0, -400), 0.5, (255, 255, 255))  # far behind the eye
PARALLEL = ParallelLight((0, -1, 0), 0.5, (255, 255, 255))


@pytest.mark.parametrize(
    "scene", [ALL, Scene((*ALL.elements, BEHIND, PARALLEL)), Scene((AMBIENT, EYE, LAMP, SHAPES[0]))]
)
def test_each_feature_and_each_kind_is_added_once(scene: Scene, tmp_path: Path) -> None:
    variants, used = list(with_more(scene, tmp_path)), features(scene) | APERTURES
    kinds = {type(shape) for shape in scene.shapes}
    names = [words for key, words in WORDS.items() if key not in used]
    names += [kind.element.plural for kind in ALL_KINDS if kind.element not in kinds]
    assert [variant.name for variant in variants] == names
    glass = {"reflective", "transparent"}
    needed = {"tinted glass": glass, "Fresnel's equations": glass, "scaled and turned maps": {"checks"}}
    keys = {words: key for key, words in WORDS.items()} | {kind.element.plural: kind.element for kind in ALL_KINDS}
    for variant in variants:
        extra = features(variant.scene) - used
        assert keys[variant.name] in extra
        assert len(extra - needed.get(variant.name, set())) == 1


def test_the_picture_is_the_same(tmp_path: Path) -> None:
    scene, size = Scene((AMBIENT, EYE, LAMP, *SHAPES[:3])), (32, 16)
    _, right = interpreted(scene, *size)
    chosen = {"highlights", "mirrors and glass", "spots, parallel and fading light", "planes", "triangles", "tori"}
    for variant in with_more(scene, tmp_path):
        if variant.name in chosen:
            assert np.array_equal(interpreted(variant.scene, *size)[1], right), variant.name


# What is left out as unseen does nothing for the picture.


GREY, SIZE = (128, 128, 128), (32, 20)
MIRROR = Plane((0, 0, -60), (0, 0, 1), GREY, mirror=0.5, specular=Specular(0.5, 30.0))  # the eye and the light
SCENE = Scene((AMBIENT, EYE, LAMP, *SHAPES[1:4] * 3, MIRROR))


def test_materials_and_kinds_that_no_pixel_shows() -> None:
    _, right = interpreted(SCENE, *SIZE)
    found = {variant.name: variant.scene for variant in without_unseen(SCENE, *SIZE)}
    assert list(found) == ["highlights", "mirrors and glass", "planes"]
    for name, gone in (("highlights", "specular"), ("mirrors and glass", "reflective"), ("planes", Plane)):
        assert features(SCENE) - features(found[name]) >= {gone}
    for scene in found.values():
        assert np.array_equal(interpreted(scene, *SIZE)[1], right)


def test_what_is_seen_or_mirrored_or_casts_a_shadow_stays() -> None:
    above = Torus((-3, 5, -4), (0, 1, 0), 1.0, 0.3, GREY)  # out of sight, between the light and the spheres
    for scene in (ALL, Scene((*SCENE.elements[:-1], above)), SCENE.replace(SCENE.shapes[1], mirror=0.2)):
        assert list(without_unseen(scene, *SIZE)) == []


@pytest.mark.parametrize(
    ("change", "percent", "interval", "seconds"),
    [
        ("added", 25.0, (20.0, 30.0), 4.0 * 5),  # a fifth of each second is saved
        ("added", 25.0, (-10.0, 30.0), nan),
        ("without", -20.0, (-30.0, -10.0), 6.0 * 5),
        ("without", -20.0, (-30.0, 10.0), nan),
    ],
)
def test_a_kernel_pays_once_it_has_saved_its_compile_time(
    change: str, percent: float, interval: tuple[float, float], seconds: float
) -> None:
    measured = Ablation.__new__(Ablation)
    measured.compile_s = 4.0
    assert measured.pays_after(change, percent, interval, 6.0) == pytest.approx(seconds, nan_ok=True)


# Brute force tries every shape for every ray and gives the same picture, bit for bit.

WIDE, HIGH = 70, 40  # 5 x 3 tiles
MANY = ALL.add(*(Sphere((i % 16 - 7.5, i // 16 - 7.5, 4 + i % 7), 0.7, (90, 90, i)) for i in range(250)))


@pytest.mark.parametrize("scene", [ALL, MANY, Scene((AMBIENT, EYE, *SHAPES)), *map(random_scene, range(1, 6))])
def test_brute_force_gives_the_same_picture(scene: Scene) -> None:
    brute = linear(scene, WIDE, HIGH, 3, Renderer(2, without=ALL_LISTS))
    assert np.array_equal(brute, linear(scene, WIDE, HIGH, 3))


def test_every_tile_and_every_light_has_every_shape() -> None:
    traced = Packing(without=ALL_LISTS).pack(ALL, WIDE, HIGH)
    for kind, group in enumerate(traced.groups):
        expected = np.flatnonzero(traced.slots[:, 0] == kind).tolist()
        assert len(group.tile_starts) == 15 + 1
        for a, b in zip(group.tile_starts, group.tile_starts[1:], strict=False):
            assert sorted(traced.tile_shapes[a:b]) == expected
        assert len(group.light_starts) == 2
        for a, b in group.light_starts:
            assert sorted(traced.light_shapes[a:b]) == expected
    assert traced.light_buffer_cells == 1
    assert (traced.cones == [0, 0, 0, -2, 0]).all()  # no cone and no distance keeps a shape from being tried
    assert (traced.light_cones == [0, 0, 0, -2, 0]).all()
    assert len(Packing().pack(ALL, WIDE, HIGH).tile_shapes) < len(traced.tile_shapes)


def test_every_ray_visits_every_leaf_of_the_tree() -> None:
    mirrors = ALL.replace(ALL.shapes[1], mirror=0.7).replace(ALL.shapes[0], mirror=0.4)
    tree, wide = (packing.pack(mirrors, WIDE, HIGH).bvh for packing in (Packing(), Packing(without=(BOXES,))))
    boxes, open_boxes = (each.nodes.reshape(-1, NODE)[:, :REFERENCES] for each in (tree, wide))
    used = (boxes[:, : REFERENCES // 2] <= boxes[:, REFERENCES // 2 :]).sum()
    assert 0 < used == np.isneginf(open_boxes[:, : REFERENCES // 2]).sum()
    assert np.array_equal(tree.nodes.reshape(-1, NODE)[:, REFERENCES:], wide.nodes.reshape(-1, NODE)[:, REFERENCES:])
    brute = linear(mirrors, WIDE, HIGH, 1, Renderer(1, without=ALL_LISTS))
    assert np.array_equal(brute, linear(mirrors, WIDE, HIGH))
