"""What the keys do that is not an edit of the scene: files, pictures, the window."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import TYPE_CHECKING

from minirt.scene import describe, load, save
from minirt.viewer.files import save_copy
from minirt.viewer.state import Moment, opened

if TYPE_CHECKING:
    from minirt.viewer.session import Session


def save_scene(session: Session) -> None:
    """Write the scene into its file. SceneError."""
    save(session.state.scene, session.path)
    session.saved = session.state.scene
    session.state = session.state.say(f"saved: {session.path}")


def save_a_copy(session: Session) -> None:
    """Write the scene into a new file. SceneError."""
    session.state = session.state.say(f"saved a copy: {save_copy(session.state.scene, session.path)}")


def screenshot(session: Session) -> None:
    """Save the picture, as soon as it is complete. RenderError."""
    session.wants_screenshot = True
    session.take_screenshot()


def reload(session: Session) -> None:
    """Read the file again; what was there before can be had back by undo. SceneError."""
    scene = load(session.path, session.lenient).scene
    old, new = session.state, opened(scene)
    same = old.selected < len(scene.elements) and type(scene.elements[old.selected]) is type(old.element)
    session.state = replace(
        new,
        selected=old.selected if same else new.selected,
        frame=old.frame,
        past=(*old.past, Moment(old.scene, old.selected)),
        message=f"read again: {session.path}",
    )
    session.saved = scene


def copy_camera(session: Session) -> None:
    """Put the camera's line on the clipboard."""
    line = describe(session.state.scene.camera)
    session.m.mlx_set_clipboard(session.win, line)
    session.state = session.state.say(f"copied: {line}")


def toggle_hud(session: Session) -> None:
    session.screen.hud = not session.screen.hud


def toggle_help(session: Session) -> None:
    session.screen.help = not session.screen.help


def toggle_full_screen(session: Session) -> None:
    session.full_screen = not session.full_screen
    session.m.mlx_set_fullscreen(session.win, session.full_screen)


def quit(session: Session) -> None:
    session.quit()


COMMANDS: dict[str, Callable[[Session], None]] = {
    "save": save_scene,
    "save copy": save_a_copy,
    "screenshot": screenshot,
    "reload": reload,
    "copy camera": copy_camera,
    "toggle HUD": toggle_hud,
    "toggle help": toggle_help,
    "toggle full screen": toggle_full_screen,
    "quit": quit,
}
