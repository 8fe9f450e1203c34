"""The panel, on a window in memory: Dear ImGui needs no graphics card for what it does, only for what it shows.

The user of the tests finds widgets by the names of values, with the pointer or by keys alone.
"""

from __future__ import annotations

import os
import random
import re
import sys
from math import dist
from pathlib import Path
from shutil import copyfile
from typing import Any

import pytest

from minirt.cli import main
from minirt.element import Element, fields_of
from minirt.fields import Choice, Direction, Field, Flag, Length, Lengths, MeshField, Paint, Picture, Point, unit
from minirt.mlx import Key, Mlx
from minirt.mlx.memory import Memory
from minirt.scene import Scene, dump, load, parse
from minirt.scene.registry import ELEMENTS
from minirt.scene.value_reader import lacked_by
from minirt.viewer.app.events import EventDispatcher
from minirt.viewer.app.session import Session
from minirt.viewer.display.jobs import PaintJob
from minirt.viewer.display.painter import Painter
from minirt.viewer.editing.editor import apply
from minirt.viewer.editing.state import State
from minirt.viewer.editing.structure import ATTRIBUTE, choices
from minirt.viewer.editing.values import Value, values
from tests.paths import ROOT
from tests.processes import run
from tests.seeds import seed_of
from tests.viewer.app.test_building import assert_snowman
from tests.viewer.editing.test_every_kind import BARE, WITH_ATTRIBUTES, holding, path, tilted  # noqa: F401  (a fixture)
from tests.viewer.fake import TEXT, FakeRenderer
from tests.waiting import HANG_LIMIT

pytest.importorskip("slimgui", reason="the panel needs slimgui: make installs it")
from minirt.viewer.panel.elements import found
from minirt.viewer.panel.groups import FOLDED
from minirt.viewer.panel.pages import ONCE, step_title
from minirt.viewer.panel.rows import Rows
from tests.viewer.widgets import WIDGETS

SIZE = (300, 2000)
KINDS = list(ELEMENTS.values())


class Idle(Painter):
    """A painter of no pictures."""

    def request(self, job: PaintJob) -> None:
        pass


class Card:
    """A graphics card that takes triangles and shows nothing."""

    def upload(self, *_texture: object) -> int:
        return 1

    def draw(self, vertices: int, _size: int, _indices: int, _index_size: int, runs: list[tuple[object, ...]]) -> None:
        assert vertices
        assert runs


class User:
    """A user of a window whose panel is open."""

    def __init__(
        self, scene: Scene, size: tuple[int, int] = SIZE, select: int | None = None, scale: float = 1.0
    ) -> None:
        self.memory = Memory()
        mlx = Mlx(self.memory)
        file = Path(scene.file or "scene.rt")
        self.session = Session(mlx, mlx.mlx_init(), scene, file, size, FakeRenderer(), Idle)
        if select is not None:
            self.session.state = self.session.state.select(select)
        self.session.window.scale = scale
        self.dispatcher = EventDispatcher(self.session)
        self.press(Key.F1)
        self.panel = self.dispatcher.panel
        self.rows, self.widgets = self.panel.rows, WIDGETS
        self.session.window.blit = lambda: self.panel.is_open and self.panel.paint(Card())
        self.session.draw()

    def press(self, *keys: int) -> None:
        self.memory.tap(*keys)
        self.memory.play()

    def place(self, name: str) -> tuple[int, int]:
        """Where a widget is, after a scroll to it if it is out of sight."""
        x, y = self.widgets.places[name]
        return int(x), int(y)

    def click(self, name: str) -> None:
        self.memory.click(*self.place(name))
        self.memory.play()

    def drag(self, name: str, *offsets: tuple[int, int], fine: bool = False) -> None:
        x, y = self.place(name)
        self.memory.motion(x, y)
        if fine:
            self.memory.press(Key.SHIFT_L)
        self.memory.button_press(1, x, y)
        for right, down in offsets:
            self.memory.motion(x + right, y + down)
        self.memory.button_release(1, x + right, y + down)
        if fine:
            self.memory.release(Key.SHIFT_L)
        self.memory.play()

    def unfold(self, *groups: str) -> None:
        """Click the names of groups that are folded."""
        for group in groups:
            if f"{group} group" in self.widgets.places:
                self.click(f"{group} group")

    def type(self, text: str) -> None:
        """Type characters and Enter."""
        for character in text:
            self.memory.text(character)
        self.press(Key.RETURN)

    def go_to(self, name: str) -> None:
        """Press Tab until a widget has the focus."""
        for _ in range(150):
            self.press(Key.TAB)
            if self.widgets.focused == name:
                return
        raise AssertionError(f"Tab does not reach {name}")

    @property
    def state(self) -> State:
        return self.session.state

    @property
    def element(self) -> Element:
        return self.state.element

    def saved(self) -> Element:
        """The selected element, read back from the text that is saved."""
        again = parse(dump(self.state.scene), self.state.scene.file).scene
        assert again.elements == self.state.scene.elements
        return again.elements[self.state.selected]


def user_of(kind: type[Element], path: Path, attributes: bool = True) -> User:  # noqa: F811
    """A user of a scene with an element of a kind, with all attributes that it can have at once, which is selected."""
    state = holding(kind, path)
    while attributes:
        added = next((each for _, each in choices(state, ATTRIBUTE) if each.scene is not state.scene), None)
        if not added:
            break
        state = added
    user = User(tilted(state).scene, select=state.selected)
    user.unfold(*FOLDED)
    return user


def number_values(element: Element) -> list[Value]:
    """The values that are numbers in the panel: scalars and parts of triples."""
    return [
        value
        for value in values(element)
        if isinstance(value.current(element), int | float) and not isinstance(value.leaf, Flag)
    ]


def other_values(element: Element) -> list[Value]:
    """The values that are chosen: words, files and flags."""
    chosen = Choice | Flag | Picture | MeshField | Paint
    return [value for value in values(element) if isinstance(value.leaf, chosen) and value.channel is None]


def tried(kind: type[Element]) -> set[tuple[str, type[Field]]]:
    """The fields of a kind whose numbers are tried, by name and sort."""
    fields = fields_of(kind) if kind in WITH_ATTRIBUTES else [each for each in fields_of(kind) if not each.keyed]
    return {(each.name, type(each)) for each in fields}


@pytest.mark.parametrize("kind", KINDS, ids=lambda kind: kind.code)
def test_every_number_of_every_kind_is_dragged_and_typed_with_the_pointer(kind: type[Element], path: Path) -> None:  # noqa: F811
    """All have a place. A field is tried in the first kind that has it: rows know the sorts of fields, and no kinds."""
    user = user_of(kind, path, attributes=kind in WITH_ATTRIBUTES)
    assert {value.name for value in number_values(user.element)} <= user.widgets.places.keys()
    new = tried(kind).difference(*map(tried, KINDS[: KINDS.index(kind)]))
    for value in number_values(user.element):
        if (value.field.name, type(value.field)) not in new:
            continue
        before, steps = user.element, len(user.state.undo_stack)
        user.drag(value.name, (30, 0), (30, -30))
        user.drag(value.name, (-8, 0), (-16, 0))
        assert value.get(user.saved()) != value.get(before), value.name
        assert len(user.state.undo_stack) - steps in (1, 2), value.name
        while len(user.state.undo_stack) > steps:
            user.press(Key.CONTROL_L, Key.Z)
        user.click(value.name)
        assert user.panel.types, value.name
        user.type("0,5*2")
        after = user.saved()
        if user.rows.error[1] == value.name:
            assert value.get(after) == value.get(before)
        elif isinstance(value.leaf, Direction) and value.channel < 3:
            x, y, z = (1 if part == value.channel else old for part, old in enumerate(value.get(before)))
            assert value.get(after) == pytest.approx(unit((x, y, z)), abs=1e-8)
        else:
            assert value.current(after) == pytest.approx(1), value.name
        for field in fields_of(kind):
            stands = isinstance(value.field, Length | Lengths) and isinstance(field, Point)  # and goes on standing
            may_change = field.name == value.field.name or stands
            assert may_change or getattr(after, field.name) == getattr(before, field.name)


@pytest.mark.parametrize("kind", WITH_ATTRIBUTES, ids=lambda kind: kind.code)
def test_every_number_is_typed_by_keys_alone(kind: type[Element], path: Path) -> None:  # noqa: F811
    user = user_of(kind, path)
    numbers = {value.name: value for value in number_values(user.element)}
    for name in [each for each in user.widgets.places if each in numbers]:  # in the order of Tab
        value = numbers[name]
        user.go_to(value.name)
        for number in (-3, 7):
            user.type(str(number))
            reached = value.current(user.saved())
            assert reached == number or user.rows.error[1] == value.name or isinstance(value.leaf, Direction)


def test_a_minus_after_tab_begins_a_negative_number_and_a_double_click_selects_all() -> None:
    user = User(parse(TEXT, "scene.rt").scene, select=3)
    user.go_to("centre: y")
    user.type("-0.9")
    assert user.saved().centre == (0, -0.9, 0)
    user.go_to("centre: y")
    user.type("-=0.1")
    assert user.saved().centre == (0, -1, 0)
    user.go_to("centre: x")
    user.type("-12.75")
    x, y = user.place("centre: x")
    for jitter in (0, 2):  # the pointer may move a little
        user.memory.button_press(1, x, y)
        user.memory.motion(x + jitter, y)
        user.memory.button_release(1, x + jitter, y)
    user.memory.play()
    user.type("-3")
    assert user.saved().centre == (-3, -1, 0)
    assert len(user.state.undo_stack) == 4


@pytest.mark.parametrize("kind", KINDS, ids=lambda kind: kind.code)
@pytest.mark.parametrize("by_keys", [False, True], ids=["pointer", "keys"])
def test_every_word_file_and_flag_is_chosen(kind: type[Element], by_keys: bool, path: Path) -> None:  # noqa: F811
    user = user_of(kind, path, attributes=kind in WITH_ATTRIBUTES)
    for value in other_values(user.element):
        before = user.element
        name = f"{value.name} on" if isinstance(value.leaf, Flag) else value.name
        name += " file" if isinstance(value.leaf, Picture | MeshField | Paint) else ""
        if by_keys:
            user.go_to(name)
            for key in [Key.RETURN] if isinstance(value.leaf, Flag) else [Key.RETURN, Key.DOWN, Key.RETURN]:
                user.press(key)
        else:
            user.click(name)
            options = [each for each in user.widgets.places if each.startswith(f"{value.name} ") and "." in each]
            options += [f"{value.name} {value.leaf.words[-1]}"] if isinstance(value.leaf, Choice) else []
            if not isinstance(value.leaf, Flag):
                user.click(options[-1])
        assert value.get(user.saved()) != value.get(before), value.name


@pytest.mark.parametrize("kind", WITH_ATTRIBUTES, ids=lambda kind: kind.code)
def test_every_attribute_is_switched_on_and_off(kind: type[Element], path: Path) -> None:  # noqa: F811
    user = user_of(kind, path, attributes=False)
    for field in fields_of(kind):
        if field.keyed and field.default is None:
            if lacked := lacked_by(user.element, field):  # it is not alive before the other is there
                user.click(f"{field.title} on")
                assert not user.state.undo_stack
                user.click(f"{lacked[0]} on")
            before = len(user.state.undo_stack)
            user.click(f"{field.title} on")
            assert getattr(user.saved(), field.name) is not None
            assert len(user.state.undo_stack) == before + 1
            user.go_to(f"{field.title} on")
            user.press(Key.SPACE)
            assert getattr(user.saved(), field.name) is None
            while user.state.undo_stack:
                user.press(Key.CONTROL_L, Key.Z)


def test_a_drag_is_one_step_of_undo_and_shift_makes_it_finer() -> None:
    user = User(parse(TEXT, "scene.rt").scene, select=3)
    user.drag("centre: x", *((n, 0) for n in range(4, 60, 4)))
    far = user.element.centre[0]
    assert len(user.state.undo_stack) == 1
    user.press(Key.CONTROL_L, Key.Z)
    assert user.element.centre == (0, 0, 0)
    user.drag("centre: x", *((n, 0) for n in range(4, 60, 4)), fine=True)
    assert user.element.centre[0] == pytest.approx(far / 10, rel=0.2)


def test_out_of_range_is_told_as_by_the_reader_and_changes_nothing() -> None:
    user = User(parse(TEXT, "scene.rt").scene, select=3)
    before = user.state.scene
    for text in ("-3", "2*(", "1/0", "abc"):
        user.click("diameter")
        user.type(text)
        assert user.state.scene is before
        assert user.rows.error[1] == "diameter"
    user.click("diameter")
    user.type("-3")
    assert user.rows.error[2] == "sphere diameter must be > 0, got -3"


def test_keys_are_those_of_the_picture_until_the_panel_has_the_focus_and_after_escape() -> None:
    user = User(parse(TEXT, "scene.rt").scene)
    user.memory.click(50, 50)
    user.press(Key.TAB)
    selected = user.state.selected
    user.click("element 3")
    user.press(Key.DOWN)
    user.press(Key.RETURN)
    assert user.state.selected == 4 != selected
    user.press(Key.ESCAPE)
    before = user.state.scene
    user.press(Key.D)
    assert user.state.scene is not before
    user.click("element 3")
    user.press(Key.N)  # a letter that is no part of a text gives the keys back, too
    user.memory.text("7")
    user.press(Key.RETURN)
    assert user.element.diameter == 7
    user.click("diameter")
    user.press(Key.N, Key.DELETE)
    assert user.state.selected == 6


def test_an_eye_hides_an_element_and_nothing_is_saved_of_it() -> None:
    user = User(parse(TEXT, "scene.rt").scene, select=1)
    text = dump(user.state.scene)
    user.click("shown 3")
    assert [type(each).__name__ for each in user.session.shown_scene.shapes] == ["Plane", "Cylinder"]
    assert dump(user.state.scene) == text
    user.session.state = user.state.select(4)
    user.press(Key.ESCAPE)
    user.press(Key.DELETE)
    assert [type(each).__name__ for each in user.session.shown_scene.shapes] == ["Cylinder"]
    user.press(Key.CONTROL_L, Key.Z)
    assert [type(each).__name__ for each in user.session.shown_scene.shapes] == ["Plane", "Cylinder"]


def test_a_tab_at_the_right_edge_is_found_by_the_pointer_and_opens_the_panel_which_closes_itself() -> None:
    user = User(parse(TEXT, "scene.rt").scene)
    user.click("close")
    assert not user.panel.is_open
    width, height = SIZE
    user.memory.motion(width // 2, height // 2)
    user.memory.play()
    assert not user.session.screen.has_tab
    user.memory.motion(width - 10, height // 2)
    user.memory.play()
    assert user.session.screen.has_tab
    user.memory.click(width - 10, height // 2)
    user.memory.play()
    assert user.panel.is_open
    assert not user.session.screen.has_tab


def test_the_scene_the_history_and_pictures_have_pages(tmp_path: Path) -> None:
    (tmp_path / "scene.rt").write_text(TEXT)
    user = User(load(tmp_path / "scene.rt").scene, (640, 700), select=3)
    for text in ("3", "4", "5"):
        user.click("diameter")
        user.type(text)
    user.click("History")
    assert [name for name in user.widgets.places if name.startswith("step")] == [f"step {n}" for n in range(4)]
    user.click("step 1")
    assert user.element.diameter == 3
    user.click("step 3")
    assert user.element.diameter == 5
    user.click("Scene")
    user.click("fov")
    user.type("45")
    assert user.state.scene.camera.fov == 45
    user.click("samples")
    user.click("samples 64")
    assert user.session.refinement.samples == 64
    user.click("Picture, film")
    user.click("save")
    assert load(tmp_path / "scene.rt").scene.spheres[0].diameter == 5


@pytest.mark.parametrize("kind", [each for each in ONCE if not each.required], ids=lambda kind: kind.code)
def test_a_setting_that_the_scene_lacks_is_added_changed_saved_and_deleted(kind: type[Element]) -> None:
    user = User(parse(TEXT, "scene.rt").scene)
    user.click("Scene")
    user.click(f"{kind.title} on")
    added = user.saved()
    assert type(added) is kind
    assert dump(user.state.scene).startswith(TEXT)
    value = number_values(added)[0]
    user.click(value.name)
    user.type("77")
    assert value.current(user.saved()) == 77
    user.click(f"{kind.title} on")
    assert dump(user.state.scene) == TEXT
    for _ in range(3):
        user.press(Key.CONTROL_L, Key.Z)
    assert user.state.scene.elements == parse(TEXT, "scene.rt").scene.elements
    assert not user.state.undo_stack


def finished(user: User) -> str:
    """What the panel says of the film, once that is made or stopped."""
    film = user.panel._pages._thread
    assert film is not None
    film.join(HANG_LIMIT)
    user.memory.play()
    return str(user.panel._pages.film)


@pytest.mark.parametrize("suffix", [".gif", ".png"])
def test_a_film_is_that_of_the_command_line_and_can_be_stopped(suffix: str, tmp_path: Path) -> None:
    (tmp_path / "scene.rt").write_text(TEXT)
    user = User(load(tmp_path / "scene.rt").scene, (640, 480))
    user.click("Picture, film")
    user.click("format")
    user.click(f"format {suffix}")
    x, y = user.place("pictures")
    user.memory.click(x - 30, y)
    user.memory.tap(Key.CONTROL_L, Key.A)
    for character in "3":
        user.memory.text(character)
    user.memory.play()
    user.click("film")
    made = tmp_path / f"scene-1{'-0001' if suffix == '.png' else ''}{suffix}"
    assert finished(user) == f"film: {made}"
    command = [sys.executable, "-m", "minirt", str(user.session.path), "--turntable", "3", "--size", "640x480"]
    assert run([*command, "-o", str(tmp_path / f"film{suffix}"), "--no-metadata"]).returncode == 0
    assert made.read_bytes() == (tmp_path / made.name.replace("scene-1", "film")).read_bytes()
    user.panel._pages._pictures = 3600  # a film that does not end before the click that stops it
    user.click("film")
    user.click("film")
    assert finished(user) == "the film was stopped"
    assert not (tmp_path / f"scene-2{suffix}").exists()


def test_the_panel_speaks_french(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("LANGUAGE", "fr")
    user = User(parse(TEXT, "scene.rt").scene, (640, 700), select=3)
    assert list(user.panel._tabs) == ["Éléments", "Scène", "Historique", "Image, film"]
    user.click("diameter")
    user.type("-3")
    assert user.rows.error[1:] == ("diameter", "sphere diameter must be > 0, got -3")
    user.click("Historique")
    user.click("Image, film")
    assert "film" in user.widgets.places


def test_attributes_that_cannot_be_had_are_refused_with_the_reason(tmp_path: Path) -> None:
    (tmp_path / "scene.rt").write_text(TEXT)
    user = User(load(tmp_path / "scene.rt").scene, select=3)
    user.unfold("pictures")
    user.click("texture on")
    assert user.element.texture is None
    assert not user.state.undo_stack


def test_a_row_that_drops_a_change_is_found(path: Path, monkeypatch: pytest.MonkeyPatch) -> None:  # noqa: F811
    """A panel that loses the last part of every triple fails the tests of every number."""
    change, apply_edit = Rows.change, Rows.apply

    def dropping(rows: Rows, value: Value, *rest: Any) -> None:
        if value.channel != 2:
            change(rows, value, *rest)

    def dropping_typed(rows: Rows, edit: Any, name: str = "") -> None:
        if not name.endswith(": z"):
            apply_edit(rows, edit, name)

    monkeypatch.setattr(Rows, "change", dropping)
    with pytest.raises(AssertionError, match="blue"):
        test_every_number_of_every_kind_is_dragged_and_typed_with_the_pointer(ELEMENTS["A"], path)
    monkeypatch.setattr(Rows, "apply", dropping_typed)
    with pytest.raises(AssertionError, match="position: z"):
        test_every_number_is_typed_by_keys_alone(ELEMENTS["L"], path)


def random_input(user: User, chance: random.Random, size: tuple[int, int], keys: list[int]) -> None:
    """Do something, mostly in the panel."""
    x, y = chance.randrange(size[0] // 2, size[0]), chance.randrange(size[1])
    match chance.randrange(8):
        case 0:
            user.memory.click(x, y)
        case 1:
            user.memory.button_press(1, x, y)
            user.memory.motion(chance.randrange(size[0]), chance.randrange(size[1]))
            user.memory.button_release(1, x, y)
        case 2:
            user.memory.text(chance.choice("0123456789+-*/.,()="))
        case 3:
            user.memory.tap(chance.choice(keys))
        case 4:
            user.memory.scroll(chance.choice((-3, 3)), x, y)
        case 5:
            user.memory.resize(*(max(1, side + chance.randrange(-20, 20)) for side in size))
        case 6:  # several elements
            user.memory.press(chance.choice((Key.SHIFT_L, Key.CONTROL_L)))
            user.memory.click(chance.choice((x, size[0] // 4)), y)
            user.memory.release(Key.SHIFT_L)
            user.memory.release(Key.CONTROL_L)
        case 7:  # a name
            user.memory.tap(Key.F2)
            user.memory.text(chance.choice("a#é "))
            user.memory.tap(Key.RETURN)


@pytest.mark.parametrize("size", [(400, 300), (1280, 720)], ids="{0[0]}x{0[1]}".format)
def test_random_input_leaves_a_scene_that_is_saved_and_undone_to_the_first_byte(size: tuple[int, int], path: Path):  # noqa: F811
    """`MINIRT_PANEL_INPUTS` is the number of inputs."""
    seed = seed_of(f"input into the panel {size}")
    chance = random.Random(seed)
    text = BARE + "sp 0,0,0 2 9,9,9\nbo 0,0,5 0,1,0 1,2,3 9,9,9\nL 0,9,0 0.5\n"
    keys = [*range(Key.A, Key.Z + 1), Key.TAB, Key.RETURN, Key.SPACE, Key.UP, Key.DOWN, Key.LEFT, Key.RIGHT]
    keys.remove(Key.P)
    files = set(path.parent.iterdir())
    for number in range(int(os.environ.get("MINIRT_PANEL_INPUTS", "300"))):
        if number % 300 == 0:  # fewer edits than are kept for undo
            user = User(parse(text, path).scene, size)
        random_input(user, chance, size, keys)
        try:
            user.memory.play()
            user.saved()
            if number % 300 == 299:
                assert dump(undone(user.state).scene) == text
        except BaseException as error:
            error.add_note(f"seed {seed}, input {number}")
            raise
    for file in set(path.parent.iterdir()) - files:  # copies and pictures
        file.unlink()


def undone(state: State) -> State:
    """The state after all undos."""
    while state.undo_stack:
        state = apply(state, "undo")
    return state


def built_in(actions: int, name: str, folder: Path) -> Scene:
    """The scene that a recording builds from a blank scene, in so many actions."""
    recording, file = ROOT / f"assets/{name}-panel.txt", folder / f"{name}.rt"
    assert max(map(int, re.findall(r"# (\d+)", recording.read_text()))) == actions
    copyfile(ROOT / "assets/blank.rt", file)
    assert main([str(file), "--replay", str(recording), "--size", "960x540", "-o", str(file.with_suffix(".png"))]) == 0
    return load(file).scene


def test_a_table_with_a_lamp_and_a_glass_is_built_with_the_pointer_and_the_panel(tmp_path: Path) -> None:
    leg, top, glass, stem, shade, spot = built_in(46, "table", tmp_path).elements[4:]
    for lower, upper in ((leg, top), (top, glass), (top, stem)):
        assert upper.centre[1] - upper.height / 2 == pytest.approx(lower.centre[1] + lower.height / 2)
        assert dist(upper.centre[::2], top.centre[::2]) + upper.diameter / 2 <= top.diameter / 2
    assert shade.apex == (stem.centre[0], 3.5, stem.centre[2])  # where it was typed, though it stood elsewhere
    assert glass.glass and shade.glow and spot.position[1] < shade.apex[1] - shade.height  # noqa: PT018


def test_a_snowman_is_built_with_the_pointer_and_the_panel_in_25_actions(tmp_path: Path) -> None:
    built = built_in(25, "snowman", tmp_path)
    assert [each.normal for each in built.planes] == [(0, 1, 0)]
    assert (built.cones[0].colour, built.cylinders[0].colour) == ((255, 128, 0), (0, 200, 200))
    assert_snowman(built, within=0.01)


def test_slimgui_is_imported_when_the_panel_opens_and_without_it_f1_names_the_extra() -> None:
    program = """if True:
        import sys
        from tests.viewer.fake import played
        played("press Tab", "press H")
        assert not any("slimgui" in name or ".panel." in name for name in sys.modules)
        sys.modules["slimgui"] = None
        assert "minirt[panel]" in played("press F1").state.message
        del sys.modules["slimgui"]
        played("press F1")
        assert "slimgui" in sys.modules
    """
    ended = run([sys.executable, "-c", program], text=True)
    assert ended.returncode == 0, ended.stderr


MANY = TEXT + "# arms\nco 0,3,0 0,1,0 1 2 9,9,9\nco 0,5,0 0,1,0 1 2 9,9,9\n\nc 0,3,9 0,-0.2,-0.98 60\n"


def test_rows_select_several_which_are_hidden_and_deleted_together() -> None:
    user = User(parse(MANY, "scene.rt").scene, select=3)
    for name in ("element 6", "element 7"):
        user.memory.press(Key.SHIFT_L)
        user.click(name)
        user.memory.release(Key.SHIFT_L)
    assert (user.state.selected, user.state.others) == (7, {3, 6})
    user.click("shown 6")
    assert user.state.hidden == {3, 6, 7}
    user.click("shown 7")
    assert user.state.hidden == set()
    user.click("shown 1")
    assert user.state.hidden == set()  # a camera is needed
    user.memory.press(Key.CONTROL_L)
    user.click("element 3")
    user.memory.release(Key.CONTROL_L)
    assert user.state.chosen == {6, 7}
    user.press(Key.DELETE)
    assert not user.state.scene.cones
    user.press(Key.CONTROL_L, Key.Z)
    assert dump(user.state.scene) == MANY
    assert user.state.chosen == {6, 7}
    user.click("element 4")
    assert user.state.chosen == {4}


def test_a_click_on_the_name_of_the_selected_row_renames_and_the_history_tells_it() -> None:
    user = User(parse(MANY, "scene.rt").scene, (640, 700), select=3)
    user.click("element 3")
    assert user.panel.types
    for character in "Ball d":
        user.memory.text(character)
    user.press(Key.RETURN)
    assert dump(user.state.scene) == MANY.replace("sp 0,0,0 2 255,0,0", "sp 0,0,0 2 255,0,0 # Ball d")
    user.memory.wait(1)
    user.click("element 3")
    user.memory.text("x")
    user.press(Key.ESCAPE)
    assert len(user.state.undo_stack) == 1
    assert not user.panel.types
    assert step_title(user.state.undo_stack[0], user.state.snapshot) == "sphere 1: name"
    user.press(Key.CONTROL_L, Key.Z)
    assert dump(user.state.scene) == MANY


def test_the_picture_marks_the_element_whose_row_the_pointer_is_on() -> None:
    user = User(parse(MANY, "scene.rt").scene)
    user.memory.motion(*user.place("element 6"))
    user.memory.play()
    assert user.session.screen.pointed == 6
    user.memory.motion(*user.place("shown 4"))
    user.memory.play()
    assert user.session.screen.pointed == 4
    user.memory.motion(10, 10)
    user.memory.play()
    assert user.session.screen.pointed is None


def test_a_double_click_on_a_row_looks_through_a_further_camera_and_brings_others_into_view() -> None:
    user = User(parse(MANY, "scene.rt").scene)
    user.click("element 8")
    user.click("element 8")
    assert user.state.scene.shown == 1
    user.press(Key.ESCAPE)
    user.press(Key.CONTROL_L, Key.Z)
    assert user.state.scene.shown == 0
    for name in ("element 6", "element 7"):  # one that is selected already is not renamed by the first click
        user.memory.wait(1)
        before = user.state.scene.camera
        user.session.state = user.state.select(6)
        place = user.place(name)
        for _ in range(2):
            user.memory.click(*place)
            user.memory.play()
        assert user.state.scene.camera != before
        assert not user.panel.types


@pytest.mark.parametrize(("word", "rows"), [("arms", [6, 7]), ("cone 2", [7]), ("camera 1", [1]), ("sp", [3])])
def test_the_search_finds_names_and_numbers(word: str, rows: list[int]) -> None:
    assert found(word, parse(MANY, "scene.rt").scene) == rows


@pytest.mark.parametrize("scale", [1.0, 1.5, 2.0])
@pytest.mark.parametrize("height", [450, 700, 900])
def test_the_list_shows_the_whole_row_of_the_selected_element_when_the_panel_opens(height: int, scale: float) -> None:
    text = TEXT + "bg 1,2,3\n" + "sp 0,0,0 2 255,0,0\n" * 6
    opened = parse(text, "scene.rt").scene
    last = len(opened.elements) - 1
    user = User(opened, (1600, height), select=last, scale=scale)
    (_, element), (_, group) = (user.widgets.places[name] for name in (f"element {last}", "place group"))
    row = 1.5 * user.panel.size
    assert element + row / 2 < group - 1.5 * row, "the list ends above the title and the values of the element"
