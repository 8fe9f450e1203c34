"""Looking around: the wheel zooms towards what is under the pointer, keys go along the ground, and no file changes."""

from __future__ import annotations

from math import dist, hypot
from pathlib import Path

import pytest

from minirt.fields import Triple
from minirt.rendering.queries.pick import pick
from minirt.scene import Scene
from minirt.scene.elements import linear_combination
from minirt.viewer.app.mouse import Mouse
from minirt.viewer.app.session import Session
from minirt.viewer.editing.motion import APPROACH
from minirt.viewer.editing.projection import projection_of
from minirt.viewer.files import contents_differ
from tests.viewer.fake import TEXT, FakeRenderer, played, scene

WIDTH, HEIGHT = 64, 48
SKY = "sp 0,0,0 9000 9,9,9\n"  # around everything
SELECTED = (("press Tab",), ("click 33,23",), ("click 10,40",), ("press C",))
PLACES = ((33, 23), (40, 24), (10, 40), (60, 45))
BACK = 1 / (1 - APPROACH)
TILTED = TEXT.replace("C 0,0,10 0,0,-1 90", "C 0,4,10 0.2,-0.3,-1 90")


def seen(at: tuple[int, int], text: str = TEXT) -> Triple:
    """The point of the scene at a pixel."""
    _, point = pick(scene(text), WIDTH, HEIGHT, *at)
    assert point
    return point


def camera_of(session: Session) -> Triple:
    position: Triple = session.state.scene.camera.position
    return position


@pytest.mark.parametrize(("at", "selection"), [*((at, ()) for at in PLACES), *((PLACES[0], each) for each in SELECTED)])
@pytest.mark.parametrize(
    ("wheel", "left"), [("up 1", 1 - APPROACH), ("up 5", (1 - APPROACH) ** 5), ("down 2", BACK**2)]
)
def test_the_wheel_zooms_towards_what_is_under_the_pointer(
    wheel: str, left: float, at: tuple[int, int], selection: tuple[str, ...]
) -> None:
    """Whatever is selected: the point stays at its pixel, its distance is so much of what it was, all else stays."""
    point, before = seen(at), played(*selection)
    after = played(*selection, f"wheel {wheel} {at[0]},{at[1]}")
    assert dist(camera_of(after), point) == pytest.approx(left * dist(camera_of(before), point), rel=1e-5)
    pixel = projection_of(after.state.scene.camera, WIDTH, HEIGHT).pixel(point)
    assert pixel == pytest.approx((at[0] + 0.5, at[1] + 0.5), abs=1e-3)
    assert others(after.state.scene) == others(scene())
    assert after.state.selected == before.state.selected
    assert len(after.state.undo_stack) == len(before.state.undo_stack) + 1


def others(scene: Scene) -> list[object]:
    """All entries of a scene but the camera."""
    return [each for each in scene.items if each is not scene.camera]


@pytest.mark.parametrize("text", [TEXT, TEXT + SKY])
def test_over_the_sky_it_zooms_by_the_distance_to_the_scene(text: str) -> None:
    session = played("wheel up 1 5,3", text=text)
    way = [b - a for a, b in zip(scene().camera.position, camera_of(session), strict=True)]
    ray = projection_of(scene().camera, WIDTH, HEIGHT).ray(5.5, 3.5)
    assert way == pytest.approx(linear_combination(1.0, ray, 0.0, ray), abs=1e-5)  # a tenth of the way to the middle
    assert session.state.scene.camera.direction == scene().camera.direction


def test_it_never_goes_through_a_surface_and_leads_back() -> None:
    near = played("wheel up 60 33,23")
    assert 0 < dist(camera_of(near), seen((33, 23))) < 0.02
    assert hypot(*camera_of(near)) > 1
    there_and_back = played("wheel up 4 40,24", "wheel down 4 40,24")
    assert camera_of(there_and_back) == pytest.approx(scene().camera.position, abs=1e-4)


def test_steps_that_follow_each_other_look_once_for_what_is_there(monkeypatch: pytest.MonkeyPatch) -> None:
    asked: list[tuple[int, ...]] = []

    def counted(scene: Scene, *pixel: int) -> object:
        asked.append(pixel[2:])
        return pick(scene, *pixel)

    monkeypatch.setattr(FakeRenderer, "pick", staticmethod(counted))
    played("wheel up 3 33,23", "wheel down 2 33,23", "wheel up 1 34,23", "press d", "wheel up 2 34,23")
    assert asked == [(33, 23), (34, 23), (34, 23)]


LOOKING = (
    "drag 5,3 20,12",
    "wheel up 3 33,23",
    "wheel down 7 5,3",
    "press Tab",
    "wheel up 2 10,40",
    "drag 40,24 22,16 right",
    "drag 33,23 45,15 middle",
    "press C",
    "hold w 0.4",
    "press e",
    "press Left",
    "press F",
)


ENDS = {
    "quit": ["press Escape"],
    "home": ["press Home", "press Ctrl+S"],
    "undo": [*["press Ctrl+Z"] * len(LOOKING), "press Ctrl+S"],
}


@pytest.mark.parametrize("end", ENDS)
def test_looking_around_leaves_every_byte_of_the_file(end: str, tmp_path: Path) -> None:
    path = tmp_path / "scene.rt"
    path.write_text(TEXT)
    played(*LOOKING, *ENDS[end], path=path)
    assert path.read_text() == TEXT
    assert list(tmp_path.iterdir()) == [path]


def test_after_looking_around_nothing_is_unsaved_and_a_view_that_is_saved_changes_the_camera_alone(path: Path) -> None:
    session = played(*LOOKING, path=path)
    assert not contents_differ(session.state.scene, session.saved)
    assert session.state.scene.camera.edited == ()
    played(*LOOKING, "press Ctrl+S", path=path)
    changed = [
        (old.split(), new.split())
        for old, new in zip(TEXT.splitlines(), path.read_text().splitlines(), strict=True)
        if old != new
    ]
    ((old, new),) = changed
    assert (old[0], old[3:]) == (new[0], new[3:]) == ("C", ["90", "#", "looks", "along", "-z"])


@pytest.mark.parametrize("selection", [(), ("press Tab", "press Tab")])
@pytest.mark.parametrize("roll", ["", " roll:30"])
def test_keys_move_along_the_vertical_and_the_ground(roll: str, selection: tuple[str, ...]) -> None:
    """The camera and a sphere, as seen by a camera that looks down to the right."""
    text = TILTED.replace(" 90 ", f" 90{roll} ")
    start = played(*selection, text=text).state
    step, level = start.stride, (0.2**2 + 1) ** 0.5
    ways = {"e": (0, 1, 0), "q": (0, -1, 0), "w": (0.2 / level, 0, -1 / level), "d": (1 / level, 0, 0.2 / level)}
    ways |= {"s": linear_combination(-1, ways["w"], 0, ways["w"]), "a": linear_combination(-1, ways["d"], 0, ways["d"])}
    for key, way in ways.items():
        (before, after) = (
            place(each) for each in (start.element, played(*selection, f"press {key}", text=text).state.element)
        )
        assert after == pytest.approx(linear_combination(1.0, before, step, way), abs=1e-5)
        assert [a == b for a, b in zip(before, after, strict=True)] == [part == 0 for part in way]


def place(element: object) -> Triple:
    found: Triple = getattr(element, "position", None) or element.centre  # type: ignore[attr-defined]
    return found


@pytest.mark.parametrize(
    ("direction", "forward"), [("0,-1,0", (0, 0, -1)), ("0,1,0", (0, 0, -1)), ("0.3,-1,0", (1, 0, 0))]
)
def test_forward_is_along_the_ground_where_the_camera_looks_straight_up_or_down(
    direction: str, forward: Triple
) -> None:
    text = TEXT.replace("C 0,0,10 0,0,-1", f"C 0,0,10 {direction}")
    start, after = (played(*keys, text=text).state for keys in ((), ("press w",)))
    assert after.element.position == pytest.approx(linear_combination(1, start.element.position, start.stride, forward))


def test_beside_the_panel_the_middle_is_that_of_the_picture_which_is_shown() -> None:
    session = played(size=(640, 480))
    session.screen.covered = 320
    middle = Mouse(session, lambda _: None).pivot(None, None)
    assert middle is not None
    x, y, z = middle
    assert hypot(x, y) < 0.1  # in front of the ball around the origin, and not at the edge of the picture
    assert z == pytest.approx(1, abs=0.01)
