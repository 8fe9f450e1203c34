"""Lists by pointer: the list of a right click, rows that take clicks and the wheel, and the tool row."""

from __future__ import annotations

import numpy as np
import pytest

from minirt.scene import Camera
from minirt.shapes import Box, Cylinder, Plane, Sphere
from minirt.viewer.app.menu import MENU
from minirt.viewer.app.session import Session
from minirt.viewer.display.lists import ListBox, layout_of
from minirt.viewer.display.tool_row import TOOLS, layout, tool_at
from minirt.viewer.editing.handles import MOVE, SIZE, SLIDE, TURN, handles_of
from tests.viewer.fake import TEXT, played, scene

SIZE_OF_WINDOW = 640, 480
AT_SPHERE, NOWHERE = (320, 240), (20, 20)
CAMERAS = TEXT + "c 0,3,9 0,0,-1 60\n"


def play(*lines: str, text: str = TEXT) -> Session:
    return played(*lines, text=text, size=SIZE_OF_WINDOW)


def rows(session: Session) -> tuple[str, ...]:
    return session.screen.list_box.rows if session.screen.list_box else ()


def box_of(session: Session) -> ListBox:
    assert session.screen.list_box
    return session.screen.list_box


def click_on(session: Session, row: str) -> str:
    """The line of a recording that clicks on a row of the list that is open."""
    box = box_of(session)
    at = layout_of(box, *SIZE_OF_WINDOW, session.screen.text_size)
    return f"click {at.text_left + 2},{at.rows_top + (box.rows.index(row) - at.first) * at.line + at.line // 2}"


def clicked(*lines: str, row: str, text: str = TEXT) -> Session:
    """The session after some lines and a click on a row of the list that they leave open."""
    return play(*lines, click_on(play(*lines, text=text), row), text=text)


def right_click(at: tuple[int, int]) -> str:
    return f"click {at[0]},{at[1]} right"


def test_a_right_click_shows_what_can_be_done_with_the_element_there() -> None:
    session = play(right_click(AT_SPHERE))
    assert isinstance(session.state.element, Sphere)
    assert session.state.scene.items == scene().items
    box = box_of(session)
    assert (box.title, box.place) == ("sphere 1", AT_SPHERE)
    assert set(box.rows) == {*MENU.values()} - {
        "look through",
        "undo",
        "redo",
        "second colour >",
        "panel: values, picture, film",
    }
    assert box.keys[box.rows.index("duplicate")] == "Ctrl+D"
    nothing = play("press Tab", right_click(NOWHERE))
    assert nothing.state.element is nothing.state.scene.camera
    assert {"delete", "drop onto what lies beneath", "focus here"}.isdisjoint(rows(nothing))
    assert "panel: values, picture, film" in rows(nothing)
    edited = play("press Tab", "press Tab", "press D", right_click(AT_SPHERE))
    assert "undo" in rows(edited)
    assert not rows(play("drag 320,240 400,300 right"))  # which looks around


@pytest.mark.parametrize(("row", "spheres"), [("duplicate", 2), ("delete", 0), ("bring into view; again: all", 1)])
def test_a_click_on_a_row_does_what_its_key_does(row: str, spheres: int) -> None:
    session = clicked(right_click(AT_SPHERE), row=row)
    assert len(session.state.scene.spheres) == spheres
    assert not rows(session)
    keys = {"duplicate": "press Ctrl+D", "delete": "press Delete", "bring into view; again: all": "press F"}
    by_key = play("click 320,240", keys[row])
    assert session.state.scene.items == by_key.state.scene.items


def test_what_is_added_here_stands_where_the_list_was_opened() -> None:
    opened = right_click((420, 380)), "move 500,460"
    listed = clicked(*opened, row="add here >")
    assert rows(listed)[0] == "sphere"
    by_key = play("move 420,380", "press N")
    assert listed.state.scene.items == by_key.state.scene.items
    assert box_of(listed).place == (420, 380)
    lines = *opened, click_on(play(*opened), "add here >")
    boxed = play(*lines, click_on(listed, "box"))
    assert isinstance(boxed.state.element, Box)
    assert not rows(boxed)
    assert len(boxed.state.undo_stack) == 1
    assert play(*lines, click_on(listed, "box"), "press Ctrl+Z").state.scene.items == scene().items


def test_lists_of_keys_take_clicks_and_the_wheel() -> None:
    chosen = clicked("press N", row="cylinder")
    assert isinstance(chosen.state.element, Cylinder)
    assert (rows(chosen), len(chosen.state.undo_stack)) == ((), 1)
    turned = play("press N", "wheel down", "wheel down", "wheel up")
    assert isinstance(turned.state.element, Plane)
    assert rows(turned)
    assert turned.state.scene.camera == scene().camera


def test_attributes_that_are_there_keep_their_rows_and_show_their_values() -> None:
    text = TEXT.replace("sp 0,0,0 2 255,0,0", "sp 0,0,0 2 255,0,0 mirror:0.25")
    listed, without = play("click 320,240", "press M", text=text), play("click 320,240", "press M")
    assert rows(listed) == rows(without)
    box = box_of(listed)
    at = box.rows.index("mirror")
    assert box.keys[at] == "0.25"
    assert set(box.keys[:at] + box.keys[at + 1 :]) == {""}
    lines = "click 320,240", "press M", click_on(listed, "mirror")
    taken = play(*lines, text=text)
    assert taken.state.scene.items == scene(text).items
    assert (taken.state.active.name, taken.state.undo_stack, rows(taken)) == ("mirror share", (), ())
    typed = play(*lines, "text =", *(f"text {character}" for character in "0.5"), "press Return", text=text)
    assert (typed.state.element.mirror.share, len(typed.state.undo_stack)) == (0.5, 1)
    left = play("click 320,240", "press M", click_on(listed, "mirror").replace("click", "move"), "press D", text=text)
    assert len(left.state.undo_stack) == 1, "the row under the pointer is no change of its own"


def test_keys_and_the_pointer_go_through_the_list_of_actions() -> None:
    title = right_click(AT_SPHERE)
    listed = play(title)
    assert len(play(title, *["press Down"] * 3, "press Return").state.scene.spheres) == 2
    assert len(play(title, "press d", "press e", "press Return").state.scene.spheres) == 0
    assert box_of(play(title, "press Up")) == box_of(listed)._replace(chosen=len(rows(listed)) - 1)
    assert rows(play(title, "press N"))[0] == "sphere"  # the key beside a row
    unknown = play("press N", "press q", "press q")
    assert box_of(unknown).title == "element: q_    nothing is called qq"
    assert "square" in rows(unknown)
    over = click_on(listed, "delete").replace("click", "move")
    assert box_of(play(title, over)).chosen == rows(listed).index("delete")
    for end in ("press Escape", "click 5,400", "press Ctrl+Z", "press Tab"):
        ended = play(title, end)
        assert not rows(ended)
        assert ended.state.scene.items == scene().items
    assert isinstance(play(title, "click 5,400").state.element, Sphere)  # the click closes the list and no more


def test_a_further_camera_is_looked_through() -> None:
    listed = play("press Shift+Tab", "press Shift+Tab", text=CAMERAS)
    assert isinstance(listed.state.element, Camera)
    seen = play("press Shift+Tab", "press Shift+Tab", "press Shift+C", text=CAMERAS)
    assert (seen.state.scene.shown, seen.state.message) == (1, "camera 2 of 2")
    assert play("press Tab", "press Shift+C", text=CAMERAS).state.message == "light is no camera"


def at_tool(name: str, height: int = 480, scale: float = 1.0) -> tuple[int, int]:
    side, top = layout(SIZE_OF_WINDOW[0], height, scale)
    return side // 2, top + side * [each.name for each in TOOLS].index(name) + side // 2


def tool(name: str, verb: str = "click") -> str:
    x, y = at_tool(name)
    return f"{verb} {x},{y}"


def test_tools_do_what_their_keys_do() -> None:
    added = play("move 320,300", tool("add an element"))
    assert rows(added)[0] == "sphere"
    assert len(added.state.scene.spheres) == 2
    assert play(tool("add an element"), tool("add an element")).screen.list_box is None  # the second one closes it
    assert play("press Tab", "press Tab", "press D", tool("undo")).state.scene.items == scene().items
    assert play(tool("help")).screen.help
    named = play(tool("undo", "move"))
    assert named.screen.tool
    assert named.screen.tool.name == "undo"
    assert play(tool("undo", "move"), "move 320,240").screen.tool is None
    hidden = play("press K", tool("help"))
    assert not hidden.screen.help
    assert not np.array_equal(play().screen.frame[:, :30], play("press K").screen.frame[:, :30])


@pytest.mark.parametrize(
    ("name", "kinds"),
    [("handles that move", {MOVE, SLIDE}), ("handles that turn", {TURN}), ("handles that resize", {SIZE})],
)
def test_a_tool_shows_the_handles_of_its_kind_alone(name: str, kinds: set[str]) -> None:
    session = play("press Tab", "press Tab", "press Tab", "press Tab", tool(name))
    kind = session.screen.handle_kind
    assert {each.kind for each in handles_of(session.state.element, session.view, 1.0, kind=kind)} == kinds
    assert play(tool(name), tool(name)).screen.handle_kind == ""


def test_a_window_without_room_has_no_tool_row() -> None:
    assert layout(150, 480, 1.0) == layout(640, 150, 1.0) == (0, 0)
    side, top = layout(640, 300, 1.0)
    assert 0 < side < 30
    assert top > 30
    assert tool_at(5, top + side * len(TOOLS), 640, 300, 1.0) is None
    assert tool_at(5, top + side * len(TOOLS) - 1, 640, 300, 1.0) is TOOLS[-1]
