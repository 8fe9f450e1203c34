"""What the keys do that is not an edit of the scene: files, pictures, the window."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from minirt.scene import describe
from minirt.viewer.app.file_sync import reload, save_scene
from minirt.viewer.display.overlay import Level
from minirt.viewer.files.scene_files import save_copy

if TYPE_CHECKING:
    from minirt.viewer.app.session import Session


def save_a_copy(session: Session) -> None:
    """Write the scene into a new file. SceneError."""
    session.state = session.state.with_message(f"saved a copy: {save_copy(session.state.scene, session.path)}")


def screenshot(session: Session) -> None:
    """Save the picture, as soon as it is complete. RenderError."""
    session.wants_screenshot = True
    session.take_screenshot()


def copy_camera(session: Session) -> None:
    """Put the camera's line on the clipboard."""
    line = describe(session.state.scene.camera)
    session.m.mlx_set_clipboard(session.win, line)
    session.state = session.state.with_message(f"copied: {line}")


def toggle_hud(session: Session) -> None:
    session.screen.level = Level((session.screen.level + 1) % len(Level))


def toggle_icons(session: Session) -> None:
    session.screen.marks.icons = not session.screen.marks.icons


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
    "toggle icons": toggle_icons,
    "toggle help": toggle_help,
    "toggle full screen": toggle_full_screen,
    "quit": quit,
}
