"""The features that a scene uses."""

from __future__ import annotations

from minirt.materials import Checker, Clouds, Glass, Marble, Mirror, Specular, Tint, Wood
from minirt.rendering.packing.features import features
from minirt.scene import Ambient, Background, Camera, FurtherLight, Light, ParallelLight, Scene, SpotLight
from minirt.shapes.plane import Plane
from minirt.shapes.sphere import Sphere

GREY = (128, 128, 128)
EYE = Camera((0, 0, -9), (0, 0, 1), 60)
LIGHT = Ambient(0.2, GREY)
BALL = Sphere((0, 0, 0), 1, GREY)
SUN = ParallelLight((0, -1, 0), 0.5)


def features_of(*elements: object) -> set[object]:
    return set(features(Scene((LIGHT, EYE, *elements))))  # type: ignore[arg-type]


def test_a_plain_scene_uses_only_its_kinds() -> None:
    assert features_of(BALL, Plane((0, 0, 0), (0, 1, 0), GREY), Light((0, 9, 0), 1)) == {Sphere, Plane}


def test_each_feature_is_found_where_it_is_used() -> None:
    assert features_of(BALL.replace(specular=Specular(0.5, 20))) == {Sphere, "specular"}
    assert features_of(BALL.replace(mirror=0.5)) == {Sphere, "reflective"}
    assert features_of(BALL.replace(mirror=Mirror(0.5, 9.0))) == {Sphere, "reflective", "fades"}
    assert features_of(BALL.replace(mirror=0.5, fresnel=1.0)) == {Sphere, "reflective", "fresnel"}
    glass = BALL.replace(glass=Glass(1.5))
    assert features_of(glass) == {Sphere, "reflective", "transparent"}
    assert features_of(glass.replace(glass=Glass(1.5, fade=9.0))) == {Sphere, "reflective", "transparent", "fades"}
    assert features_of(glass.replace(tint=Tint((9, 9, 9)))) == {Sphere, "reflective", "transparent", "media"}
    assert features_of(BALL.replace(glow=0.5)) == {Sphere, "glow"}
    assert features_of(BALL.replace(checker=Checker(0.5)), BALL) == {Sphere, "checks"}
    assert features_of(BALL.replace(marble=Marble(1.0), wood=Wood(1.0))) == {Sphere, "patterns"}
    assert features_of(BALL.replace(clouds=Clouds(1.0, height=0.1))) == {Sphere, "raised_patterns"}
    assert features_of(Background((0, 0, 9))) == {"background"}
    assert features_of(SUN) == {"spots", "parallel"}
    assert features_of(SpotLight((0, 9, 0), (0, -1, 0), 40, 1)) == {"spots"}
    assert features_of(FurtherLight((0, 9, 0), 1, fade=5.0)) == {"spots"}


def test_elements_without_effect_use_no_feature() -> None:
    no_effect = BALL.replace(specular=Specular(0, 20), mirror=Mirror(0.0, 9.0), glass=Glass(1.5, 0), glow=0.0)
    needs_more = BALL.replace(tint=Tint((9, 9, 9)), fresnel=1.0)
    black = SpotLight((0, 9, 0), (0, -1, 0), 40, 0), ParallelLight((0, -1, 0), 1, (0, 0, 0))
    assert features_of(no_effect, Background((0, 0, 0)), *black, needs_more) == {Sphere}
