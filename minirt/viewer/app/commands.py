"""Commands: key bindings that do not edit the scene, but deal with files, pictures and the window.

Files are saved, read again and followed without loss of work when other programs write them, too.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from pathlib import Path

from minirt.errors import SceneError, hint, nearest
from minirt.helpers import file_io
from minirt.scene import describe, dump, load, parse
from minirt.scene.files import MAX_BYTES, SUFFIX, check_name
from minirt.scene.parser import load_for_window
from minirt.viewer import files
from minirt.viewer.app.explaining import explain_pixel, show_next_view
from minirt.viewer.app.session import Session
from minirt.viewer.bindings import platform_spelling as named
from minirt.viewer.display.overlay import HudLevel
from minirt.viewer.editing import motion
from minirt.viewer.editing.state import initial_state, state_after_reading, with_edited_cameras
from minirt.viewer.files import contents_differ, differs_by_view
from minirt.viewer.recovery import FoundChanges, find_changes

TEXT_SCALES = (0.5, 4.0)  # least and largest
TEXT_STEP = 2**0.25  # factor of a key press
DELETED = "{} was deleted by another program: {} writes it again"
MOST_LINES = 20_000  # of files whose versions are merged
MERGED = "{} was changed by another program; its changes and yours are in other lines, and both are here"
TRANSLATED = "{} is in the dialect of another program, and is read as --lenient does"
FOREIGN = "{} is in the dialect of another program: {} again writes it in this format, {} writes a copy"
UNSAVED = "{} was changed by another program: {} reads it, {} saves yours and keeps the other as a copy"


def save_a_copy(session: Session) -> None:
    """Write the scene to a new file. FileError."""
    copy = files.create_numbered(session.path, SUFFIX, dump(session.state.scene).encode())
    session.say(f"saved a copy: {copy}")


def reload(session: Session) -> None:
    """Take the unsaved changes of an earlier run where there are some, read the file again otherwise. SceneError."""
    if session.found_changes:
        take_found(session, session.found_changes)
    else:
        read_file(session)  # undo restores the previous scene
        session.say(f"read again: {session.path}")


def screenshot(session: Session) -> None:
    """Save the picture as soon as it is complete. FileError."""
    session.screenshot_pending = True
    session.take_screenshot()


def copy_camera(session: Session) -> None:
    line = describe(session.state.scene.camera)
    session.mlx.mlx_set_clipboard(session.window, line)
    session.say(f"copied: {line}")


def focus(session: Session) -> None:
    """Focus the camera's lens on the shape under the pointer. RenderError where nothing can be picked."""
    _, point = session.surface_at(*session.pointer)
    session.state = motion.focus(session.state, point, session.now)


def toggle(session: Session, name: str) -> None:
    """Show or hide the icons of all lights, or the handles of the selected element."""
    setattr(session.screen, name, not getattr(session.screen, name))


def toggle_hud(session: Session) -> None:
    """Show the next amount of information: a line, all, nothing."""
    session.screen.level = HudLevel((session.screen.level + 1) % len(HudLevel))


def scale_text(session: Session, factor: float) -> None:
    """Make the text larger or smaller; 0 gives it its usual size."""
    screen = session.screen
    screen.text_scale = min(max(screen.text_scale * factor, TEXT_SCALES[0]), TEXT_SCALES[-1]) if factor else 1.0
    session.say(f"text: {screen.text_scale:.0%}")


def toggle_full_screen(session: Session) -> None:
    session.full_screen = not session.full_screen
    session.mlx.mlx_set_fullscreen(session.window, session.full_screen)


def save_scene(session: Session) -> None:
    """Write the scene to its file; what another program has written there is first copied to a new file.

    For a file in another program's dialect, show a banner with a question instead, and write when asked again. Raises
    SceneError for a name that is no scene file's, FileError.
    """
    check_name(session.path)
    question = FOREIGN.format(session.path.name, named("Ctrl+S"), named("Ctrl+Shift+S"))
    if session.lenient and session.screen.banner != question and files.is_translated(session.saved, session.path):
        session.screen.banner = question
        return
    file, is_changed = session.path, session.file.changed
    copy = files.create_numbered(file, SUFFIX, file_io.read(file, MAX_BYTES)) if is_changed else None
    session.state.scene.save(session.path)
    session.file.accept(file_io.stamps(session.path))
    session.saved, session.lenient = session.state.scene, False
    session.screen.banner, session.title_made_from = "", ()  # (): a file that was new is there now
    session.found_changes = None
    kept = f"; what another program had written is in {copy}" if copy else ""
    session.say(f"saved: {session.path}{kept}")


def follow_change(session: Session) -> None:
    """Show the file after another program has changed it, with the unsaved changes of the session if there are some.

    If the file has errors or is gone, or cannot be merged with these changes, the picture stays and a banner says so.
    """
    if session.file.missing:
        session.screen.banner = DELETED.format(session.path.name, named("Ctrl+S"))
        return
    unsaved = contents_differ(session.state.scene, session.saved)
    try:
        if not unsaved:
            read_file(session, keep_camera=True)
        elif merge_file(session):
            session.say(MERGED.format(session.path.name))
        else:
            session.screen.banner = UNSAVED.format(session.path.name, named("Ctrl+R"), named("Ctrl+S"))
    except SceneError as error:
        session.screen.banner = files.error_summary(error)


def merge_file(session: Session) -> bool:
    """Show the scene with the changes of another program in its file and those of the session.

    Returns False, and nothing changes, if both changed the same line or a version has more than MOST_LINES. SceneError
    if the file cannot be read. Cameras go on looking where they look now, unless the file changed that.
    """
    stamps, saved = file_io.stamps(session.path), session.saved  # stamps first: the file may change while it is read
    left_handed = session.state.scene.camera.left_handed
    theirs = load(session.path, session.lenient, left_handed).scene
    mine = session.state.scene
    for camera, before in zip(mine.cameras, saved.cameras, strict=False):
        if differs_by_view(camera, before):  # which is nothing to save
            mine = mine.replace(camera, before)
    texts = [dump(each).split("\n") for each in (saved, mine, theirs)]
    lines = files.merged(*texts) if max(map(len, texts)) <= MOST_LINES else None
    if lines is None:
        return False
    both = parse("\n".join(lines), session.path).scene
    both = both.mirrored() if left_handed else both  # no line says so
    both = with_edited_cameras(theirs, both, also_view=True)
    session.file.accept(stamps)
    session.show_file(state_after_reading(session.state, both, saved), theirs)
    return True


def read_file(session: Session, keep_camera: bool = False) -> None:
    """Show the scene in the file. `keep_camera`: keep the current camera unless the file changed it. SceneError."""
    seen = file_io.stamps(session.path)
    scene = load(session.path, session.lenient, session.state.scene.camera.left_handed).scene
    session.file.accept(seen)
    session.show_file(state_after_reading(session.state, scene, session.saved if keep_camera else None), scene)


def open_another(session: Session, path: Path) -> None:
    """Show another file; write unsaved changes to a recovery file beside the old one. SceneError, FileError."""
    left_handed = session.state.scene.camera.left_handed
    (scene, _), error = load_for_window(path, session.lenient, left_handed, new=True)
    session.lenient = session.lenient or error is not None
    kept = ""
    if contents_differ(session.state.scene, session.saved):
        kept = f"; the changes that were not saved are in {files.save_recovery(session.state.scene, session.path)}"
    session.file.close()
    session.watch_file(path)
    session.show_file(initial_state(scene).with_message(f"opened: {path}{kept}"), scene)
    tell_dialect(session)


def tell_dialect(session: Session) -> None:
    """Say that the scene was translated from the dialect of another program, if it was."""
    if session.lenient and files.is_translated(session.saved, session.path):
        before = f"{session.state.message}\n" if session.state.message else ""
        session.say(before + TRANSLATED.format(session.path.name))


def tell_new(session: Session) -> None:
    """Say that the file of a new scene is not there yet, and which file beside it may be meant, if one has a like name.

    An example is no such scene: it was read from a file of its own.
    """
    path = session.path
    if session.saved.file == path and not session.file.known:
        others = nearest(path.stem, [each.stem for each in path.parent.glob(f"*{SUFFIX}")])
        meant = hint("".join(f"{each}{SUFFIX}" for each in others))
        session.say(f"a new scene: {named('Ctrl+S')} writes {path.name}{meant}")


def offer_found(session: Session) -> None:
    """Say that there are unsaved changes of the scene's file from an earlier run, if there are."""
    session.found_changes = find_changes(session.path)
    if session.found_changes:
        session.screen.banner = f"{session.found_changes.title} found: {named('Ctrl+R')} takes them"


def take_found(session: Session, found: FoundChanges) -> None:
    """Show the scene with the unsaved changes that were found, as an edit. SceneError where they cannot be read."""
    session.found_changes, session.screen.banner = None, ""
    scene = parse(found.text, session.path).scene
    if session.state.scene.camera.left_handed:
        scene = scene.mirrored()
    scene = with_edited_cameras(session.saved, scene, also_view=True)
    session.show_file(state_after_reading(session.state, scene, None), session.saved)
    session.say(f"{found.title}: {named('Ctrl+S')} saves them, {named('Ctrl+Z')} takes them back")
    if session.recovery and not found.beside:
        session.recovery.adopt(found.path)


COMMANDS: dict[str, Callable[[Session], None]] = {
    "save": save_scene,
    "save copy": save_a_copy,
    "screenshot": screenshot,
    "reload": reload,
    "copy camera": copy_camera,
    "focus": focus,
    "explain pixel": explain_pixel,
    "next view": show_next_view,
    "toggle HUD": toggle_hud,
    "toggle icons": partial(toggle, name="icons"),
    "toggle handles": partial(toggle, name="handles"),
    "toggle help": lambda session: session.screen.turn_help(0),
    "larger text": partial(scale_text, factor=TEXT_STEP),
    "smaller text": partial(scale_text, factor=1 / TEXT_STEP),
    "usual text": partial(scale_text, factor=0.0),
    "toggle full screen": toggle_full_screen,
    "quit": Session.quit,
}
