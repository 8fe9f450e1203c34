"""Building by hand: a snowman from an empty scene, the list of elements, typed values, and hints."""

from __future__ import annotations

import re
from itertools import pairwise
from math import dist, hypot
from pathlib import Path

import pytest
from PIL import Image as pillow  # noqa: N813

from minirt.cli import main
from minirt.scene import Scene, load
from minirt.shapes import Cylinder, Sphere
from minirt.viewer.app.session import Session
from minirt.viewer.display.overlay import fitting_words, hints
from tests.pages import read
from tests.paths import ROOT
from tests.viewer.fake import TEXT, played, scene

BLANK = "A 0.2 255,255,255\nC 0,2,9 0,-0.2,-1 60\n"
SPHERE = ("press Tab", "press Tab")  # from the camera over the light
KEYS, USES = 59, 39  # presses of keys, and uses of the pointer with one word typed, in which a snowman is built
PAGE = read("minirt/viewer/README.md")


def title(session: Session) -> str:
    """The title of the panel, or nothing."""
    return session.screen.list_box.title if session.screen.list_box else ""


def built_by(recording: str, start: str, path: Path) -> Scene:
    """Build a scene from the text of a file by a recording, as the page says; the film has as many pictures as its."""
    scene_file, film = path / "snowman.rt", path / "snowman.gif"
    scene_file.write_text(start)
    (command,) = re.findall(r"^miniRT snowman\.rt --replay (\S+) (.*) -o assets/snowman\.gif$", PAGE, re.MULTILINE)
    arguments = str(ROOT / f"assets/{recording}.txt"), *command[1].split()
    assert main([str(scene_file), "--replay", *arguments, "-o", str(film)]) == 0
    with pillow.open(ROOT / "assets/snowman.gif") as kept, pillow.open(film) as made:
        assert kept.size == made.size
        assert recording not in command[0] or abs(kept.n_frames - made.n_frames) <= 3
    return load(scene_file).scene


def words_of(recording: str) -> list[list[str]]:
    """The words of the commands of a recording."""
    lines = (line.split("#")[0].split() for line in (ROOT / f"assets/{recording}.txt").read_text().splitlines())
    return [words for words in lines if words]


def assert_snowman(built: Scene, within: float = 1e-3) -> None:
    """White balls rest on each other and on the ground, a hat on them; black eyes and a nose stick out of the head."""
    balls = sorted((each for each in built.spheres if each.diameter >= 1), key=lambda ball: ball.centre[1])
    head = balls[-1]
    assert len(balls) > 2
    assert all(min(each.colour) >= 200 for each in balls)
    assert balls[0].centre[1] == pytest.approx(balls[0].diameter / 2)
    for lower, upper in pairwise(balls):
        assert dist(lower.centre, upper.centre) == pytest.approx((lower.diameter + upper.diameter) / 2, abs=within)
    top = head.centre[1] + head.diameter / 2
    assert built.cylinders
    for part in sorted(built.cylinders, key=lambda part: part.centre[1]):
        assert part.centre == pytest.approx((head.centre[0], top + part.height / 2, head.centre[2]), abs=within)
        top += part.height
    eyes = [each for each in built.spheres if each.diameter < 1]
    assert [each.colour for each in eyes] == [(0, 0, 0)] * 2
    assert all(abs(dist(each.centre, head.centre) - head.diameter / 2) < 0.15 for each in eyes)
    (nose,) = built.cones
    outward = [a - b for a, b in zip(nose.apex, head.centre, strict=True)]
    assert nose.axis == pytest.approx([-part / hypot(*outward) for part in outward], abs=0.05)
    assert hypot(*outward) == pytest.approx(head.diameter / 2 + nose.height, abs=10 * within)


def test_a_snowman_is_built_with_the_pointer_alone(tmp_path: Path) -> None:
    """Lists need a few letters."""
    words = words_of("snowman-pointer")
    uses = sum(each[0] in ("click", "drag", "wheel") for each in words)
    assert uses + any(each[0] == "press" for each in words) == USES
    assert {each[1] for each in words if each[0] == "press"} == {*"orange"[:4], "Return"}
    assert_snowman(built_by("snowman-pointer", "", tmp_path))


def test_a_snowman_is_built_from_nothing_in_few_presses(tmp_path: Path) -> None:
    words = words_of("snowman-keyboard")
    assert {each[0] for each in words} <= {"wait", "press", "text", "hold", "down", "up"}
    assert sum(each[0] in ("press", "text", "hold", "down") for each in words) <= KEYS
    assert all(len(each[1]) == 1 for each in words if each[0] == "text")
    built = built_by("snowman-keyboard", (ROOT / "assets/blank.rt").read_text(), tmp_path)
    assert (len(built.planes), len(built.lights), len(built.cylinders)) == (1, 1, 2)
    assert_snowman(built)


def test_the_first_shape_brings_a_lamp_which_is_undone_with_it() -> None:
    session = played("move 32,30", "press N", text=BLANK)
    assert len(session.state.scene.lights) == 1
    assert "light" in session.state.message
    assert isinstance(session.state.element, Sphere)
    assert played("press N", "press Return", "press Ctrl+Z", text=BLANK).state.scene.items == scene(BLANK).items
    assert len(played("press N", text=TEXT).state.scene.lights) == 1
    assert not played("press N", "press b", "press a", "press c", text=BLANK).state.scene.lights


@pytest.mark.parametrize(
    ("keys", "kind"),
    [
        (["press c", "press y"], "cylinder"),
        (["press l", "press i", "press n", "press d"], "cylinder"),
        (["press Down", "press Down"], "cylinder"),
        (["press c", "press Down"], "cone"),
        (["press c", "press Down", "press Up"], "cylinder"),
        (["press c", "press o", "press Backspace"], "cylinder"),
        (["press N", "press N", "press N"], "cone"),
        (["press Shift+N"], "sphere"),
        (["press s", "press p", "press o", "press t"], "spot light"),
        (["press q", "press q"], "square"),  # nothing is called qq
    ],
)
def test_letters_and_arrows_choose_from_the_list(keys: list[str], kind: str) -> None:
    open_list = ["press N", "press N"] if keys == ["press Shift+N"] else ["press N"]
    chosen = played(*open_list, *keys)
    assert chosen.state.element.title == kind
    assert len(chosen.state.scene.elements) == len(scene().elements) + 1
    assert len(chosen.state.undo_stack) == 1
    assert title(chosen).startswith("element: ")
    for end, count in (
        ("press Return", 1),
        ("press Escape", 0),
        ("press Ctrl+Z", 0),
        ("press Tab", 1),
        ("click 1,1", 1),
    ):
        ended = played(*open_list, *keys, end)
        assert len(ended.state.scene.elements) == len(scene().elements) + count
        assert title(ended) == ""
        assert ended.state.aim is None or count


@pytest.mark.parametrize("key", ["press Left", "press +", "press Tab", "press Ctrl+Z"])
def test_after_an_edit_another_element_of_the_same_kind_is_added(key: str) -> None:
    before = played("press N", "press N", "press N")
    after = played("press N", "press N", "press N", key, "press N")
    assert type(after.state.element) is type(before.state.element)
    assert len(after.state.scene.elements) == len(before.state.scene.elements) + (key != "press Ctrl+Z")


def test_an_element_without_attributes_has_no_list_of_them() -> None:
    ambient = played("press Shift+Tab", "press M")
    assert "no attribute that can be added" in ambient.state.message
    assert title(ambient) == ""


@pytest.mark.parametrize(
    ("typed", "expected"),
    [
        ("3.5", 3.5),
        ("=*=2", 4.0),
        ("=/=4", 0.5),
        ("=+=0.5", 2.5),
        ("=-=0.5", 1.5),
        ("=7", 7.0),
        ("=+7", 7.0),
        ("5--3", 8.0),
        ("2*3+1", 7.0),
        ("=(1+2)/4", 0.75),
        ("2,5", 2.5),
        ("=*=2+1", 6.0),
        ("=1-0.5", 0.5),
        ("1-0.5", 0.5),
        ("2*(", "must be a number"),
        ("1/0", "divided by 0"),
        ("0", "must be > 0"),
        ("=-3", "must be > 0"),
        ("3-", "must be a number"),
        ("=*2", "must be a number"),
        ("=*=", "must be a number"),
        ("1.2.3", "must be a number"),
        ("=/=0", "divided by 0"),
        ("1,2,3,4", "takes one number"),
    ],
)
def test_a_typed_number_sets_the_active_value(typed: str, expected: float | str) -> None:
    state = played(*SPHERE, *(f"text {character}" for character in typed), "press Return").state
    if isinstance(expected, str):
        assert expected in state.message
        assert state.scene.items == scene().items
    else:
        assert state.scene.spheres[0].diameter == expected
        assert len(state.undo_stack) == 1


def test_colours_are_typed_as_grey_as_three_numbers_and_by_channel() -> None:
    def colour(*lines: str) -> tuple[int, int, int]:
        colour: tuple[int, int, int] = played(*SPHERE, "press V", *lines, "press Return").state.scene.spheres[0].colour
        return colour

    assert colour("text 80") == (80, 80, 80)
    assert colour("text 1,22,133") == (1, 22, 133)
    assert colour("text =*=0.5") == (128, 0, 0)
    assert colour("press V", "press V", "text 9") == (255, 9, 0)
    assert colour("text 256") == (255, 0, 0)


def test_what_is_typed_is_shown_corrected_and_left() -> None:
    assert "diameter, now 2: 3.5_" in title(played(*SPHERE, "text 3.5"))
    assert played(*SPHERE, "text 3.55", "press Backspace", "press Return").state.scene.spheres[0].diameter == 3.5
    for leave in ("press Escape", "press V", "press Backspace", "wheel up"):
        left = played(*SPHERE, "text 3", leave, "press Return")
        assert left.state.scene.spheres[0].diameter == 2
        assert title(left) == ""
    assert played("text 7", "press Return", "press d").state.scene.camera.fov == 7


def test_tab_sets_what_is_typed_and_begins_the_next_value() -> None:
    """The values of a sphere as the line on top has them: diameter, centre, colour."""
    typed = played(*SPHERE, "text 3", "press Tab", "text 1", "text ,", "text 2", "text ,", "text 4", "press Tab")
    sphere = typed.state.scene.spheres[0]
    assert (sphere.diameter, sphere.centre, sphere.colour) == (3, (1, 2, 4), (255, 0, 0))
    assert title(typed).startswith("colour, now 255 0 0")
    assert title(played(*SPHERE, "text =", "press Tab")).startswith("centre: x, now 0: _")
    parts = played(*SPHERE, "text =", "press Tab", "text 5", "press Tab", "text 6", "press Tab")
    assert parts.state.scene.spheres[0].centre == (5, 6, 0)
    assert title(parts).startswith("centre: z, now 0: _")
    wood = "A 0.2 255,255,255\nC 0,2,9 0,-0.1,-1 60\nL 5,5,5 0.6\nsp 0,0,0 2 255,0,0 wood:0.3\n"
    walk = [title(played("press Tab", "press Tab", "text =", *["press Tab"] * count, text=wood)) for count in range(4)]
    assert [each.partition(",")[0] for each in walk] == ["diameter", "wood size", "centre: x", "centre: y"]
    back = "down Shift", "press Tab", "up Shift", "text 9", "press Return"
    assert played(*SPHERE, "text 3", "press Tab", *back).state.scene.spheres[0].diameter == 9
    refused = played(*SPHERE, "text 0", "press Tab")
    assert (refused.state.scene.spheres[0].diameter, title(refused)) == (2, "")
    assert "diameter" in refused.state.message


def test_a_minus_after_equals_begins_a_negative_number() -> None:
    """The second coordinate of a sphere at a height of 3: the same keys once took 3 from it."""
    y = ["press V"] * 6
    for typed, height in (("=-3", -3), ("=-=3", 0), ("=+=0.5", 3.5), ("3-1", 2), ("=-0.9", -0.9)):
        state = played(*SPHERE, *y, f"text {typed}", "press Return", text=TEXT.replace("sp 0,0,0", "sp 0,3,0")).state
        assert state.active.name == "centre: y"
        assert state.element.centre == (0, height, 0)
    assert "diameter, now 2: -3_" in title(played(*SPHERE, "text =-3"))
    assert "+= -= *= /=" in title(played(*SPHERE, "text ="))
    assert played(*SPHERE, "text -").state.element.diameter < 2  # the key by itself is that of a step


def test_the_line_of_information_says_what_keys_do() -> None:
    state = played(*SPHERE, "text 3.8", "press Return").state
    assert "+ - diameter" in hints(state, every=False)
    assert fitting_words(state, 200, 16) == "red sphere, diameter [3.8]"
    assert "X axis" in hints(played(*SPHERE, "press X").state, every=False)
    brim = played("press N", "press c", "press y", "press Return", "press V", "text 0.25", "press Return").state
    assert isinstance(brim.element, Cylinder)
    assert "+ - height" in hints(brim, every=True)
    assert "height [0.25]" in fitting_words(brim, 600, 16)


def test_letters_in_place_of_a_colours_numbers_choose_its_word() -> None:
    """While the colour is typed; w and b alone are keys that move."""
    keys = [*SPHERE, "text 2", "press Tab", "text 0", "text ,", "text 1", "text ,", "text 0", "press Tab"]
    assert title(played(*keys)).endswith("or all three: red green blue    or its word")
    ball = played(*keys, *(f"press {letter}" for letter in "WHITE"), "press Return").state.scene.spheres[0]
    assert (ball.colour, ball.centre) == ((255, 255, 255), (0, 1, 0))
    assert "its word" not in title(played(*SPHERE, "text ="))
