"""Commands: key bindings that do not edit the scene, but deal with files, pictures and the window."""

from __future__ import annotations

from collections.abc import Callable

from minirt.rendering.queries.pick import surface_point
from minirt.scene import describe
from minirt.viewer.app import file_sync, recovery
from minirt.viewer.app.file_sync import save_scene
from minirt.viewer.app.session import Session
from minirt.viewer.display.overlay import HudLevel
from minirt.viewer.editing import framing
from minirt.viewer.files.scene_files import save_copy

TEXT_SCALES = (0.5, 4.0)  # least and largest
TEXT_STEP = 2**0.25  # factor of a key press


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


def focus(session: Session) -> None:
    """Focus the camera's lens on the shape under the pointer. RenderError where nothing can be picked."""
    state, window, at = session.state, session.window, session.pointer
    camera = state.scene.camera
    shape = session.pick(state.scene, window.width, window.height, *at)
    point = surface_point(shape, camera, window.width, window.height, *at) if shape else None
    session.state = framing.focus(state, point, session.now)


def toggle_hud(session: Session) -> None:
    """Show the next amount of information: a line, all, nothing."""
    session.screen.level = HudLevel((session.screen.level + 1) % len(HudLevel))


def toggle_icons(session: Session) -> None:
    """Show or hide the icons of lights."""
    session.screen.marks.icons = not session.screen.marks.icons


def toggle_help(session: Session) -> None:
    """Show the table of keys, its next page, or after the last page the picture."""
    session.screen.turn_help_page()


def scale_text(factor: float) -> Callable[[Session], None]:
    """Return a command that makes the text larger or smaller."""

    def command(session: Session) -> None:
        screen = session.screen
        screen.text_scale = min(max(screen.text_scale * factor, TEXT_SCALES[0]), TEXT_SCALES[-1])
        session.state = session.state.with_message(f"text: {screen.text_scale:.0%}")

    return command


def reset_text(session: Session) -> None:
    """Give the text its usual size."""
    session.screen.text_scale = 1.0
    session.state = session.state.with_message("text: 100%")


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
    "focus": focus,
    "toggle HUD": toggle_hud,
    "toggle icons": toggle_icons,
    "toggle help": toggle_help,
    "larger text": scale_text(TEXT_STEP),
    "smaller text": scale_text(1 / TEXT_STEP),
    "usual text": reset_text,
    "toggle full screen": toggle_full_screen,
    "quit": quit,
}
