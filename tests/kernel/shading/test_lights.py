"""Light sources: direction, distance and strength of point, spot and parallel lights."""

from __future__ import annotations

from math import cos, inf, radians

import numpy as np
import pytest

from minirt.kernel.shading.lights import TOGETHER, LightGrid, incident_light, sources_in_reach
from minirt.lanes import Vec
from minirt.rendering.packing import light_buffers, lights
from minirt.rendering.packing.lights import Colours, light_grid, positions_and_intensities, spot_parameters
from minirt.rendering.renderer import Renderer
from minirt.scene import Ambient, Background, Camera, FurtherLight, Lamp, ParallelLight, Scene, SpotLight
from minirt.shapes import Plane, Sphere
from tests.seeds import seed_of


def many_lamps(seed: int) -> list[Lamp]:
    """Return some hundred lamps, near the origin or far from it, most of which fade, within distances of any size."""
    random = np.random.default_rng(seed)
    offset, size = random.choice([0, 1e3, 1e8]) * random.normal(size=3), 10.0 ** random.uniform(-2, 2)

    def lamp() -> Lamp:
        place = tuple(offset + 10 * random.normal(size=3))
        fade = None if random.random() < 0.1 else size * 10.0 ** random.uniform(-1, 1)
        if random.random() < 0.2:
            return SpotLight(place, tuple(random.normal(size=3).clip(-1, 1)), random.uniform(5, 170), 0.5, fade=fade)
        return FurtherLight(place, 0.5, (255, 200, 100), fade=fade)

    return [*(lamp() for _ in range(random.integers(10, 300))), ParallelLight((0, -1, 0), 0.1)]


def grid_of(lamps: list[Lamp]) -> LightGrid:
    grid = light_grid(positions_and_intensities(lamps, Colours()), spot_parameters(lamps))
    assert grid
    assert len(grid.grids)
    return grid


def missing(lamps: list[Lamp], grid: LightGrid, seed: int) -> int:
    """Count the lamps that shine at points of packets and are not listed for them; many points are at ends of reach."""
    random, lost = np.random.default_rng(seed), 0
    positions, spots = positions_and_intensities(lamps, Colours()), spot_parameters(lamps)
    for _ in range(100):
        lamp = lamps[random.integers(len(lamps) - 1)]
        ways = random.normal(size=3) + random.choice([0.0, 1e-9, 1e-3, 1.0]) * random.normal(size=(4, 3))
        reach = (lamp.fade or 10.0) * random.choice([random.random(), 1 - 1e-6, 2.0])
        points = np.array(lamp.position)[:, None] + reach * (ways / np.linalg.norm(ways, axis=1)[:, None]).T
        rounding, hit = 16 * 2.0**-53 * np.abs(points).max(axis=0), random.random(4) < 0.8
        hit[0] = True
        start, end = sources_in_reach(grid, Vec(*points), rounding, hit)
        listed = grid.sources[start:end].tolist()
        assert listed == sorted(listed)
        for i in {*range(len(lamps))}.difference(listed):
            with np.errstate(all="ignore"):
                _, _, strengths = incident_light(spots, i, Vec(*positions[i, :3]), Vec(*points))
            lost += (strengths[hit] > 0.0).any()
    return lost


def test_each_cell_lists_all_light_sources_that_shine_there_in_order() -> None:
    for seed in (seed_of(f"lamps {number}") for number in range(6)):
        lamps = many_lamps(seed)
        assert missing(lamps, grid_of(lamps), seed) == 0, f"seed {seed}"


def test_a_grid_of_light_sources_that_reach_less_is_noticed() -> None:
    places = np.random.default_rng(1).uniform(-10, 10, (200, 3))
    lamps: list[Lamp] = [FurtherLight(tuple(place), 1, fade=4.0) for place in places]
    shorter = [each.replace(fade=3.0) for each in lamps]
    assert missing(lamps, grid_of(shorter), 1) > 10


def test_lists_grow_with_the_neighbours_of_light_sources_not_with_their_number() -> None:
    def longest(count: int) -> int:
        lamps: list[Lamp] = [FurtherLight((x, 0, z), 1, fade=1.5) for x in range(count) for z in range(count)]
        grid = grid_of(lamps)
        return int(np.diff(grid.starts)[: int(grid.grids[1, 7])].max())

    assert longest(8) == longest(30) < 25


STAGE = [
    Ambient(0.1, (255, 255, 255)),
    Camera((0, 3, -9), (0, -0.3, 1), 70),
    Plane((0, 0, 0), (0, 1, 0), (200, 200, 200)),
    *(Sphere((x, 0.7, z), 1.2, (90, 200, 150), mirror=0.5 * (x < 0)) for x in range(-6, 7, 2) for z in range(-4, 9, 2)),
    *(
        FurtherLight((x + 0.7, 1.5 + 0.1 * z, z), 0.3, (255, 200 - 9 * z, 220), fade=3.5, size=0.2 if x == 3 else None)
        for x in range(-6, 7)
        for z in range(-4, 9, 2)
    ),
]


def test_a_spot_light_whose_rim_has_no_width_is_as_steep_as_can_be() -> None:
    sharp, soft = (SpotLight((0, 9, 0), (0, -1, 0), 40, 1, rim=rim) for rim in (0, 0.5))
    assert spot_parameters([sharp, soft])[:, 4] == pytest.approx([1e30, 1 / (cos(radians(10)) - cos(radians(20)))])


@pytest.mark.parametrize("precision", ["double", "single"])
def test_light_that_fades_is_culled_without_changing_a_bit(precision: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """Neither by cells of space, nor by shapes beyond its reach, which hide nothing that it lights."""

    def picture() -> np.ndarray:
        pixels = np.zeros((45, 80, 4), np.uint8)
        plain = {Sphere: {"mirror": None}, FurtherLight: {"size": None}} if precision == "single" else {}
        scene = Scene(each.replace(**plain.get(type(each), {})) for each in STAGE)
        linear = np.zeros((45, 80, 3))
        Renderer(1, precision).render(scene, pixels, linear=linear)
        return linear

    def reaching(share: float) -> None:
        monkeypatch.setattr(light_buffers, "seen_by_light", lambda *at: binned(*at[:6], share * at[6], *at[7:]))

    culled, binned = picture(), light_buffers.seen_by_light
    reaching(inf)
    monkeypatch.setattr(lights, "MANY", 10**6)
    assert np.array_equal(picture(), culled)
    reaching(0.3)
    assert (picture() != culled).any(axis=-1).mean() > 0.01


def test_the_light_of_many_sources_is_the_sum_of_the_light_of_each() -> None:
    """More than `TOGETHER` of them shine part by part, whether packets are drawn tile by tile or by a plan."""
    others = [Background((20, 40, 60)), *(each for each in STAGE if not isinstance(each, Lamp))]
    spread = np.random.default_rng(1).uniform(-6, 6, (5 * TOGETHER // 2, 2)).tolist()
    lamps = [FurtherLight((x, 3.0 + 0.1 * z, z), 0.02, (255, 200, 220)) for x, z in spread]

    def light_of(lamps: list[FurtherLight]) -> np.ndarray:
        scene, pixels, linear = Scene([*others, *lamps]), np.zeros((45, 80, 4), np.uint8), np.zeros((45, 80, 3))
        stage.render(scene, pixels, 2, linear)
        again = linear.copy()
        stage.render(scene, pixels, 2, again, edges_only=True)
        assert np.array_equal(again, linear)
        return linear

    stage, parts = Renderer(1), [lamps[start : start + 40] for start in range(0, len(lamps), 40)]
    expected = sum(map(light_of, parts)) - (len(parts) - 1) * light_of([])
    np.testing.assert_allclose(light_of(lamps), expected, rtol=1e-12, atol=1e-13)
    assert (np.abs(light_of(lamps[1:]) - expected) > 1e-6).mean() > 0.1
