"""Recovery in a session: keep unsaved changes on disk, and offer those of a run that was killed."""

from __future__ import annotations

from contextlib import suppress
from pathlib import Path

from minirt.scene import parse
from minirt.viewer.app.session import Session
from minirt.viewer.bindings import platform_spelling
from minirt.viewer.editing.state import state_after_reading
from minirt.viewer.files import contents_differ, save_recovery
from minirt.viewer.recovery.found_changes import find_changes
from minirt.viewer.recovery.journal import Journal


def begin(session: Session) -> None:
    """Keep the session's unsaved changes on disk from now on, and offer those that an earlier run left."""
    session.journal = Journal()
    offer(session)


def offer(session: Session) -> None:
    """Say that there are unsaved changes of the scene's file from an earlier run, if there are."""
    session.found_changes = find_changes(session.path)
    if session.found_changes:
        session.screen.banner = f"{session.found_changes.title} found: {platform_spelling('Ctrl+R')} takes them"


def take(session: Session) -> None:
    """Show the scene with the unsaved changes that were found, as an edit. SceneError where they cannot be read."""
    found, session.found_changes, session.screen.banner = session.found_changes, None, ""
    if found:
        scene = parse(found.text, session.path, session.lenient).scene
        if session.state.scene.camera.left_handed:
            scene = scene.replace(scene.camera, left_handed=True)
        session.release_button()
        session.state = state_after_reading(session.state, scene, None).with_message(
            f"{found.title}: {platform_spelling('Ctrl+S')} saves them, {platform_spelling('Ctrl+Z')} takes them back"
        )
        if found.is_journal and session.journal:
            session.journal.replace(found.path)


def end(session: Session) -> Path | None:
    """Write unsaved changes to a recovery file; return its path. The journal stays where that fails: SceneError."""
    saved = False
    try:
        copy = None
        if contents_differ(session.state.scene, session.saved):
            copy = save_recovery(session.state.scene, session.path)
        saved = True
        return copy
    finally:
        if session.journal:
            session.journal.close(delete=saved)


def end_at_once(session: Session) -> None:
    """Write unsaved changes to a recovery file, and say so; errors end nothing."""
    with suppress(Exception):
        tell(end(session))


def tell(copy: Path | None) -> None:
    """Say where unsaved changes are."""
    if copy:
        with suppress(OSError):  # standard output may be closed
            print(f"The changes that were not saved are in {copy}", flush=True)
