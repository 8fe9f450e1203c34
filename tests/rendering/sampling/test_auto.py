"""Automatic sampling: promised errors, compared with pictures of thousands of samples at other positions."""

from __future__ import annotations

from functools import cache
from math import sqrt
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

import minirt
from minirt.cli.arguments import OPTIONS
from minirt.rendering.frame import COUNTS
from minirt.rendering.outcome import MOST_SAMPLES, Outcome
from minirt.rendering.renderer import Renderer
from minirt.rendering.sampling import packets as sampling
from minirt.rendering.sampling.auto import PROBES, REFERENCES, AutoSampler
from minirt.rendering.sampling.packets import CLASSES, LEAST_PROBES, Packets
from minirt.scene import Ambient, Camera, Light, Scene
from minirt.shapes import Cylinder, Plane, Sphere
from tests.kernel.pictures import ALL, AMBIENT, EVERY, EYE, TWO
from tests.paths import SCENES
from tests.random_scenes import random_scene
from tests.rendering.test_frame_runner import cancelled
from tests.seeds import seed_of
from tests.simulated_clock import PACKET_SECONDS, Clock, packets, simulate_clock

Array = NDArray[np.float64]

WIDTH, HEIGHT = 160, 90
EXCESS = 1.3  # of a true error over the wanted one, in none of all
VIEW = (Ambient(0.2, (255, 255, 255)), Camera((0, 1, -10), (0, -0.05, 1), 60), Light((-6, 9, -6), 0.7, (255, 255, 255)))
FLOOR = Plane((0, -2, 0), (0, 1, 0), (200, 200, 200))
FAR = (Sphere((0, 0, -50), 0.1, (9, 9, 9)), Cylinder((0, 0, -50), (0, 1, 0), 0.1, 0.1, (9, 9, 9)))  # behind the eye


def thin() -> Scene:
    """Cylinders of a tenth of a pixel."""
    random = np.random.default_rng(5)
    places = random.uniform((-5, -1, -1), (5, 4, 6), (40, 3))
    ways = random.uniform(-1, 1, (40, 3))
    pairs = zip(places, ways, strict=True)
    return Scene((*VIEW, FLOOR, FAR[0], *(Cylinder(tuple(p), tuple(w), 0.01, 4, (250, 80, 40)) for p, w in pairs)))


def tiny() -> Scene:
    """Spheres, some of them smaller than a pixel."""
    random = np.random.default_rng(6)
    places = random.uniform((-5, -2, -1), (5, 4, 6), (500, 3))
    return Scene((*VIEW, FLOOR, FAR[1], *(Sphere(tuple(p), 0.06, (90, 200, 250)) for p in places)))


KNOWN = {
    "all": ALL,
    "every kind": EVERY,
    "demo": minirt.load(SCENES / "demo.rt"),
    "subject": minirt.load(SCENES / "subject.rt"),
    "everything": minirt.load(SCENES / "figure-v4-everything.rt"),
    "random": random_scene(18),
    "thin": thin(),
    "tiny": tiny(),
}


@cache
def reference(name: str) -> Array:
    linear = np.zeros((HEIGHT, WIDTH, 3))
    assert TWO.render(KNOWN[name], np.zeros((HEIGHT, WIDTH, 4), np.uint8), 1500, linear)
    return np.clip(linear, 0, 1)


def reach(
    scene: Scene,
    error: float = 0.0,
    seconds: float = np.inf,
    size: tuple[int, int] = (HEIGHT, WIDTH),
    renderer: Renderer = TWO,
) -> tuple[Outcome, NDArray[np.uint8], Array]:
    pixels, linear = np.zeros((*size, 4), np.uint8), np.zeros((*size, 3))
    reached = renderer.reach(scene, pixels, error, seconds, linear)
    assert reached
    return reached, pixels, linear


def minirt_picture(scene: Scene) -> NDArray[np.uint8]:
    pixels = np.zeros((HEIGHT, WIDTH, 4), np.uint8)
    assert TWO.render(scene, pixels)
    return pixels


def rms(difference: Array) -> float:
    return float(np.sqrt((difference**2).mean()))


@pytest.mark.parametrize("requested", [0.02, 0.006, 0.002])
@pytest.mark.parametrize("name", KNOWN)
def test_the_true_error_is_as_requested_and_as_estimated(name: str, requested: float) -> None:
    reached, pixels, linear = reach(KNOWN[name], requested)
    true = rms(np.clip(linear, 0, 1) - reference(name))
    assert reached.error <= requested
    assert reached.error / true > 0.6  # so small a picture has few probes, and doubt leans to one side
    assert reached.error / true < 3 or reached.samples < 1.1  # what is expected weighs as much as probes of one sample
    assert true < EXCESS * requested
    assert true > requested / 5 or reached.most <= 4
    assert 1 <= reached.samples <= reached.most
    shown = pixels[..., 2::-1] / 255
    assert np.abs(shown - np.clip(linear, 0, 1)).max() < 0.501 / 255


def test_a_picture_may_be_good_enough_after_the_first_round() -> None:
    reached, pixels, _ = reach(ALL, 0.5)
    assert (reached.samples, reached.most) == (1, 1)
    assert np.array_equal(pixels, minirt_picture(ALL))
    assert 0 < reached.error < 0.5
    assert pixels[..., :3].any()


@pytest.mark.parametrize("precision", ["double", "single"])
def test_threads_do_not_change_a_bit(precision: str) -> None:
    made = [reach(ALL, 0.004, size=(45, 83), renderer=Renderer(threads, precision)) for threads in (1, 2, 13, 2, 2)]
    for reached, pixels, linear in made[1:]:
        assert reached[:3] == made[0][0][:3]
        assert np.array_equal(pixels, made[0][1])
        assert np.array_equal(linear, made[0][2])


@pytest.mark.parametrize("size", [(1, 1), (1, 50), (50, 1), (7, 9), (3, 3)])
def test_pictures_of_any_size_reach_the_error(size: tuple[int, int]) -> None:
    reached, pixels, linear = reach(ALL, 0.01, size=size)
    fine = np.zeros((*size, 3))
    TWO.render(ALL, np.zeros_like(pixels), 1000, fine)
    assert reached.error <= 0.01
    assert rms(np.clip(linear, 0, 1) - np.clip(fine, 0, 1)) < 0.05


def test_a_scene_without_shapes_has_no_error() -> None:
    reached, pixels, _ = reach(Scene((AMBIENT, EYE)), 0.01, size=(5, 7))
    assert reached.error == 0
    assert (pixels == (0, 0, 0, 255)).all()


@pytest.fixture
def clock(monkeypatch: pytest.MonkeyPatch) -> Clock:
    """A clock that only rendering moves on."""
    return simulate_clock(monkeypatch)


COUNT = packets(WIDTH, HEIGHT)
FIRST = (COUNT + round(PROBES / (1 + REFERENCES) * COUNT) * (1 + REFERENCES)) * PACKET_SECONDS  # the first sweep


@pytest.mark.parametrize("rounds", [0.0, 0.5, 1.0, 2.0, 10.0, 100.0])
def test_a_time_is_kept_and_used(clock: Clock, rounds: float) -> None:
    """The time is in multiples of the first sweep, which is always rendered."""
    reached = reach(ALL, seconds=rounds * FIRST)[0]
    assert reached.seconds == pytest.approx(clock.wall)
    assert clock.wall <= max(1.05 * rounds, 1.1) * FIRST
    assert clock.wall >= 0.9 * rounds * FIRST


def test_the_time_includes_packing_the_scene(clock: Clock, monkeypatch: pytest.MonkeyPatch) -> None:
    pack = TWO.packing.pack

    def slow(*arguments: Any) -> Any:
        clock.wall += 5 * FIRST
        return pack(*arguments)

    monkeypatch.setattr(TWO.packing, "pack", slow)
    reached = reach(ALL, seconds=10 * FIRST)[0]
    assert 9 * FIRST < clock.wall <= 1.05 * 10 * FIRST
    assert reached.seconds == pytest.approx(clock.wall)


def test_a_time_may_end_before_an_error_is_reached(clock: Clock) -> None:
    reached = reach(ALL, 1e-7, 10 * FIRST)[0]
    assert reached.error > 1e-7
    assert reached.seconds <= 1.05 * 10 * FIRST


def test_cancelling_ends_rendering() -> None:
    renderer = Renderer(2)
    renderer.prepare(ALL)
    pixels = np.full((720, 1280, 4), 9, np.uint8)
    assert cancelled(renderer, lambda: renderer.reach(ALL, pixels, 1e-9)) is None  # for which a day would not be enough
    assert renderer.reach(ALL, pixels, 0.1)


def test_a_cancel_between_two_frames_is_heard(monkeypatch: pytest.MonkeyPatch) -> None:
    renderer = Renderer(2)
    sweep = AutoSampler.sweep

    def cancelled(self: AutoSampler, *arguments: Any, **more: Any) -> Any:
        renderer.cancel()
        return sweep(self, *arguments, **more)

    monkeypatch.setattr(AutoSampler, "sweep", cancelled)
    assert renderer.reach(ALL, np.zeros((HEIGHT, WIDTH, 4), np.uint8), 1e-6) is None


# Pictures of known errors: each packet leaves c / n^1.5 with n samples, and probes are as noisy as those of edges.


def excesses(seed: int, pictures: int = 120) -> np.ndarray:
    """The true errors of pictures, in those that were asked for; classes have other errors than is expected of them."""
    random, found, shares = np.random.default_rng(seed), [], []
    for _ in range(pictures):
        grid = Packets(4 * random.integers(10, 60), 4 * random.integers(10, 60), 4)
        classes = random.integers(random.integers(CLASSES), CLASSES, grid.count)
        c = (grid.c * random.lognormal(-0.5, 0.8, CLASSES))[classes] * random.exponential(1, grid.count)

        def draw(_: object, plan: Array, errors: Array, *__: object, grid: Packets = grid, c: Array = c) -> None:
            packet = plan[:, 1] * grid.columns + plan[:, 0]
            errors[:] = c[packet] * plan[:, 3] ** -1.5 * random.normal(1, 0.7, len(plan))

        contrasts = classes.reshape(-1, grid.columns)
        sampler = AutoSampler(draw, lambda contrasts=contrasts: contrasts, grid, grid.count, 16)
        goal = sqrt(c.mean() * random.uniform(0.01, 1) ** 1.5)
        sampler.reach(goal, np.inf)
        drawn = COUNTS[grid.levels]
        shares.append(sampler.probed / (grid.count + drawn.sum() + LEAST_PROBES * REFERENCES * drawn.max()))
        found.append(sqrt((c * COUNTS[grid.levels] ** -1.5).mean()) / goal)
    assert np.median(shares) < 1.1 * PROBES, "probes take more than their share"
    return np.array(found)


def test_the_wanted_error_is_kept_where_classes_are_misjudged(monkeypatch: pytest.MonkeyPatch) -> None:
    seed = seed_of("misjudged classes")
    kept = excesses(seed)
    assert np.quantile(kept, 0.95) < 1, seed
    assert np.median(kept) > 0.4, seed
    monkeypatch.setattr(sampling, "CERTAINTY", 0.0)  # estimates as they are
    assert (excesses(seed) <= 1).mean() < 0.85, seed


@pytest.mark.parametrize(("share", "frames"), [(2.0, 1), (0.1, 2)])
def test_a_first_sweep_that_is_enough_is_the_only_one(share: float, frames: int) -> None:
    """The others are of probes, and one more of packets that get more samples."""
    grid, plans = Packets(80, 200, 4), []

    def draw(_: object, plan: Array, errors: Array) -> None:
        plans.append(plan)
        errors[:] = grid.c[-1] * plan[:, 3] ** -1.5

    classes = np.full((20, 50), CLASSES - 1)
    reached = AutoSampler(draw, lambda: classes, grid, grid.count, 16).reach(sqrt(2 * share * grid.c[-1]), np.inf)
    assert sum(not len(plan) for plan in plans) == 1
    assert sum(not plan[:, 4].any() for plan in plans) == frames
    assert (reached.most == 1) == (frames == 1)


# Outcomes of automatic sampling: whether the goal was reached, and what is said about it.


REACHED = Outcome(4.0, 16, 0.002, 0.1, goal=0.003)


@pytest.mark.parametrize(
    ("outcome", "is_reached", "notice"),
    [
        (REACHED, True, ""),
        (REACHED._replace(goal=0.002), True, ""),
        (REACHED._replace(goal=0.0), True, ""),
        (REACHED._replace(goal=0.001), False, "error 0.001 not reached: the time was over"),
        (
            REACHED._replace(goal=0.001, most=MOST_SAMPLES),
            False,
            f"error 0.001 not reached: some pixels have {MOST_SAMPLES} samples, the most there are",
        ),
        (
            REACHED._replace(goal=0.001, rounded=True, rounding=0.006),
            False,
            "no more samples: rounding to 8 bits decides below an error of 0.003",
        ),
    ],
)
def test_a_goal_that_is_not_reached_is_said_with_the_reason(outcome: Outcome, is_reached: bool, notice: str) -> None:
    assert f" {MOST_SAMPLES} at most" in OPTIONS
    assert outcome.is_reached is is_reached
    assert outcome.notice == notice
