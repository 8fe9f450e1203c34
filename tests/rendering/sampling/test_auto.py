"""Automatic sampling: promised errors, compared with pictures of thousands of samples at other positions."""

from __future__ import annotations

from functools import cache
from math import sqrt
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

import minirt
from minirt.kernel.frame import REFERENCE_SAMPLES
from minirt.rendering import Renderer
from minirt.rendering.outcome import MOST_SAMPLES, Outcome
from minirt.rendering.sampling.auto import FIRST_PROBES, AutoSampler
from minirt.scene import Ambient, Camera, Light, Scene
from minirt.shapes.cylinder import Cylinder
from minirt.shapes.plane import Plane
from minirt.shapes.sphere import Sphere
from tests.kernel.pictures import ALL, AMBIENT, EVERY, EYE, TWO
from tests.paths import SCENES
from tests.random_scenes import random_scene
from tests.rendering.test_frame_runner import cancelled
from tests.simulated_clock import PACKET_SECONDS, Clock, packets, simulate_clock

Array = NDArray[np.float64]

WIDTH, HEIGHT = 160, 90
FACTOR = 1.5  # between promised and true errors
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
    assert 1 / FACTOR < reached.error / true < FACTOR
    assert true < FACTOR * requested
    assert true > requested / FACTOR or reached.most <= 3
    assert 1 <= reached.samples <= reached.most
    shown = pixels[..., 2::-1] / 255
    assert np.abs(shown - np.clip(linear, 0, 1)).max() < 0.501 / 255


def test_estimated_errors_are_true_on_average() -> None:
    """Without independent judges, the estimates of pictures that stop too early would all be too small."""
    ratios = []
    for name, scene in KNOWN.items():
        for requested in (0.01, 0.003, 0.0015):
            reached, _, linear = reach(scene, requested)
            ratios.append(reached.error / rms(np.clip(linear, 0, 1) - reference(name)))
    assert 0.9 < np.median(ratios) < 1.1


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
# Of the clock for the first sweep: a sample of each packet, and for those that are probed another and two references.
FIRST = (COUNT + (1 + 2 * REFERENCE_SAMPLES) * FIRST_PROBES) * PACKET_SECONDS


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

    def cancelled(self: AutoSampler, *arguments: Any) -> None:
        renderer.cancel()
        sweep(self, *arguments)

    monkeypatch.setattr(AutoSampler, "sweep", cancelled)
    assert renderer.reach(ALL, np.zeros((HEIGHT, WIDTH, 4), np.uint8), 1e-6) is None


# When automatic sampling ends with its first sweep: by how much the mean of the probes may be in doubt.


PACKETS = 100  # all of them are probed
EVEN = np.full(PACKETS, 0.04)
UNEVEN = np.repeat([1.0, 0.0], [4, 96])  # the same mean, with a standard error of 0.0196


class FirstSweep(AutoSampler):
    """A sampler whose first sweep finds these squared errors, and that only notes whether it refines them."""

    def __init__(self, errors: np.ndarray) -> None:
        packets: Any = SimpleNamespace(errors=errors, count=PACKETS, samples=(1.0, 1))
        super().__init__(lambda _: True, lambda: (errors, errors), packets, PACKETS, 1)
        self.refines = False

    def draw_first(self) -> None:
        pass

    def refine(self, goal: float, end: float) -> float:
        self.refines = True
        return goal


@pytest.mark.parametrize(
    ("errors", "squared_goal", "refines"),
    [
        (EVEN, 0.03, True),
        (EVEN, 0.05, False),
        (UNEVEN, 0.05, True),
        (UNEVEN, 0.08, True),  # above mean and standard error, but the doubt is vague: 0.0792 / 0.7 = 0.113 counts
        (UNEVEN, 0.11, True),
        (UNEVEN, 0.12, False),
    ],
)
def test_the_first_sweep_is_enough_where_its_doubt_leaves_the_goal_certain(
    errors: np.ndarray, squared_goal: float, refines: bool
) -> None:
    sampler = FirstSweep(errors)
    assert sampler.reach(sqrt(squared_goal), 1e9)
    assert sampler.refines is refines


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
    assert outcome.is_reached is is_reached
    assert outcome.notice == notice
