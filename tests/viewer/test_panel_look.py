"""What the panel shows: groups that fold, colours that can be read, numbers that fit, and a picture beside it."""

from __future__ import annotations

import itertools
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from minirt.mlx import Key, Mlx
from minirt.mlx.memory import Memory
from minirt.scene import dump, parse
from minirt.viewer.app.events import EventDispatcher
from minirt.viewer.app.session import Session
from minirt.viewer.display.painter import Painter
from minirt.viewer.editing.editor import apply
from tests.viewer.fake import TEXT, FakeRenderer, colour_of, played

pytest.importorskip("slimgui", reason="the panel needs slimgui: make installs it")
from slimgui import imgui

from minirt.viewer.panel import style
from minirt.viewer.panel.numbers import spellings
from minirt.viewer.panel.pages import step_title
from tests.viewer.test_panel import User

SIZES = [(400, 300), (1280, 720), (1920, 1080), (3840, 2160)]
BOX = TEXT + "bo 0,0,5 0,1,0 1,2,3 9,9,9\n"
TINTED = TEXT + "sp 0,0,5 1 9,9,9 tint:9,9,9,2\n"
FADED = style.FADED


def luminance(colour: int) -> float:
    """Relative luminance of 0xRRGGBB, by WCAG 2."""
    linear = [part / 12.92 if part <= 0.04045 else ((part + 0.055) / 1.055) ** 2.4 for part in style.rgba(colour)[:3]]
    return float(np.dot(linear, (0.2126, 0.7152, 0.0722)))


def contrast(text: int, ground: int) -> float:
    """Contrast of text with what it lies on, from 1 to 21."""
    lighter, darker = sorted((luminance(text), luminance(ground)), reverse=True)
    return (lighter + 0.05) / (darker + 0.05)


def mixed(over: int, ground: int) -> int:
    """A colour that is FADED over another one."""
    pairs = zip(over.to_bytes(3), ground.to_bytes(3), strict=True)
    return int.from_bytes([round(FADED * a + (1 - FADED) * b) for a, b in pairs])


GROUNDS = [style.GROUND, style.LIST, style.POPUP]
BOXES = [style.BOX, style.BOX_UNDER_POINTER, style.BOX_PRESSED, style.CHOSEN, style.CHOSEN_UNDER_POINTER]


@pytest.mark.parametrize("ground", [*GROUNDS, *BOXES])
def test_text_has_the_contrast_that_wcag_asks_for(ground: int) -> None:
    assert contrast(0xFFFFFF, 0) == pytest.approx(21)
    assert contrast(style.TEXT, ground) >= style.LEGIBLE
    if ground in GROUNDS:
        assert contrast(style.FAINT_TEXT, ground) >= style.LEGIBLE
        assert contrast(style.GOLD, ground) >= style.LEGIBLE
        assert contrast(mixed(style.TEXT, ground), ground) >= style.LEGIBLE  # of what is switched off
    assert contrast(mixed(style.TEXT, mixed(style.BOX, style.GROUND)), mixed(style.BOX, style.GROUND)) >= style.LEGIBLE


def test_no_colour_is_the_blue_of_the_library_and_hints_can_be_read() -> None:
    User(parse(TEXT, "scene.rt").scene)
    assert contrast(style.FAINT_TEXT, style.BOX) >= style.LEGIBLE  # the hint of the search
    for each in imgui.Col.__members__.values():
        if each != imgui.Col.COUNT:
            red, green, blue, opacity = imgui.get_style().colors[each]
            assert blue <= max(red, green) + 0.03
            assert opacity == 1.0


def test_groups_fold_for_all_elements_until_the_window_closes() -> None:
    user = User(parse(TEXT + "sp 0,0,5 1 9,9,9\n", "scene.rt").scene, select=3)
    assert {"centre: x", "diameter", "colour: red"} <= user.widgets.places.keys()
    assert "mirror on" not in user.widgets.places
    user.click("surface group")
    user.click("place group")
    user.click("element 6")
    assert "mirror on" in user.widgets.places
    assert "centre: x" not in user.widgets.places
    user.press(Key.F1)
    user.press(Key.F1)
    assert "mirror on" in user.widgets.places
    assert "centre: x" not in user.widgets.places
    assert "mirror on" not in User(user.state.scene, select=3).widgets.places


def test_what_has_no_effect_is_not_alive_and_can_be_taken_away() -> None:
    user = User(parse(TINTED, "scene.rt").scene, select=6)
    user.unfold("surface")
    user.drag("tint distance", (40, 0))
    user.click("fresnel on")
    assert dump(user.state.scene) == TINTED
    user.click("glass on")
    user.drag("tint distance", (40, 0))
    assert user.element.tint.distance > 2
    user.click("glass on")
    user.click("tint on")
    assert user.element.tint is None


def test_numbers_that_are_dragged_are_rounded_as_keys_round_them() -> None:
    user = User(parse(BOX, "scene.rt").scene, select=6)
    user.drag("sizes: w", *((n, 0) for n in range(4, 61, 7)))
    dragged = user.element.sizes[0]
    assert dragged != 1
    assert len(f"{dragged:.12g}") <= 6  # five digits
    state = user.state.select(6)
    while state.active.name != "sizes: w":
        state = apply(state, "next value")
    for _ in range(7):
        state = apply(state, "grow")
    assert len(f"{state.element.sizes[0]:.12g}") <= 6


def test_numbers_lose_digits_and_not_their_size_where_there_is_little_room() -> None:
    assert {text.removeprefix("R ") for text in spellings(200, "R")} == {"200"}
    assert list(spellings(-12.345678, "y"))[-1] == "-12"
    assert all("e" in text for text in spellings(1.5e-9, ""))


@pytest.mark.parametrize("language", ["en", "fr"])
@pytest.mark.parametrize("size", SIZES, ids="{0[0]}x{0[1]}".format)
def test_no_text_is_cut_off(size: tuple[int, int], language: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("LANGUAGE", language)
    text = "bg 200,210,220\n" + TEXT + "sl -0.12,-12.5,3.25 0.6,-0.48,0.64 120.5 0.125 200,210,220\n"
    user = User(parse(text, "scene.rt").scene, size, select=7)
    cut: list[str] = []

    def check(name: str, width_of: Any) -> None:
        function = getattr(imgui, name)

        def checked(label: str, *rest: Any, **options: Any) -> Any:
            result = function(label, *rest, **options)
            wanted, right = width_of(label.partition("###")[0]), imgui.get_item_rect_max()[0]
            if wanted > imgui.get_item_rect_size()[0] or right > size[0]:
                cut.append(label)
            return result

        monkeypatch.setattr(imgui, name, checked)

    for name in ("button", "text", "checkbox", "tab_item_button"):
        check(name, lambda text: imgui.calc_text_size(text)[0])
    for page in (*user.panel._tabs, *user.panel._tabs):
        user.click(page)
        user.unfold("surface", "pictures")
    assert cut == []


def test_the_picker_reads_hexadecimal_digits() -> None:
    user = User(parse(TEXT, "scene.rt").scene, select=3)
    user.click("colour picker")
    user.click("colour hex")
    user.type("ff8000")
    assert user.element.colour == (255, 128, 0)
    user.click("colour hex")
    user.type("ff80")
    assert user.element.colour == (255, 128, 0)
    assert "six digits" in user.rows.error[2]


def test_a_number_that_is_typed_is_that_of_no_other_element() -> None:
    user = User(parse(TEXT + "sp 0,0,5 1 9,9,9\n", "scene.rt").scene, select=3)
    user.click("diameter")
    user.memory.text("7")
    user.memory.play()
    user.session.show(user.state.select(6))  # as by a replaced file, without an event of the panel
    user.panel.follow()
    user.press(Key.RETURN)
    user.press(Key.RETURN)
    assert [each.diameter for each in user.state.scene.spheres] == [2, 1]


def test_add_copy_and_delete_do_what_the_keys_do() -> None:
    user = User(parse(TEXT, "scene.rt").scene, select=3)
    user.click("add")
    assert user.session.screen.list_box is not None
    assert user.element.centre == (0, 1.75, 0)  # on top of what was selected, as the pointer is over the panel
    user.press(Key.B)
    user.press(Key.RETURN)
    assert user.element.title == "box"
    user.click("duplicate")
    assert [each.title for each in user.state.scene.elements].count("box") == 2
    user.click("delete")
    assert [each.title for each in user.state.scene.elements].count("box") == 1
    user.click("add")
    user.click("element 3")  # it closes the list, too
    assert user.session.screen.list_box is None
    while user.state.undo_stack:
        user.press(Key.CONTROL_L, Key.Z)
    assert dump(user.state.scene) == TEXT


@pytest.mark.parametrize("size", SIZES, ids="{0[0]}x{0[1]}".format)
def test_the_picture_is_centred_in_what_the_panel_leaves_and_nothing_of_it_is_hidden(size: tuple[int, int]) -> None:
    memory = Memory(screen=SIZES[-1])
    mlx = Mlx(memory)
    session = Session(mlx, mlx.mlx_init(), parse(TEXT).scene, Path("scene.rt"), size, FakeRenderer(), Painter)
    dispatcher = EventDispatcher(session)
    memory.play()
    memory.tap(Key.F1)
    memory.play()
    left = int(dispatcher.panel.left)
    assert size[0] * 2 // 5 <= left == session.screen.size[0] < size[0]
    assert session.refinement.latest.job.size == (left, size[1])
    colour = np.array(colour_of(session.state.scene)[:3])
    assert (session.screen.frame[-1, :left, :3] == colour - colour // 4).all()  # outside of the saved picture
    assert not session.screen.frame[-1, left:, :3].any()
    assert session.view.pixel((0, 0, 0)) == pytest.approx((left / 2, size[1] / 2))  # the sphere
    memory.click(left // 2, size[1] // 2)
    memory.play()
    assert session.state.selected == 3
    memory.tap(Key.F1)
    memory.play()
    assert session.refinement.latest.job.size == session.screen.size == size


def test_saved_pictures_are_as_large_as_the_window_and_the_shown_one_stays(tmp_path: Path) -> None:
    path = tmp_path / "scene.rt"
    path.write_text(TEXT)
    played("press P", path=path)
    sizes = []
    beside = played("press F1", "press P", path=path, watch=lambda each: sizes.append(each.refinement.latest.job.size))
    assert (tmp_path / "scene-2.png").read_bytes() == (tmp_path / "scene-1.png").read_bytes()
    assert beside.refinement.latest.job.size == beside.screen.size != beside.window_size
    assert not beside.screenshot_pending


def test_the_steps_of_the_history_are_told_in_french(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("LANGUAGE", "fr")
    session = played("press Tab", "press Tab", "text 7", "press Return", "press Ctrl+D", "press Delete")
    steps = [*session.state.undo_stack, session.state.snapshot]
    titles = [step_title(*pair) for pair in itertools.pairwise(steps)]
    assert titles == ["sphère 1: centre, diamètre", "+ sphère 2", "- sphère 2"]
