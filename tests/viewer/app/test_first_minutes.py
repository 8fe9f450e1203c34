"""What people try in their first minutes: colours by words, three numbers at once, several elements, a look at all."""

from __future__ import annotations

from math import hypot
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

from minirt.fields import Triple
from minirt.mlx.text import measure
from minirt.scene import Scene, dump
from minirt.shapes import Sphere
from minirt.viewer.app.session import Session
from minirt.viewer.display.lists import MARGIN
from minirt.viewer.display.marks import arrow_tip, arrows
from minirt.viewer.display.overlay import HudLevel
from minirt.viewer.display.screen import darken_beyond
from minirt.viewer.display.words import next_in_line, title_in_words, values_in_words
from minirt.viewer.editing.colours import COLOURS, colour_word
from minirt.viewer.editing.handles import MOVE, handles_of
from minirt.viewer.editing.projection import projection_of
from minirt.viewer.editing.state import State, initial_state
from minirt.viewer.editing.typed import set_typed
from minirt.viewer.editing.values import values
from minirt.viewer.language import GAP
from tests.viewer.app.test_lists import AT_SPHERE, clicked, play, right_click, rows
from tests.viewer.fake import TEXT, played, scene
from tests.viewer.session_harness import SessionHarness

PAIR = "A 0.2 255,255,255\nC 0,2,9 0,-0.1,-1 60\nL 5,5,5 0.6\nsp -2,1,0 2 255,0,0\ncy 2,1,0 0,1,0 1 2 0,0,255\n"
LAMP_OUTSIDE = "A 0.2 255,255,255\nC 0,2,9 0,-0.1,-1 60\nL 0,5,0 0.6\nsp 0,1,0 2 255,0,0\npl 0,0,0 0,1,0 9,99,9\n"


def both(text: str = PAIR) -> State:
    """The state in which sphere and cylinder are selected, the sphere as the primary one."""
    state = initial_state(scene(text))
    return state.select(4).add_or_remove(3)


def typed(state: State, name: str, text: str) -> State:
    """The state after a text was typed for a value of the primary element."""
    (value,) = (each for each in values(state.element) if each.name == name)
    return set_typed(state, value, text, 0.0)


# Colours.


@pytest.mark.parametrize("word", COLOURS)
def test_each_colour_of_the_list_has_its_own_word(word: str) -> None:
    assert colour_word(COLOURS[word]) == word


@pytest.mark.parametrize(
    ("colour", "word"),
    [((125, 150, 110), "light green"), ((128, 128, 128), "grey"), ((255, 250, 240), "white"), ((60, 0, 0), "dark red")],
)
def test_a_pale_colour_is_not_called_grey(colour: Triple, word: str) -> None:
    assert colour_word(colour) == word


def test_a_list_of_words_colours_all_that_is_selected_as_one_step() -> None:
    assert "colour >" in rows(play(right_click(AT_SPHERE)))
    opened = (right_click(AT_SPHERE), "press U", "press w", "press h")
    listed = play(*opened)
    assert rows(listed) == ("white",)
    assert listed.state.element.colour == (255, 255, 255)
    assert play(*opened, "press Escape").state.scene.items == scene().items
    taken = clicked(*opened, row="white").state
    assert len(taken.undo_stack) == 1
    kept = play(right_click(AT_SPHERE), "press U", "press Return").state  # the first row: as it is
    assert (kept.scene.items, kept.undo_stack) == (scene().items, ())
    two = played("press Tab", "press Tab", "press Shift+Tab", "press U").state
    assert two.message or two.element  # a light has a colour, too
    no_colour = played("press U").state  # of the camera
    assert no_colour.message == "camera has no colour"


# Typed values.


@pytest.mark.parametrize("text", ["1 2 3", "1,2,3", "1, 2, 3", "=1 2 3", " 1  2 3 "])
def test_three_numbers_are_typed_at_once_with_blanks_or_commas(text: str) -> None:
    assert typed(initial_state(scene()).select(3), "centre: y", text).element.centre == (1, 2, 3)


@pytest.mark.parametrize(("text", "number"), [("1 + 2", 3), ("2 *3 +1", 7)])
def test_a_sum_with_blanks_is_one_number(text: str, number: float) -> None:
    sphere = initial_state(scene()).select(3)
    assert typed(sphere, "centre: y", text).element.centre == (0, number, 0)
    assert typed(sphere, "diameter", text).element.diameter == number


@pytest.mark.parametrize("key", ["U", "Shift+U"])
@pytest.mark.parametrize("steps", range(8))
def test_each_of_two_colours_has_a_list_whatever_value_is_active(key: str, steps: int) -> None:
    text = PAIR.replace("255,0,0", "255,0,0 checker:0.5,9,9,9")
    shift = ["down Shift", "press U", "up Shift"]
    keys = [*["press V"] * steps, *(shift if "+" in key else [*shift, "press Escape", "press U"])]
    session = played("press Tab", "press Tab", *keys, *(f"press {each}" for each in "WHITE"), "press Return", text=text)
    ball = session.state.scene.spheres[0]
    assert (ball.colour, ball.checker.colour) == ((255, 0, 0), (255,) * 3) if "+" in key else ((255,) * 3, (9, 9, 9))


def test_three_numbers_are_the_position_where_one_number_is_active() -> None:
    session = played("resize 640x480", "press Tab", *(f"text {each}" for each in "8,4,-3"), "press Return", text=PAIR)
    assert session.state.scene.lights[0].position == (8.0, 4.0, -3.0)
    assert session.state.scene.lights[0].brightness == 0.6


@pytest.mark.parametrize(("beside", "value"), [((0, -4), "diameter"), ((0, 4), "x"), ((1, -4), "z"), ((1, 4), "z")])
def test_a_click_on_a_number_of_the_line_on_top_begins_to_type_it(beside: tuple[int, int], value: str) -> None:
    """`beside`: columns from the start (0) or the end (1) of the words of the centre; a comma ends a value."""
    lines = "resize 1280x720", "press Tab", "press Tab"
    session = played(*lines, text=PAIR)
    shown = [title_in_words(session.state.element), *values_in_words(session.state)]
    index = next(at for at, value in enumerate(shown) if value.startswith("centre"))
    ends = ", ".join(shown[:index]) + ", ", ", ".join(shown[: index + 1])
    column = MARGIN + measure(ends[beside[0]], session.screen.text_size)[0] + beside[1]
    session = played(*lines, f"click {column},{MARGIN + 5}", "text 7", "press Return", text=PAIR)
    sphere = next(each for each in session.state.scene.shapes if isinstance(each, Sphere))
    assert session.state.element is sphere
    changed = {"diameter": (7, (-2, 3.5, 0)), "x": (2, (7, 1, 0)), "z": (2, (-2, 1, 7))}
    assert (sphere.diameter, sphere.centre) == changed[value]


def test_a_right_click_on_a_tool_is_none_on_what_lies_behind_it() -> None:
    session = play("resize 640x480", "press Tab", "click 8,240 right")
    assert session.state.selected == play("resize 640x480", "press Tab").state.selected
    assert session.screen.list_box is None


@pytest.mark.parametrize("text", ["-3 -4 0", "-0.6 -0.8 0", "-300,-400,0"])
def test_a_direction_is_typed_with_any_length(text: str) -> None:
    camera = typed(initial_state(scene()), "direction: x", text).scene.camera
    assert camera.direction == pytest.approx((-0.6, -0.8, 0))


def test_what_is_typed_is_given_to_all_selected_elements_that_have_it() -> None:
    moved = typed(both(), "centre: z", "-4")
    assert [each.centre[2] for each in (moved.scene.spheres[0], moved.scene.cylinders[0])] == [-4, -4]
    relative = typed(both(), "centre: x", "+=1").scene
    assert (relative.spheres[0].centre[0], relative.cylinders[0].centre[0]) == (-1, 3)
    assert len(moved.undo_stack) == 1
    wide = typed(both().make_primary(4), "height", "5")  # which a sphere has not
    assert (wide.scene.spheres, wide.scene.cylinders[0].height) == (scene(PAIR).spheres, 5)


# Looking.


def test_a_second_press_brings_all_into_view_without_a_turn() -> None:
    first = played("press Tab", "press Tab", "press F").state
    second = played("press Tab", "press Tab", "press F", "press F").state
    assert first.message == "again: the whole scene"
    before, near, all_of_it = (each.scene.camera for each in (initial_state(scene()), first, second))
    assert near.direction == all_of_it.direction == before.direction
    assert near.position[2] < all_of_it.position[2]
    assert all_of_it == played("press F").state.scene.camera  # of the camera itself


def test_what_is_beyond_the_picture_of_the_whole_window_is_darker() -> None:
    pixels = np.full((300, 160, 4), 200, np.uint8)
    darken_beyond(pixels, 400, 16)  # of which 160 columns are left: they show 120 rows
    assert {*pixels[:90, :, :3].flat, *pixels[211:, :5, :3].flat} == {150}
    assert {*pixels[90:210].flat} == {200}


def test_an_arrow_is_a_click_and_no_drag() -> None:
    aside = TEXT.replace("C 0,0,10 0,0,-1", "C 0,0,10 1,0,-0.2")
    opened = ("press Tab", "press Tab")
    session = played(*opened, text=aside)
    (way,) = arrows(session.state.scene, session.state.chosen, session.view, every=False).values()
    x, y = map(int, arrow_tip(way, *session.screen.size, session.screen.scale))
    assert session.screen.level > HudLevel.NOTHING
    dragged = played(*opened, f"drag {x},{y} {x + 9},{y}", text=aside).state
    assert dragged.scene.camera == session.state.scene.camera
    clicked_on = played(*opened, f"click {x},{y}", text=aside).state
    assert clicked_on.message.startswith("sphere 1 is in the middle now")


def judged(*lines: str, text: str = LAMP_OUTSIDE) -> Session:
    """The session after lines and the final picture."""
    harness = SessionHarness(text=text, samples=1)
    for line in ("wait 0.1", *lines):
        harness.play(line)
        while harness.painter.busy:
            harness.finish(0.001)
    return harness.session


def test_an_edit_that_hides_a_lamp_says_so_once() -> None:
    lamp = scene(LAMP_OUTSIDE).lights[0]
    steps = [each.name for each in values(lamp)].index("position: x")
    inside = ("press L", *["press V"] * steps, "text 0,1,0", "press Return")
    session = judged(*inside)
    assert session.state.scene.lights[0].position == (0, 1, 0)
    assert "light 1 lights nothing: it is inside sphere 1" in session.state.message
    assert "lights nothing" not in judged(*inside, "press C", "press D").state.message


# Building.


def test_a_ball_on_a_ball_has_its_colour_and_three_quarters_of_its_breadth() -> None:
    lower = scene().spheres[0]
    upper = play("move 320,212", "press N", text=TEXT.replace("5,5,5 0.5", "5,5,5 0.5")).state.element
    assert upper.colour == lower.colour
    assert upper.diameter == pytest.approx(0.75 * lower.diameter, rel=0.1)
    assert hypot(*upper.centre) == pytest.approx((upper.diameter + lower.diameter) / 2, abs=0.01)
    box = play("move 320,212", "press N", "press b", "press o").state.element
    assert box.colour != lower.colour


def test_the_title_has_a_star_while_something_is_unsaved(tmp_path: Path) -> None:
    path = tmp_path / "scene.rt"
    path.write_text(TEXT)
    assert played(path=path).window.title == "miniRT - scene.rt"
    edit = ("press Tab", "press Tab", "press D")
    assert played(*edit, path=path).window.title == "miniRT - scene.rt *"
    assert played("hold d 0.2", path=path).window.title == "miniRT - scene.rt"  # looking around
    assert played(*edit, "press Ctrl+Z", path=path).window.title == "miniRT - scene.rt"
    assert played(*edit, "press Ctrl+S", path=path).window.title == "miniRT - scene.rt"


def test_undo_after_lists_and_several_leads_to_the_bytes_of_the_start() -> None:
    lines = (
        right_click(AT_SPHERE),
        "press U",
        "press Return",
        "press N",
        "press Return",
        "press U",
        "press Down",
        "press Return",
    )
    session = play(*lines, *["press Ctrl+Z"] * 4)
    opened: Scene = scene()
    assert dump(session.state.scene) == dump(opened) == TEXT


def test_handles_are_shown_while_the_pointer_is_near_the_selected_element() -> None:
    def frame(*lines: str) -> NDArray[np.uint8]:
        session = played("resize 640x480", "press Tab", "press Tab", *lines, text=PAIR)
        return session.screen.frame[100:].copy()

    near, far = frame("move 250,230"), frame("move 600,400")
    assert (near != far).any()
    assert (near == frame("move 260,220")).all()
    assert (far == frame("move 600,380")).all()
    assert (near == frame()).all(), "while the pointer was nowhere so far"
    typing = frame("move 250,230", "text 2")
    assert (typing[:, 400:] == far[:, 400:]).all()


@pytest.mark.parametrize(("tab", "step"), [("press Tab", 1), ("press Shift+Tab", -1)])
def test_tab_after_the_word_of_a_colour_sets_it_and_goes_on(tab: str, step: int) -> None:
    text = PAIR.replace("sp -2,1,0 2 255,0,0", "co -2,2,0 0,-1,0 1 2 255,0,0")
    opened = ["press Tab", "press Tab", *["press V"] * 2]  # its diameter, its height, its colour
    before = played(*opened, text=text).state
    session = played(*opened, "text =", *(f"press {each}" for each in "ORANGE"), tab, "text 0", text=text)
    after = session.state
    assert after.selected == before.selected
    assert after.element.colour == COLOURS["orange"]
    assert after.active == next_in_line(before, step, whole=True)
    assert session.screen.list_box
    assert session.screen.list_box.title.startswith(f"{after.active.name}, now")


def test_tab_in_the_list_of_a_right_click_selects_the_next_element_also_after_a_typed_colour() -> None:
    opened = ["resize 640x480", "press Tab", "press Tab", "press V"]
    typed = [*opened, "text =", *(f"press {each}" for each in "ORANGE")]
    menu = "click 250,240 right", "press Tab"
    after, alone = played(*typed, *menu, text=PAIR), played(*opened, *menu, text=PAIR)
    assert after.state.selected == alone.state.selected
    assert not after.screen.list_box


def test_handles_that_are_not_shown_are_not_grabbed() -> None:
    opened = ["resize 640x480", "press Tab", "press Tab"]
    state = played(*opened, text=PAIR).state
    handles = handles_of(state.element, projection_of(state.scene.camera, 640, 480), 1.0)
    x, y = map(int, next(each.points[0] for each in handles if (each.kind, each.axis) == (MOVE, 1)))
    assert played(*opened, f"drag {x},{y} {x},{y - 40}", text=PAIR).state.element != state.element
    typing = played(*opened, "text 2", f"drag {x},{y} {x},{y - 40}", text=PAIR).state
    assert typing.scene.elements[state.selected].centre == state.element.centre


@pytest.mark.parametrize(
    "line", ["sp -2,1,0 2 255,0,0", "bo -2,1,0 0,1,0 2,2,2 255,0,0", "cy -2,1,0 0,1,0 1 2 0,0,255"]
)
def test_three_numbers_are_the_position_of_a_copy_whatever_was_active(line: str) -> None:
    text = PAIR.replace("sp -2,1,0 2 255,0,0", line)
    for steps in range(7):
        keys = ["press Tab", "press Tab", *["press V"] * steps, "press Ctrl+D"]
        copied = played(*keys, text=text)
        assert f"beside the original{GAP}press = and type x y z: its position" in copied.state.message
        keys = [f"text {character}" for character in "=-1,2,3"]
        placed = played(
            "press Tab", "press Tab", *["press V"] * steps, "press Ctrl+D", *keys, "press Return", text=text
        )
        assert placed.state.element.replace(centre=(-2, 1, 0)) == placed.state.scene.shapes[0]
        assert placed.state.element.centre == (-1, 2, 3)
