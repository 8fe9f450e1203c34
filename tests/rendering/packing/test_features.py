"""What a scene asks of the kernel."""

from __future__ import annotations

from minirt.materials import Checker, Glass, Specular
from minirt.rendering.culling.visibility import SMALL
from minirt.rendering.packing.features import features
from minirt.rendering.running.kernel_features import kernel_features, minimal_scene
from minirt.scene import Ambient, Background, Camera, FurtherLight, Light, ParallelLight, Scene, SpotLight
from minirt.shapes.cylinder import Cylinder
from minirt.shapes.plane import Plane
from minirt.shapes.sphere import Sphere

GREY = (128, 128, 128)
EYE = Camera((0, 0, -9), (0, 0, 1), 60)
LIGHT = Ambient(0.2, GREY)
BALL = Sphere((0, 0, 0), 1, GREY)
SUN = ParallelLight((0, -1, 0), 0.5)


def of(*elements: object) -> set[object]:
    return set(features(Scene((LIGHT, EYE, *elements))))  # type: ignore[arg-type]


def test_a_plain_scene_asks_for_its_kinds_alone() -> None:
    assert of(BALL, Plane((0, 0, 0), (0, 1, 0), GREY), Light((0, 9, 0), 1)) == {Sphere, Plane}


def test_each_feature_is_asked_for_where_it_is_used() -> None:
    assert of(BALL.replace(specular=Specular(0.5, 20))) == {Sphere, "specular"}
    assert of(BALL.replace(mirror=0.5)) == {Sphere, "reflective"}
    assert of(BALL.replace(glass=Glass(1.5))) == {Sphere, "reflective"}
    assert of(BALL.replace(checker=Checker(0.5)), BALL) == {Sphere, "checks"}
    assert of(Background((0, 0, 9))) == {"background"}
    assert of(SUN) == {"spots", "parallel"}
    assert of(SpotLight((0, 9, 0), (0, -1, 0), 40, 1)) == {"spots"}
    assert of(FurtherLight((0, 9, 0), 1, fade=5.0)) == {"spots"}


def test_what_does_nothing_asks_for_nothing() -> None:
    idle = BALL.replace(specular=Specular(0, 20), mirror=0.0, glass=Glass(1.5, 0))
    black = SpotLight((0, 9, 0), (0, -1, 0), 40, 0), ParallelLight((0, -1, 0), 1, (0, 0, 0))
    assert of(idle, Background((0, 0, 0)), *black) == {Sphere}


def test_a_small_scene_needs_the_same() -> None:
    balls = [Sphere((i, 0, 0), 1, GREY, mirror=0.5 if i == 70 else None) for i in range(100)]
    tube = Cylinder((0, 0, 0), (0, 1, 0), 1, 2, GREY, checker=Checker(0.1))
    for elements in ((BALL,), (*balls, tube, SUN), (*balls[: SMALL + 1], SUN), (BALL, SUN)):
        scene = Scene((LIGHT, EYE, *elements))
        assert kernel_features(minimal_scene(scene)) == kernel_features(scene)
        assert len(minimal_scene(scene).shapes) <= SMALL + 2
    assert "bvh" in kernel_features(Scene((LIGHT, EYE, *balls, SUN)))
    assert "bvh" not in kernel_features(Scene((LIGHT, EYE, *balls)))
