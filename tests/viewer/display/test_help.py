"""Each row of the table does what its help says, with each of its keys on each layout."""

from __future__ import annotations

from collections.abc import Callable
from math import dist
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from minirt.mlx.memory import Memory
from minirt.scene import Camera, describe, dump, load
from minirt.shapes.plane import Plane
from minirt.shapes.sphere import Sphere
from minirt.viewer.app.session import Session
from minirt.viewer.display.overlay import Level
from minirt.viewer.editing.projection import projection_of
from minirt.viewer.editing.state import Frame
from minirt.viewer.input.bindings import BINDINGS, Binding
from tests.viewer.fake import TEXT, played, scene

LAYOUTS = ("qwerty", "azerty", "qwertz")
SPHERE = ("press Tab", "press Tab")  # from the camera over the light
CYLINDER = (*SPHERE, "press Tab", "press Tab")
AT_SPHERE, AT_CYLINDER = "32,24", "40,24"  # pixels of a window of 64x48

Seen = Callable[[Session, Session], bool]  # of the sessions without and with the key


def moved(way: tuple[float, float, float]) -> Seen:
    """The sphere is a step further that way."""

    def seen(before: Session, after: Session) -> bool:
        step = before.state.stride
        there = [at + step * part for at, part in zip(before.state.element.centre, way, strict=True)]
        return after.state.element.centre == pytest.approx(there)

    return seen


def looks(part: int, sign: float) -> Seen:
    """The camera, which looked along -z, looks to one side."""
    return lambda _, after: sign * after.state.scene.camera.direction[part] > 0.05


def sized(sign: float) -> Seen:
    return lambda before, after: sign * (after.state.element.diameter - before.state.element.diameter) > 0.05


def camera(session: Session) -> Camera:
    return session.state.scene.camera


def memory(session: Session) -> Memory:
    backend = session.mlx.backend
    assert isinstance(backend, Memory)
    return backend


def centred(_: Session, after: Session) -> bool:
    """The light is in the middle of the picture."""
    return projection_of(camera(after), 64, 48).pixel((5, 5, 5)) == pytest.approx((32, 24), abs=0.1)


def went_round(before: Session, after: Session) -> bool:
    """The camera is elsewhere, and as far from the sphere as before."""
    here, there = camera(before).position, camera(after).position
    return dist(here, there) > 1 and dist(there, (0, 0, 0)) == pytest.approx(dist(here, (0, 0, 0)))


def slid(before: Session, after: Session) -> bool:
    """The camera is elsewhere, and looks the same way from the same distance."""
    (x, y, z), (a, b, c) = camera(before).position, camera(after).position
    return c == z and dist((x, y), (a, b)) > 1 and camera(after).direction == camera(before).direction


def copied(_: Session, after: Session) -> bool:
    """The scene is in another file, too."""
    path = after.path.with_name("scene-1.rt")
    return path.exists() and path.read_text() == dump(scene())


def screenshot(before: Session, after: Session) -> bool:
    """The picture without what is written over it is in a file."""
    path = after.path.with_name("scene-1.png")
    if not path.exists():
        return False
    with Image.open(path) as picture:
        return np.array_equal(np.asarray(picture), before.picture[..., 2::-1])


# For each action what leads to it, and what is seen of it.
DOES: dict[str, tuple[tuple[str, ...], Seen]] = {
    "select next": ((), lambda _, after: after.state.selected == 2),
    "select previous": (("press Tab",), lambda _, after: after.state.selected == 1),
    "select at pointer": ((), lambda _, after: isinstance(after.state.element, Sphere)),
    "select camera": (SPHERE, lambda _, after: isinstance(after.state.element, Camera)),
    "select light": (SPHERE, lambda _, after: after.state.element.title == "light"),
    "left": (SPHERE, moved((-1, 0, 0))),
    "right": (SPHERE, moved((1, 0, 0))),
    "forward": (SPHERE, moved((0, 0, -1))),
    "back": (SPHERE, moved((0, 0, 1))),
    "down": (SPHERE, moved((0, -1, 0))),
    "up": (SPHERE, moved((0, 1, 0))),
    "turn left": ((), looks(0, -1)),
    "turn right": ((), looks(0, 1)),
    "turn up": ((), looks(1, 1)),
    "turn down": ((), looks(1, -1)),
    "roll left": ((), lambda _, after: camera(after).roll == -5),
    "roll right": ((), lambda _, after: camera(after).roll == 5),
    "next frame": (SPHERE, lambda _, after: after.state.frame is Frame.X),
    "move by hand": ((), lambda _, after: after.state.scene.spheres[0].centre[0] > 1),
    "turn by hand": ((), lambda _, after: after.state.scene.cylinders[0].axis != (0, 1, 0)),
    "orbit": (SPHERE, went_round),
    "pan": ((), slid),
    "grow": (SPHERE, sized(1)),
    "shrink": (SPHERE, sized(-1)),
    "next value": (SPHERE, lambda _, after: after.state.active.name == "colour"),
    "add attribute": (SPHERE, lambda _, after: after.state.element.specular is not None),
    "remove attribute": ((*SPHERE, "press M"), lambda _, after: after.state.element.specular is None),
    "look at": (("press Tab",), centred),
    "reset camera": (("press D", "press Left"), lambda _, after: camera(after) == scene().camera),
    "undo": ((*SPHERE, "press D"), lambda _, after: after.state.scene.items == scene().items),
    "redo": (
        (*SPHERE, "press D", "press Ctrl+Z"),
        lambda before, after: after.state.element.centre[0] > before.state.element.centre[0],
    ),
    "add": ((), lambda _, after: isinstance(after.state.element, Sphere) and len(after.state.scene.spheres) == 2),
    "add previous": (
        ("press N", "press N"),
        lambda before, after: isinstance(before.state.element, Plane) and isinstance(after.state.element, Sphere),
    ),
    "duplicate": (SPHERE, lambda _, after: len(set(after.state.scene.spheres)) == 1 < len(after.state.scene.spheres)),
    "delete": (SPHERE, lambda _, after: not after.state.scene.spheres),
    "save": ((*SPHERE, "press D"), lambda before, after: load(after.path).scene.items == before.state.scene.items),
    "save copy": ((), copied),
    "screenshot": ((), screenshot),
    "reload": ((*SPHERE, "press D"), lambda _, after: after.state.scene.items == scene().items),
    "copy camera": ((), lambda _, after: memory(after).clipboard_text == describe(scene().camera)),
    "toggle HUD": ((), lambda before, after: (before.screen.level, after.screen.level) == (Level.LINE, Level.ALL)),
    "toggle icons": ((), lambda before, after: (before.screen.marks.icons, after.screen.marks.icons) == (False, True)),
    "toggle help": ((), lambda before, after: (before.screen.help, after.screen.help) == (False, True)),
    "toggle full screen": ((), lambda _, after: (after.win.width, after.win.height) == memory(after).screen),
    "quit": ((), lambda _, after: after.state.selected == 1),
}
MOUSE = {
    "left click": (f"click {AT_SPHERE}",),
    "right click": (f"click {AT_SPHERE} right",),
    "left drag": (f"drag {AT_SPHERE} 45,30",),
    "Shift+left drag": ("down Shift", f"drag {AT_CYLINDER} 48,36", "up Shift"),
    "right drag": ("drag 5,5 20,10 right",),
    "middle drag": (f"drag {AT_SPHERE} 45,30 middle",),
    "wheel up": ("wheel up",),
    "wheel down": ("wheel down",),
}


def test_all_rows_are_here() -> None:
    assert set(DOES) == {binding.action for binding in BINDINGS}


@pytest.mark.parametrize("keys", LAYOUTS)
@pytest.mark.parametrize("binding", BINDINGS, ids=lambda binding: binding.action)
def test_a_row_does_what_it_says(binding: Binding, keys: str, tmp_path: Path) -> None:
    way, seen = DOES[binding.action]
    behind = ("press Tab",) if binding.action == "quit" else ()  # nobody listens to it any more
    for number, spelling in enumerate(binding.spellings(keys)):
        path = tmp_path / f"{number}" / "scene.rt"
        path.parent.mkdir()
        path.write_text(TEXT)
        lines = MOUSE.get(spelling, (f"press {spelling}",))
        before = played(*way, *behind, path=path, keys=keys)
        assert not seen(before, before), "it was so before"
        after = played(*way, *lines, *behind, path=path, keys=keys)
        assert seen(before, after), spelling


@pytest.mark.parametrize(("pressed", "steps"), [("press D", 1.0), ("press Shift+D", 0.1)])
def test_shift_makes_a_tenth(pressed: str, steps: float) -> None:
    state = played(*SPHERE, pressed).state
    assert state.element.centre[0] == pytest.approx(steps * state.stride)
