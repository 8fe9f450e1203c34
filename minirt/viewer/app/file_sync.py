"""Reading and writing the scene's file while other programs may do the same: nobody's work is lost."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from minirt.errors import SceneError
from minirt.scene import Scene, load, save
from minirt.viewer.editing.state import MAX_UNDO, Snapshot, State, initial_state
from minirt.viewer.files.scene_files import differ, keep, recover, summary
from minirt.viewer.files.watched_file import WatchedFile, signature
from minirt.viewer.input.chords import platform_spelling

if TYPE_CHECKING:
    from minirt.viewer.app.session import Session

UNSAVED = "{} was changed by another program: {} reads it, {} saves yours and keeps the other as a copy"


def save_scene(session: Session) -> None:
    """Write the scene into its file; what another program wrote there goes into a copy. SceneError."""
    other = keep(session.path) if session.disk.changed else None
    save(session.state.scene, session.path)
    session.disk.accept(signature(session.path))
    session.saved = session.state.scene
    session.screen.banner = ""
    kept = f"; what another program had written is in {other}" if other else ""
    session.state = session.state.with_message(f"saved: {session.path}{kept}")


def reload(session: Session) -> None:
    """Read the file again; what was there before can be had back by undo. SceneError."""
    read(session)
    session.state = session.state.with_message(f"read again: {session.path}")


def file_changed(session: Session) -> None:
    """Another program wrote the file: it is shown, unless something was changed here and not saved.

    While the file is wrong the last picture stays.
    """
    if differ(session.state.scene, session.saved):
        session.screen.banner = UNSAVED.format(
            session.path.name, platform_spelling("Ctrl+R"), platform_spelling("Ctrl+S")
        )
        return
    try:
        read(session, keep_camera=True)
    except SceneError as error:
        session.screen.banner = summary(error)


def read(session: Session, keep_camera: bool = False) -> None:
    """Show what the file holds. `keep_camera`: unless the file has another one than before. SceneError."""
    seen = signature(session.path)
    scene = load(session.path, session.lenient, session.state.scene.camera.left_handed).scene
    session.disk.accept(seen)
    session.mouse.let_go()
    session.state = followed(session.state, scene, session.saved if keep_camera else None)
    session.saved = scene
    session.screen.banner = ""


def followed(old: State, scene: Scene, saved: Scene | None) -> State:
    """The state after its file became another scene; with the camera as it is where the file has that of `saved`."""
    new = initial_state(scene)
    if saved and scene.camera == saved.camera:
        new = replace(new, scene=scene.replace(scene.camera, old.scene.camera.replace(source=scene.camera.source)))
    same = old.selected < len(scene.elements) and type(scene.elements[old.selected]) is type(old.element)
    return replace(
        new,
        selected=old.selected if same else new.selected,
        value_index=old.value_index if same else 0,
        frame=old.frame,
        undo_stack=(*old.undo_stack[1 - MAX_UNDO :], Snapshot(old.scene, old.selected)),
    )


def open_another(session: Session, path: Path) -> None:
    """Show another file; changes that were not saved are kept beside the old one. SceneError."""
    scene = load(path, session.lenient, session.state.scene.camera.left_handed).scene
    kept = ""
    if differ(session.state.scene, session.saved):
        kept = f"; the changes that were not saved are in {recover(session.state.scene, session.path)}"
    session.disk.close()
    session.mouse.let_go()
    session.path, session.disk = path, WatchedFile(path)
    session.watch()
    session.m.mlx_set_window_title(session.win, f"miniRT - {path.name}")
    session.saved = scene
    session.screen.banner = ""
    session.state = initial_state(scene).with_message(f"opened: {path}{kept}")
