"""File sync: save, reload and follow the scene's file without loss of work when other programs write it too."""

from __future__ import annotations

from contextlib import suppress
from dataclasses import replace
from pathlib import Path

from minirt.errors import SceneError
from minirt.scene import Scene, load, save
from minirt.scene.files import check_name
from minirt.viewer.app.session import Session
from minirt.viewer.editing.history import stack_after_reading
from minirt.viewer.editing.state import State, initial_state
from minirt.viewer.files.scene_files import back_up, contents_differ, error_summary, save_recovery
from minirt.viewer.files.watched_file import WatchedFile, signature
from minirt.viewer.input.chords import platform_spelling

DELETED = "{} was deleted by another program: {} writes it again"
UNSAVED = "{} was changed by another program: {} reads it, {} saves yours and keeps the other as a copy"


def save_scene(session: Session) -> None:
    """Write the scene to its file; if another program has changed the file, copy it first. SceneError."""
    check_name(session.path)
    copy = back_up(session.path) if session.file.changed else None
    linked = has_other_links(session.path)
    save(session.state.scene, session.path)
    session.file.accept(signature(session.path))
    session.saved = session.state.scene
    session.screen.banner = ""
    session.found_changes = None
    kept = f"; what another program had written is in {copy}" if copy else ""
    cut = "; its other hard links keep the old scene" if linked else ""
    session.state = session.state.with_message(f"saved: {session.path}{kept}{cut}")


def has_other_links(path: Path) -> bool:
    """Whether a file has more than one name, of which saving replaces one."""
    with suppress(OSError):
        return path.stat().st_nlink > 1
    return False


def reload(session: Session) -> None:
    """Read the file again; undo restores the previous scene. SceneError."""
    read_file(session)
    session.state = session.state.with_message(f"read again: {session.path}")


def follow_change(session: Session) -> None:
    """Show the file after another program has written it, unless the session has unsaved changes.

    If the file has errors or is gone, the last picture stays and a banner says so.
    """
    if session.file.missing:
        session.screen.banner = DELETED.format(session.path.name, platform_spelling("Ctrl+S"))
        return
    if contents_differ(session.state.scene, session.saved):
        session.screen.banner = UNSAVED.format(
            session.path.name, platform_spelling("Ctrl+R"), platform_spelling("Ctrl+S")
        )
        return
    try:
        read_file(session, keep_camera=True)
    except SceneError as error:
        session.screen.banner = error_summary(error)


def read_file(session: Session, keep_camera: bool = False) -> None:
    """Show the scene in the file. `keep_camera`: keep the current camera unless the file changed it. SceneError."""
    seen = signature(session.path)
    scene = load(session.path, session.lenient, session.state.scene.camera.left_handed).scene
    session.file.accept(seen)
    session.release_button()
    session.state = state_after_reading(session.state, scene, session.saved if keep_camera else None)
    session.saved = scene
    session.screen.banner = ""
    session.has_unused_memory = True


def state_after_reading(old: State, scene: Scene, saved: Scene | None) -> State:
    """Return the state for the new scene of the file, with selection and undo history of the old state.

    The current camera stays if the file has the same camera as `saved`, the scene that the file held before.
    """
    new = initial_state(scene)
    if saved and scene.camera == saved.camera:
        new = replace(new, scene=scene.replace(scene.camera, old.scene.camera.replace(source=scene.camera.source)))
    same = old.selected < len(scene.elements) and type(scene.elements[old.selected]) is type(old.element)
    return replace(
        new,
        selected=old.selected if same else new.selected,
        value_index=old.value_index if same else 0,
        frame=old.frame,
        undo_stack=stack_after_reading(old),
    )


def open_another(session: Session, path: Path) -> None:
    """Show another file; write unsaved changes to a recovery file beside the old one. SceneError."""
    scene = load(path, session.lenient, session.state.scene.camera.left_handed).scene
    kept = ""
    if contents_differ(session.state.scene, session.saved):
        kept = f"; the changes that were not saved are in {save_recovery(session.state.scene, session.path)}"
    session.file.close()
    session.release_button()
    session.path, session.file = path, WatchedFile(path)
    session.watch_file()
    session.mlx.mlx_set_window_title(session.window, f"miniRT - {path.name}")
    session.saved = scene
    session.screen.banner = ""
    session.has_unused_memory = True
    session.state = initial_state(scene).with_message(f"opened: {path}{kept}")
