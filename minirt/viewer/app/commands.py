"""Commands: key bindings that do not edit the scene, but deal with files, pictures and the window."""

from __future__ import annotations

from collections.abc import Callable

from minirt.scene import describe
from minirt.viewer.app import file_sync, recovery
from minirt.viewer.app.file_sync import save_scene
from minirt.viewer.app.session import Session
from minirt.viewer.display.overlay import HudLevel
from minirt.viewer.files.scene_files import save_copy


def save_a_copy(session: Session) -> None:
    """Write the scene to a new file. SceneError."""
    session.state = session.state.with_message(f"saved a copy: {save_copy(session.state.scene, session.path)}")


def reload(session: Session) -> None:
    """Take the unsaved changes of an earlier run where there are some, read the file again otherwise. SceneError."""
    if session.found_changes:
        recovery.take(session)
    else:
        file_sync.reload(session)


def screenshot(session: Session) -> None:
    """Save the picture as soon as it is complete. RenderError."""
    session.screenshot_pending = True
    session.take_screenshot()


def copy_camera(session: Session) -> None:
    """Copy the camera's line of the scene to the clipboard."""
    line = describe(session.state.scene.camera)
    session.mlx.mlx_set_clipboard(session.window, line)
    session.state = session.state.with_message(f"copied: {line}")


def toggle_hud(session: Session) -> None:
    """Show the next amount of information: a line, all, nothing."""
    session.screen.level = HudLevel((session.screen.level + 1) % len(HudLevel))


def toggle_icons(session: Session) -> None:
    """Show or hide the icons of lights."""
    session.screen.marks.icons = not session.screen.marks.icons


def toggle_help(session: Session) -> None:
    """Show or hide the table of keys."""
    session.screen.help = not session.screen.help


def toggle_full_screen(session: Session) -> None:
    """Let the window fill the screen, or give it its former size."""
    session.full_screen = not session.full_screen
    session.mlx.mlx_set_fullscreen(session.window, session.full_screen)


def quit(session: Session) -> None:
    """End the session."""
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
