"""Notices about what is not seen, with a camera that shows it, and about what has no effect; and no other notices."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest

from minirt.materials import Checker
from minirt.rendering.notices import NOT_COMPUTED, notices_about
from minirt.rendering.queries import no_effect, preview
from minirt.rendering.queries import unseen as module
from minirt.rendering.queries.no_effect import AMBIENT_ALONE, idle_lights, is_one_square, without_effect
from minirt.rendering.queries.pick import pick
from minirt.rendering.queries.preview import render_interpreted
from minirt.rendering.queries.unseen import is_blank, notice_about
from minirt.scene import Camera, Scene, load, parse
from tests.kernel.pictures import EVERY, TWO
from tests.paths import SCENES

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
    shown = shown_by(scene, notice_about(scene, (WIDTH, HEIGHT), render(scene)))
    picture = render(shown)
    assert not is_blank(picture)
    assert notice_about(shown, (WIDTH, HEIGHT), picture) == ""
    assert shown.camera.tone == scene.camera.tone
    y, x = np.mgrid[3:HEIGHT:8, 3:WIDTH:8].reshape(2, -1)
    seen = {id(pick(shown, WIDTH, HEIGHT, *at)[0]) for at in zip(x.tolist(), y.tolist(), strict=True)} - {id(None)}
    wanted = scene.shapes if len(scene.shapes) < 4 else scene.shapes[: len(scene.shapes) // 2]
    assert len(seen) >= len(wanted)


def test_pictures_that_show_something_have_no_notice() -> None:
    for scene in (EVERY, load(SCENES / "subject.rt").scene, load(SCENES / "sky.rt").scene):
        assert notice_about(scene, (WIDTH, HEIGHT), render(scene)) == ""


CAMERA = "C 0,0,0 0,0,1 60\n"
GREY = "A 0.5 255,255,255\n" + CAMERA
NO_OUTSIDE = ": nothing outside of it is seen"
BLANK = {
    "A 0 255,255,255\nL 0,9,0 0 255,255,255\n"
    + CAMERA
    + "sp 0,0,9 2 255,0,0\n": "no light is on: all that is in view is black",
    "A 1 255,255,255\n"
    + CAMERA
    + "sp 0,0,9 2 0,0,0\n": "what is in view has one colour, or is smaller than a pixel: sphere 1",
    GREY: "the scene has no shapes",
    GREY + "sp 0,0,-9 2 255,0,0\nsp 9,0,0.5 2 255,0,0\nsp 1,0,1 9 0,255,0\n": "the eye is inside sphere 3" + NO_OUTSIDE,
    GREY + "cy 0,0,90 0,1,0 2 2 9,9,9\nbo 1,1,1 0,1,0 4,4,4 0,255,0\n": "the eye is inside box 1" + NO_OUTSIDE,
    GREY + "bo 1,1,1 0,1,0 4,4,4 0,255,0\n": "the eye is inside box 1",
    GREY + "pl 0,0,5 1,0,0 0,255,0\nsp 0,0,-5 1 9,9,9\n": "the eye is in plane 1",
    GREY + "sp 0,0,-5 1 9,9,9\nsp 5,0,-3 5.9 9,9,9\n": "nothing is in view: all is behind the eye",
    GREY + "sp 0,0,-5 1 9,9,9\nsp 9,0,-2.5 6 9,9,9\n": "nothing is in view",
}


@pytest.mark.parametrize(("text", "reason"), BLANK.items(), ids=range(len(BLANK)))
def test_the_reason_is_told_why_a_picture_has_one_colour(text: str, reason: str) -> None:
    scene = parse(text).scene
    picture = render_interpreted(scene, WIDTH, HEIGHT)[0][..., 2::-1]
    assert notice_about(scene, (WIDTH, HEIGHT), picture).partition("; ")[0] == reason


FLOOR = "L 0,9,0 1\npl 0,-1,0 0,1,0 180,180,195\n"
BALL = "sp 0,0,9 4 255,0,0"
ROOM = "bo 0,0,9 0,1,0 30,30,30 9,99,9\n"
SMALL = FLOOR + "sp 0.31,-0.17,9 0.12 240,240,255\n"  # between the rays that look for shapes, a pixel wide
SHOWN = {  # why nothing of the scene is seen in a picture of several colours
    FLOOR + "sp 0,2,-3 4 240,240,255\nsp -4,1.2,-9 2.4 255,50,50\n": "none of the 2 shapes but the plane is in view",
    FLOOR + "pl 0,9,0 0,1,0 9,9,9\nsp 0,2,-3 4 240,240,255\n": "no shape but the planes is in view",
    FLOOR + "sp 0,-9,9 4 240,240,255\nsp 0,-5,9 2 9,9,9\n": "none of the 2 shapes but the plane is in view",
    FLOOR + "bo 0.4,0.3,0 0.1,1,0 2,2,2 99,0,0 checker:0.2\n" + BALL: "the eye is inside box 1" + NO_OUTSIDE,
    FLOOR + ROOM + BALL: "",
    FLOOR + "sp 0.01,0,0 1 99,0,0 glass:1.5\n" + BALL: "",
    SMALL: "",
    FLOOR + "cy 0,0,9 1,1,0 0.1 16 9,9,9\n": "",
    FLOOR.replace("1\n", "0\n", 1).replace("pl", "bg 9,9,99\npl") + BALL: "",
}


@pytest.mark.parametrize(("text", "reason"), SHOWN.items(), ids=range(len(SHOWN)))
def test_a_picture_of_planes_alone_names_what_is_out_of_view(text: str, reason: str) -> None:
    scene = parse(f"{GREY}{text}\n").scene
    picture = render(scene)
    assert not is_blank(picture)
    told, _, line = notice_about(scene, (WIDTH, HEIGHT), picture).partition("; this line would show the scene: ")
    assert told == reason
    assert notice_about(scene, (WIDTH, HEIGHT)).partition("; ")[0] == reason  # before it is rendered
    if line:
        shown = scene.replace(scene.camera, parse(f"A 0 0,0,0\n{line}\n").scene.camera)
        assert notice_about(shown, (WIDTH, HEIGHT), render(shown)) == ""


def test_rays_aimed_at_shapes_find_one_between_other_rays(monkeypatch: pytest.MonkeyPatch) -> None:
    scene = parse(GREY + SMALL).scene
    monkeypatch.setattr(module, "aimed_shapes", lambda *_: np.zeros(0, int))  # without them the search is wrong
    assert notice_about(scene, (WIDTH, HEIGHT)).startswith("no shape but the plane is in view, behind")


def test_without_light_what_is_in_view_is_black_but_mirrors_of_a_background() -> None:
    dark = "A 0 255,255,255\nC 0,0,0 0,0,1 60\nbg 90,90,99\nL 9,9,9 0\n"
    size = WIDTH, HEIGHT
    black = parse(f"{dark}{BALL}\n").scene
    told = "no light is on: all that is in view is black, but for the background"
    assert notice_about(black, size, render(black)) == notice_about(black, size) == told
    for lit in (f"{dark}{BALL} mirror:0.5\n", f"{dark}{BALL} glow:1\n", f"{dark}dl 0,-1,0 1\n{BALL}\n"):
        assert notice_about(parse(lit).scene, size) == ""


READINGS = {"0,0,-1": "reversed", "0,0.9,0": "angles", "0,160,0": "angles", "0,3.3,0": "angles", "0,1,0": "angles"}


@pytest.mark.parametrize(("direction", "way"), READINGS.items())
def test_another_reading_of_the_camera_is_named_where_it_shows_shapes(tmp_path: Path, direction: str, way: str) -> None:
    """The balls are ahead for the reversed direction, and else where angles about y of about 180 degrees lead."""
    file = tmp_path / "a.rt"
    z = 9 if way == "reversed" else -9
    balls = f"sp 0,0,{z} 4 255,0,0\nsp 3,0,{z} 1 9,9,9\n"
    file.write_text(GREY.replace("0,0,1", direction) + FLOOR + balls)
    scene = load(file, True).scene
    told = notice_about(scene, (WIDTH, HEIGHT), render(scene)).split("; ")
    reason = "none of the 2 shapes but the plane is in view" if way == "reversed" else "nothing is in view"
    assert told[0] == reason
    assert f"--camera-as {way} shows 2 of 2" in told
    assert notice_about(load(file, way).scene, (WIDTH, HEIGHT)) == ""
    file.unlink()
    assert len(notice_about(scene, (WIDTH, HEIGHT), render(scene)).split("; ")) == 2


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
    turned = "C 0,0,0 -0.7433,0,-0.669 60"
    assert list(notices_about(*about)) == [
        f"nothing is in view: all is behind the eye; this line would show the scene: {turned}"
    ]
    monkeypatch.setattr(module, "FARTHEST", 1e16)
    (told,) = notices_about(*about)
    assert told.startswith(f"{NOT_COMPUTED}: camera position ")


def test_a_scene_of_many_shapes_is_left_alone(monkeypatch: pytest.MonkeyPatch) -> None:
    blank = np.zeros((9, 16, 3), np.uint8)
    monkeypatch.setattr(module, "MOST_PRIMITIVES", 2)
    assert notice_about(SUBJECT, (16, 9), blank) == ""


def test_dithering_of_an_even_picture_is_still_blank() -> None:
    picture = np.full((70, 70, 3), 100, np.uint8)
    picture[::3, 1::2] += 1
    assert is_blank(picture)
    picture[65, 3, 1] = 103
    assert not is_blank(picture)


HIDDEN = {
    "sp 0.5,0,9 1 0,255,0": True,
    "cy 0,0,9 0.6,0.8,0 1 1 9,9,9": True,
    "sp 0.5,0,9 2.9 0,255,0": False,  # the corners of its box are outside
    "sp 1.6,0,9 1 0,255,0": False,  # 0.1 of it is outside
    "sp 0,0,9 4 0,255,0": False,  # the same ball
    "pl 0,0,9 0,1,0 9,9,9": False,
    "bo 0,0,9 0,1,0 2.2,2.2,2.2 9,9,9": True,  # its corners are 1.91 from the middle
    "bo 0,0,9 0,1,0 2.4,2.4,2.4 9,9,9": False,  # 2.08
    "L 0,1.9,9 1": True,
    "L 0,1.9,9 1 size:0.1": True,
    "sl 0,0,9 0,1,0 60 1 255,255,255 size:3": False,  # the corners of its box are outside
    "L 0,2.1,9 1": False,
    "dl 0,-1,0 1": False,
}


IDLE = "nothing that is in view seems to be lit by "
LAMPS = {  # a ball on a floor, and what lights it or does not
    "L 4,9,0 1": "",
    "L 4,-9,0 1": "light 1",  # below the floor
    "L 4,9,20 1 255,255,255 reach:9": "light 1",
    "L 4,9,0 0": "",  # it is switched off
    "L 4,9,0 1\nl 0,0.5,12 1\ndl 0,1,0 1": "parallel light 1",
    "dl 0,-1,0 1\npl 0,9,0 0,-1,0 9,9,9": "parallel light 1",
    "sl 4,9,0 0,1,0 30 1": "spot light 1",
    "sl 4,9,0 -0.4,-0.9,0.9 30 1": "",
    "L 4,-9,0 1\nsp 0,0,5 1 9,9,9 mirror:0.5": "",  # which may show what it lights
    "L 0,0,9 1": "",  # inside of the ball, which is told
}


@pytest.mark.parametrize(("lines", "names"), LAMPS.items())
def test_lights_that_light_nothing_in_view_are_named(lines: str, names: str) -> None:
    scene = parse(f"{GREY}{BALL}\npl 0,-2,0 0,1,0 200,200,200\n{lines}\n").scene
    found = [each for each in without_effect(scene, (640, 360)) if each.startswith(IDLE)]
    assert found == ([IDLE + names] if names else [])
    assert (AMBIENT_ALONE in without_effect(scene, (640, 360))) == (lines == "L 4,9,0 0")
    away = scene.replace(scene.camera, scene.camera.replace(position=(0, 9, 0), direction=(0, 1, 0)))
    assert not [each for each in without_effect(away, (640, 360)) if each.startswith(IDLE)]  # nothing is in view


def test_the_quick_look_at_solids_spares_pictures_and_changes_no_answer(monkeypatch: pytest.MonkeyPatch) -> None:
    names = "demo", "subject", "eval-inside-light", "shapes", "eval-shadow"
    scenes = [load(SCENES / f"{name}.rt").scene for name in names]
    scenes += [parse(f"{GREY}{BALL}\npl 0,-2,0 0,1,0 9,9,9\n{lines}\n").scene for lines in LAMPS]
    answers = [[*idle_lights(each)] for each in scenes]
    drawn: list[Scene] = []
    monkeypatch.setattr(preview, "render_interpreted", lambda *_: drawn.append(scenes[0]))
    assert not [*idle_lights(scenes[0])]
    assert not drawn
    monkeypatch.undo()
    monkeypatch.setattr(no_effect, "lights_a_solid", lambda *_: False)
    assert [[*idle_lights(each)] for each in scenes] == answers


def told(text: str) -> list[str]:
    """The sentences about a scene but those about lights, which have a test of their own."""
    sentences = without_effect(parse(f"{GREY}{text}\n").scene, (640, 360))
    return [each for each in sentences if not each.startswith((IDLE, AMBIENT_ALONE))]


@pytest.mark.parametrize(("line", "is_hidden"), HIDDEN.items())
def test_a_shape_or_lamp_inside_an_opaque_shape_is_told(line: str, is_hidden: bool) -> None:
    titles = {"sp": "sphere 2", "cy": "cylinder 1", "bo": "box 1", "pl": "plane 1"}
    name = titles.get(line[:2])
    what = f"{name} is never seen" if name else "light 1 lights nothing"
    assert told(f"{BALL}\n{line}") == [f"{what}: it is inside sphere 1, which is opaque"] * is_hidden
    for visible in (
        f"{BALL} glass:1.5,0.9",
        "to 0,0,9 0,1,0 4 3.9 9,9,9",
        "sp 0,0,9 40 255,0,0",
    ):  # the eye is in the last
        assert not told(f"{visible}\n{line}")


def test_a_lamp_without_a_size_is_told_in_every_closed_shape() -> None:
    for shape in ("hy 0,0,9 0,1,0 1 2 2 9,9,9", "pa 0,-1,9 0,1,0 2 2 9,9,9", "to 1,0,9 0,1,0 2 1 9,9,9"):
        (sentence,) = told(f"{shape}\nL 0,0,9 1")
        assert sentence.startswith("light 1 lights nothing: it is inside ")
        assert told(f"{shape}\nL 0,0,9 1 size:0.01") == ([sentence] if shape.startswith("pa") else [])


LOST = {
    "sp 0,0,400 0.6 9,9,9": "smaller than a pixel: sphere 1",  # of 0.83 pixels; a pixel has a width of 0.72 there
    "sp 0,0,400 0.9 9,9,9": "",
    "sp 0,0,-400 0.6 9,9,9": "",
    f"{BALL} checker:1": "the checker: of sphere 1 is not seen: a square with sides of 1 covers the shape, try 0.125",
    f"{BALL} checker:0.99": "",
    f"{BALL} checker:1 uv:2,1": "",
    "pl 0,-1,0 0,1,0 9,9,9 checker:1": "",
    f"{BALL} glass:1.5": "the colour of sphere 1 is not seen: it is of clear glass, which tint:R,G,B colours",
    f"{BALL} glass:1.5,0.9": "",
    f"{BALL} glass:1.5 tint:255,0,0": "",
    "sp 0,0,9 4 200,200,200 glass:1.5": "",  # clear glass is grey
    "pl 0,-1,0 0,1,0 10,40,60 glass:1.33": "",  # the surface of water
}


@pytest.mark.parametrize(("line", "sentence"), LOST.items())
def test_a_look_that_is_not_seen_is_told(line: str, sentence: str) -> None:
    assert told(line) == [sentence] * bool(sentence)


def picture(size: float) -> np.ndarray:
    """Picture of every kind of shape that u and v cover from 0 to 1, with checkerboards of a size."""
    scene = EVERY
    for shape in EVERY.shapes:
        checked = shape.replace(checker=Checker(size, (1, 2, 3)), uv=None)
        scene = scene.replace(shape, checked) if is_one_square(checked.replace(checker=Checker(1))) else scene
    return render_interpreted(scene, 96, 54)[0]


def test_a_square_with_sides_of_1_covers_every_kind_of_shape_and_a_smaller_one_does_not() -> None:
    assert (picture(1.0) == picture(7.0)).all()
    assert (picture(1.0) != picture(0.9)).any()
