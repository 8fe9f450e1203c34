"""Previews: the interpreted picture equals the compiled one, in a resolution that fits the time."""

from __future__ import annotations

import re
from random import SystemRandom
from typing import Any

import numpy as np
import pytest

import minirt
from minirt.kernel import trace
from minirt.kernel.scene_arrays import intersect
from minirt.lanes import Vec
from minirt.rendering import Renderer
from minirt.rendering.notices import NOT_COMPUTED, notices_about
from minirt.rendering.packing.features import features
from minirt.rendering.queries import preview as module
from minirt.rendering.queries.pick import pick
from minirt.rendering.queries.preview import (
    BUDGET,
    FEWEST,
    RAY,
    SHAPE,
    hidden_shapes,
    is_blank,
    notice_about,
    preview,
    render_interpreted,
)
from minirt.scene import Ambient, Camera, Light, Scene, load, parse
from minirt.shapes.sphere import Sphere
from tests.kernel import pictures
from tests.kernel.pictures import EVERY, TWO
from tests.paths import SCENES, scene_files

MIRRORS = ("material-mirror",)
PLAIN = Renderer(2, depth=0)
SOME = SystemRandom().sample(scene_files(), 24)  # others each run


@pytest.mark.parametrize("number", range(len(SOME)))
def test_every_interpreted_picture_equals_the_compiled_one(number: int) -> None:
    path = SOME[number]
    scene = minirt.load(path, lenient=True)
    if "reflective" in features(scene) and path.stem not in MIRRORS:
        return  # a preview has no reflections; compiling for one such scene is enough
    pixels, light = pictures.picture(scene, 64, 36, renderer=PLAIN)
    made, seen = render_interpreted(scene, 64, 36)
    np.testing.assert_allclose(seen, light, rtol=0, atol=1e-12, err_msg=path.stem)
    assert (made == pixels).all(), path


def balls(count: int) -> Scene:
    row = (Sphere((x, 0, 0), 0.9, (255, 0, 0)) for x in range(count))
    return Scene((Ambient(0.2, (255, 255, 255)), Camera((0, 0, -9), (0, 0, 1), 70), Light((0, 9, 0), 1), *row))


def test_a_preview_has_the_proportions_of_the_window_and_is_not_larger() -> None:
    small = preview(balls(1), 30, 20)
    assert small is not None
    assert small.shape == (20, 30, 4)
    large = preview(balls(20), 1600, 900)
    assert large is not None
    height, width, _ = large.shape
    assert height < 450
    assert width / height == pytest.approx(16 / 9, rel=0.05)


@pytest.fixture
def calls(monkeypatch: pytest.MonkeyPatch) -> list[int]:
    """The number of rays in each call of the formula of a shape."""
    counts: list[int] = []

    def counted(shape: Any, origin: Vec, direction: Vec) -> Any:
        counts.append(np.size(direction.x))
        return intersect(shape, origin, direction)

    monkeypatch.setattr(trace, "intersect", counted)
    return counts


@pytest.mark.parametrize("count", [1, 30, 150])
def test_a_preview_uses_its_budget(count: int, calls: list[int]) -> None:
    """The work is counted in rays and in calls for a shape; the budget is in seconds that they are assumed to take."""
    made = preview(balls(count), 1920, 1080)
    assert made is not None
    height, width, _ = made.shape
    assert FEWEST <= width * height <= 1920 * 1080
    assert 0 < len(calls) <= 2 * count <= 300  # for the eye and for the light
    assert max(calls) <= width * height
    assert sum(calls) < 600_000
    work = 2 * count * (SHAPE + RAY * width * height)
    assert 0.7 * BUDGET < work <= 1.01 * BUDGET


def test_a_scene_that_exceeds_the_budget_has_no_preview(calls: list[int]) -> None:
    assert preview(balls(10_000), 1920, 1080) is None
    assert not calls


# The notice that nothing is in view, and the camera that it names, tested by rendering it.


WIDTH, HEIGHT = 96, 54
HEAD = "A 0.2 255,255,255\nC 0,0,0 0,0,-1 60\nL 5,9,5 0.7 255,255,255\n"
SUBJECT = load(SCENES / "subject-as-printed.rt").scene
AWAY = {
    "the subject's example": SUBJECT,
    "every kind": EVERY.replace(EVERY.camera, Camera((0, 1e4, -9), (0, 0.5, -1), 40)),
    "a tiny sphere": parse(f"{HEAD}sp 3,2,5 1e-7 255,0,0\n").scene,
    "a huge sphere": parse(f"{HEAD}sp 0,0,1e9 1e8 255,0,0\n").scene,
    "far from the origin": parse(f"{HEAD}sp 1e8,0,1e8 2 255,0,0\nsp 1e8,0,100000003 2 0,255,0\n").scene,
    "a plane alone": parse(f"{HEAD}pl 0,-3,0 0,1,0 200,90,90\n".replace("0,0,-1", "0,1,0")).scene,
    "a narrow view": parse(f"{HEAD}sp 0,0,9 1 255,0,0\ncy 3,0,9 0,1,0 1 1 0,255,0\n".replace("60", "0.5")).scene,
    "a toned picture": parse(f"{HEAD}sp 0,0,9 1 255,0,0\n".replace("60", "60 tone:srgb exposure:1 roll:20")).scene,
    "a mesh": parse(f"{HEAD}ob {SCENES}/meshes/icosahedron.obj 1,2,3 2 90,200,90\n", SCENES / "a.rt").scene,
}


def render(scene: Scene) -> np.ndarray:
    """Render a picture: (h, w, 3)."""
    pixels = np.zeros((HEIGHT, WIDTH, 4), np.uint8)
    assert TWO.render(scene, pixels)
    return pixels[..., 2::-1]


def shown_by(scene: Scene, notice: str) -> Scene:
    """The scene as the camera of a notice sees it."""
    assert re.match(
        r"(nothing is in view(: all is behind the eye)?|the eye is in plane \d+); this line would show the scene: C ",
        notice,
    )
    line = notice.partition("scene: ")[2]
    camera, notices = parse(f"A 0 0,0,0\n{line}\n")
    assert not notices
    return scene.replace(scene.camera, camera.camera)


@pytest.mark.parametrize("name", AWAY)
def test_the_camera_that_is_named_shows_the_scene(name: str) -> None:
    scene = AWAY[name]
    shown = shown_by(scene, notice_about(scene, render(scene)))
    picture = render(shown)
    assert not is_blank(picture)
    assert notice_about(shown, picture) == ""
    assert shown.camera.tone == scene.camera.tone
    y, x = np.mgrid[3:HEIGHT:8, 3:WIDTH:8].reshape(2, -1)
    seen = {id(pick(shown, WIDTH, HEIGHT, *at)[0]) for at in zip(x.tolist(), y.tolist(), strict=True)} - {id(None)}
    wanted = scene.shapes if len(scene.shapes) < 4 else scene.shapes[: len(scene.shapes) // 2]
    assert len(seen) >= len(wanted)


def test_pictures_that_show_something_have_no_notice() -> None:
    for scene in (EVERY, load(SCENES / "subject.rt").scene, load(SCENES / "sky.rt").scene):
        assert notice_about(scene, render(scene)) == ""


CAMERA = "C 0,0,0 0,0,1 60\n"
GREY = "A 0.5 255,255,255\n" + CAMERA
BLANK = {
    "A 0 255,255,255\nL 0,9,0 0 255,255,255\n"
    + CAMERA
    + "sp 0,0,9 2 255,0,0\n": "no light is on: all that is in view is black",
    "A 1 255,255,255\n"
    + CAMERA
    + "sp 0,0,9 2 0,0,0\n": "what is in view has one colour, or is smaller than a pixel: sphere 1",
    GREY: "the scene has no shapes",
    GREY + "sp 0,0,-9 2 255,0,0\nsp 9,0,0.5 2 255,0,0\nsp 1,0,1 9 0,255,0\n": "the eye is inside sphere 3",
    GREY + "cy 0,0,90 0,1,0 2 2 9,9,9\nbo 1,1,1 0,1,0 4,4,4 0,255,0\n": "the eye is inside box 1",
    GREY + "pl 0,0,5 1,0,0 0,255,0\nsp 0,0,-5 1 9,9,9\n": "the eye is in plane 1",
    GREY + "sp 0,0,-5 1 9,9,9\nsp 5,0,-3 5.9 9,9,9\n": "nothing is in view: all is behind the eye",
    GREY + "sp 0,0,-5 1 9,9,9\nsp 9,0,-2.5 6 9,9,9\n": "nothing is in view",
}


@pytest.mark.parametrize(("text", "reason"), BLANK.items(), ids=range(len(BLANK)))
def test_the_reason_is_told_why_a_picture_has_one_colour(text: str, reason: str) -> None:
    scene = parse(text).scene
    assert (
        notice_about(scene, module.render_interpreted(scene, WIDTH, HEIGHT)[0][..., 2::-1]).partition("; ")[0] == reason
    )


BALL = "sp 0,0,9 4 255,0,0"
HIDDEN = {
    "sp 0.5,0,9 1 0,255,0": True,
    "cy 0,0,9 0.6,0.8,0 1 1 9,9,9": True,
    "sp 0.5,0,9 2.9 0,255,0": False,  # the corners of its box are outside
    "sp 1.6,0,9 1 0,255,0": False,  # 0.1 of it is outside
    "sp 0,0,9 4 0,255,0": False,  # the same ball
    "pl 0,0,9 0,1,0 9,9,9": False,
    "bo 0,0,9 0,1,0 2.2,2.2,2.2 9,9,9": True,  # its corners are 1.91 from the middle
    "bo 0,0,9 0,1,0 2.4,2.4,2.4 9,9,9": False,  # 2.08
}


@pytest.mark.parametrize(("line", "is_hidden"), HIDDEN.items())
def test_a_shape_inside_an_opaque_one_is_told(line: str, is_hidden: bool) -> None:
    found = [*hidden_shapes(parse(f"{GREY}{BALL}\n{line}\n").scene)]
    title = {"sp": "sphere 2", "cy": "cylinder 1", "bo": "box 1", "pl": "plane 1"}[line[:2]]
    assert found == [f"{title} is never seen: it is inside sphere 1, which is opaque"] * is_hidden
    for visible in (f"{BALL} glass:1.5", "to 0,0,9 0,1,0 4 3.9 9,9,9", "sp 0,0,9 40 255,0,0"):  # the eye is in the last
        assert not [*hidden_shapes(parse(f"{GREY}{visible}\n{line}\n").scene)]


def test_a_size_without_effect_is_told() -> None:
    scene = parse(f"{GREY}L 0,9,0 1 255,255,255 size:1\n{BALL}\n").scene
    about = scene, np.arange(WIDTH * HEIGHT * 3, dtype=np.uint8).reshape(HEIGHT, WIDTH, 3), (WIDTH, HEIGHT), None
    (told,) = notices_about(*about, 1)
    assert told == "with one sample a pixel the size of a light or lens has no effect: try --samples auto"
    assert not [*notices_about(*about, 4)]


def test_a_notice_whose_numbers_leave_their_range_says_so(monkeypatch: pytest.MonkeyPatch) -> None:
    """A camera at a distance of 2.6e15."""
    far = parse("A 0 0,0,0\nC 0,0,0 0,0,1 60\nsp -1e15,0,-9e14 1e15 9,9,9\n").scene
    about = far, render(far), (WIDTH, HEIGHT)
    assert list(notices_about(*about)) == ["nothing is in view: all is behind the eye"]
    monkeypatch.setattr(module, "FARTHEST", 1e16)
    (told,) = notices_about(*about)
    assert told.startswith(f"{NOT_COMPUTED}: camera position ")


def test_a_scene_of_many_shapes_is_left_alone(monkeypatch: pytest.MonkeyPatch) -> None:
    blank = np.zeros((9, 16, 3), np.uint8)
    monkeypatch.setattr(module, "MOST_PRIMITIVES", 2)
    assert notice_about(SUBJECT, blank) == ""


def test_dithering_of_an_even_picture_is_still_blank() -> None:
    picture = np.full((70, 70, 3), 100, np.uint8)
    picture[::3, 1::2] += 1
    assert is_blank(picture)
    picture[65, 3, 1] = 103
    assert not is_blank(picture)
