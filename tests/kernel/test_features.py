"""Whole frames: all features in one scene as interpreted, cancelled frames, and single precision."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image as pillow  # noqa: N813

from minirt.kernel import frame
from minirt.kernel import interpreted as kernel
from minirt.kernel.frame import CANCELLED
from minirt.kernel.pixels import TILE
from minirt.lanes import Vec
from minirt.materials import Bump, Checker, Glass, Mirror, Specular, Tint
from minirt.rendering.frame import frame_arguments
from minirt.rendering.renderer import Renderer
from minirt.rendering.scene_packing import Packing
from minirt.scene import Background, FurtherLight, Light, ParallelLight, Scene, SpotLight
from minirt.shapes import Cylinder, Plane, Sphere
from tests.kernel.pictures import ALL, AMBIENT, BLUE, EYE, GREEN, ONE, RED, WHITE, interpreted, linear, picture
from tests.kernel.test_invariances import changed, interior, scaled
from tests.random_scenes import random_scene


@pytest.fixture
def scene(tmp_path: Path) -> Scene:
    """A scene with every feature, and enough shapes for light buffers."""
    random = np.random.default_rng(1)
    for name in ("colours.png", "heights.png", "sky.png"):
        pillow.fromarray(random.integers(0, 256, (8, 16, 3), np.uint8)).save(tmp_path / name)
    normals = np.concatenate([random.integers(90, 166, (8, 8, 2)), np.full((8, 8, 1), 240)], axis=-1).astype(np.uint8)
    pillow.fromarray(normals).save(tmp_path / "normals.png")
    items = (
        AMBIENT,
        EYE,
        Background("sky.png"),
        Light((-4, 6, -5), 0.5),
        FurtherLight((5, 3, -2), 0.6, (120, 160, 255), fade=12.0),
        ParallelLight((0.3, -0.9, 0.2), 0.3),
        SpotLight((0, 7, -3), (0, -1, 0.3), 50, 0.8, rim=0.4),
        Plane((0, -1, 0), (0, 1, 0), WHITE, checker=Checker(0.7, (90, 60, 60)), mirror=0.2),
        Sphere((-1.5, 0.2, 0), 2.4, RED, specular=Specular(0.6, 30)),
        Sphere(
            (1, 0, -3),
            1.5,
            WHITE,
            glass=Glass(1.5, 0.8, 20.0),
            tint=Tint((250, 200, 120)),
            fresnel=1.0,
            specular=Specular(0.6, 90, blinn=True),
        ),
        Cylinder((1.5, 0.3, 1.5), (0.3, 0.9, -0.2), 1.6, 2.5, GREEN, texture="colours.png"),
        Sphere((0.3, 1.6, 0), 1.2, BLUE, bump=Bump("heights.png", 0.1), mirror=Mirror(0.3, 9.0), glow=0.1),
        Sphere((3, 0.5, -1), 1.4, WHITE, normal_map="normals.png", checker=Checker(0.125)),
        *(Sphere((-4 + i, -0.7, -2 - i % 2), 0.6, (200, 40 * i, 90)) for i in range(6)),
    )
    return Scene(items, tmp_path / "scene.rt")


def test_compiled_and_interpreted_pictures_are_the_same(scene: Scene) -> None:
    pixels, light = picture(scene, 32, 20, renderer=ONE)
    interpreted_pixels, expected = interpreted(scene, 32, 20)
    # Rounding may send a ray to the other side of an edge, and curved mirrors and glass magnify it.
    different = np.abs(light - expected).max(axis=-1) > 1e-9
    assert different.mean() < 0.01
    assert (np.abs(pixels.astype(int) - interpreted_pixels)[~different] <= 1).all()
    assert len(np.unique(pixels.reshape(-1, 4), axis=0)) > 400


WIDTH, HEIGHT, SAMPLES = 40, 24, 2
PACKETS = 10 * 6 * SAMPLES


class Counter:
    """A row counter that cancels the frame after a number of reads."""

    def __init__(self, reads: float) -> None:
        self.row, self.reads_left = 0, reads

    def __getitem__(self, index: int) -> int:
        self.reads_left -= 1
        return CANCELLED if self.reads_left < 0 else self.row

    def __setitem__(self, index: int, row: int) -> None:
        self.row = row


def packets_after(reads: float, monkeypatch: pytest.MonkeyPatch) -> tuple[int, int]:
    """Count the packets traced before and after a frame is cancelled, which happens after some reads of the counter."""
    counter, counts = Counter(reads), [0, 0]
    packet = frame.packet_radiance

    def counting_packet(*arguments: Any) -> Vec:
        counts[counter.reads_left <= 0] += 1
        return packet(*arguments)

    monkeypatch.setattr(frame, "packet_radiance", counting_packet)
    traced = Packing(kernel).pack(ALL, WIDTH, HEIGHT)
    arguments = frame_arguments(traced, np.zeros((HEIGHT, WIDTH, 4), np.uint8), SAMPLES)
    with np.errstate(all="ignore"):
        frame.frame(*arguments._replace(next_row=counter))
    before, after = counts
    return before, after


@pytest.mark.parametrize("reads", [0, 1, 2, 3, 4, 20, 60, PACKETS - TILE])
def test_at_most_one_packet_is_traced_after_a_cancel(reads: int, monkeypatch: pytest.MonkeyPatch) -> None:
    before, after = packets_after(reads, monkeypatch)
    assert 2 * reads // 3 - 6 <= before <= reads  # three more reads for each row of tiles, and one for each pixel
    assert after <= 1


def test_all_packets_are_traced_if_nobody_cancels(monkeypatch: pytest.MonkeyPatch) -> None:
    assert packets_after(np.inf, monkeypatch) == (PACKETS, 0)


TWO = Renderer(2, "single")


def single(scene: Scene, renderer: Renderer = TWO) -> Any:
    """Render a scene in single precision."""
    return linear(scene, 60, 40, renderer=renderer)


def test_single_precision_differs_from_double_by_rounding_away_from_edges() -> None:
    difference = np.abs(single(ALL) - linear(ALL, 60, 40)).max(axis=-1)
    assert 0 < difference[interior(ALL, 60, 40)].max() < 2e-5
    assert np.quantile(difference, 0.99) < 2e-5


@pytest.mark.parametrize("seed", range(20))
def test_random_scenes_differ_from_double_precision_at_edges_only(seed: int) -> None:
    scene = random_scene(seed)
    difference = np.abs(single(scene) - linear(scene, 60, 40)).max(axis=-1)
    assert np.quantile(difference, 0.98) < 1 / 255


@pytest.mark.parametrize("shift", [(1e8, 0, 0), (-1e6, 1e7, 1e6), (1e4, -1e4, 1e3)])
def test_coordinates_are_relative_to_the_eye(shift: tuple[float, float, float]) -> None:
    moved = changed(ALL, lambda p: tuple(x + y for x, y in zip(p, shift, strict=True)))
    difference = np.abs(single(moved) - single(ALL)).max(axis=-1)
    assert np.quantile(difference, 0.99) < 1e-4


@pytest.mark.parametrize("power", [-20, -1, 1, 20])
def test_a_scene_scaled_by_a_power_of_two_gives_the_same_bits(power: int) -> None:
    assert np.array_equal(single(scaled(ALL, 2.0**power)), single(ALL))


def test_interpreted_and_compiled_pictures_differ_by_rounding() -> None:
    difference = np.abs(interpreted(ALL, precision="single")[1] - linear(ALL, 24, 16, renderer=TWO)).max(axis=-1)
    assert np.quantile(difference, 0.98) < 2e-5
