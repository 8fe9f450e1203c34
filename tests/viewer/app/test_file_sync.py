"""No work is lost when another program writes the scene's file, or when this one is killed."""

from __future__ import annotations

import os

import pytest

from minirt.errors import RenderError, SceneError
from minirt.scene import dump, load, parse
from minirt.viewer.app import desktop
from minirt.viewer.app.commands import offer_found, open_another, save_scene, tell_new
from minirt.viewer.app.desktop import end_recovery, lose_window
from minirt.viewer.files import WatchedFile, contents_differ, merged
from minirt.viewer.recovery import Recovery, state_folder
from tests.viewer.fake import TEXT, colour_of, scene, write
from tests.viewer.session_harness import SessionHarness

OTHER = TEXT.replace("sp 0,0,0 2", "sp 0,0,0 7")
BROKEN = TEXT.replace("sp 0,0,0 2", "sp 0,0,0 -7")
SAVE, UNDO = "press Ctrl+S", "press Ctrl+Z"


@pytest.fixture
def path(path, monkeypatch):
    """An old scene file, and a folder of their own for unsaved changes."""
    monkeypatch.setenv("XDG_STATE_HOME", str(path.parent / "state"))
    os.utime(path, (1000, 1000))
    return path


def opened(path) -> SessionHarness:
    """Open the scene as the program does."""
    harness = SessionHarness()
    harness.session.path, harness.session.file = path, WatchedFile(path)
    harness.session.recovery = Recovery()
    offer_found(harness.session)
    harness.finish(0.001)
    return harness


@pytest.fixture
def harness(path):
    harness = opened(path)
    yield harness
    harness.session.recovery.close(delete=True)


def edit(harness) -> str:
    """Make an unsaved change: move the second element, a light. Return the text of the scene."""
    harness.play("press Tab", "press d")
    return dump(harness.session.state.scene)


def notify(harness) -> None:
    """Tell the session that the file has changed, and finish the pictures that follow."""
    harness.session.file.news.set()
    harness.session.mlx.mlx_wake(harness.display)
    harness.memory.play()
    while harness.painter.busy:
        harness.finish(0.001)


def drop(harness, file) -> None:
    """Drop a file on the window."""
    harness.memory.drop(str(file))
    harness.memory.play()


def diameter(harness) -> float:
    size: float = harness.session.state.scene.spheres[0].diameter
    return size


def test_a_changed_file_is_shown(harness, path):
    write(path, OTHER)
    notify(harness)
    assert diameter(harness) == 7
    assert (harness.session.picture == colour_of(harness.session.state.scene)).all()
    harness.play(UNDO)
    assert diameter(harness) == 2


def test_the_camera_stays_unless_the_file_changes_it_and_is_saved_in_its_own_line(harness, path):
    harness.play("press d")
    moved = harness.session.state.scene.camera
    write(path, OTHER.replace("# looks along -z", "# elsewhere"))
    notify(harness)
    assert harness.session.state.scene.camera == moved
    assert harness.session.state.file_cameras == scene().cameras
    harness.play(SAVE)
    assert "# elsewhere" in path.read_text()
    assert load(path).scene.camera.position[0] > 0
    write(path, OTHER.replace("C 0,0,10", "C 0,0,20"))
    notify(harness)
    assert harness.session.state.scene.camera.position == (0, 0, 20)


def test_a_broken_file_keeps_the_picture_and_shows_the_error_until_it_is_mended(harness, path):
    before = harness.session.state.scene
    write(path, BROKEN)
    notify(harness)
    assert harness.session.state.scene is before
    assert "5:10: sphere diameter must be > 0" in harness.session.screen.banner
    harness.play("press Tab")
    assert harness.session.state.message == ""
    assert harness.session.screen.banner
    write(path, OTHER)
    notify(harness)
    assert harness.session.screen.banner == ""
    assert diameter(harness) == 7


UNUSABLE = {  # lines of a file, and the beginning of what is said; a folder has files of these names
    f"sp 0,0,0 2 1,2,3 texture:{'a' * 300}": "sphere texture must be a picture file",
    f"ob {'a/' * 3000}b.obj 0,0,0 1 1,2,3": "mesh file",
    "bg /root\0/x.png": "must be text, got a NUL byte",
    "sp 0,0,0 2 1,2,3 texture:dark.png": "sphere texture must be a picture file",
    "ob deep.glb 0,0,0 1 1,2,3": "mesh file",
    "x " * 10_000: "unknown element 'x'",
}


@pytest.mark.parametrize("line", UNUSABLE, ids=range(len(UNUSABLE)))
def test_nothing_that_a_watched_file_holds_ends_the_window(harness, path, line):
    (path.parent / "dark.png").write_bytes(b"\x89PNG\r\n\x1a\n" + b"\xff" * 99)
    (path.parent / "deep.glb").write_bytes(b"glTF" + b"\xff" * 99)
    before = harness.session.state.scene
    write(path, f"{TEXT}{line}\n")
    notify(harness)
    assert harness.session.state.scene is before
    assert f": {UNUSABLE[line]}" in harness.session.screen.banner
    write(path, OTHER)
    notify(harness)
    assert (diameter(harness), harness.session.screen.banner) == (7, "")


@pytest.mark.parametrize("error", [IndexError("odd"), MemoryError(), RecursionError("deep"), OSError(5, "I/O error")])
def test_an_error_in_a_reader_does_not_end_the_window_either(harness, path, monkeypatch, defects, error):
    def fail(*_):
        raise error

    before = harness.session.state.scene
    with monkeypatch.context() as patch:
        patch.setattr("minirt.viewer.app.commands.load", fail)
        write(path, OTHER)
        notify(harness)
    assert harness.session.state.scene is before
    assert type(error).__name__ in harness.session.state.message
    assert defects == [error]
    assert isinstance(harness.session.defect, RenderError)
    write(path, OTHER + "# once more\n")
    notify(harness)
    assert diameter(harness) == 7
    defects.clear()


def test_a_deleted_file_is_said_until_it_is_written_again(harness, path):
    path.unlink()
    notify(harness)
    assert "scene.rt was deleted by another program: Ctrl+S writes it again" in harness.session.screen.banner
    harness.play(SAVE)
    assert load(path).scene.items == harness.session.state.scene.items
    assert harness.session.screen.banner == ""


OTHER_LIGHT = TEXT.replace("L 5,5,5 0.5", "L 5,5,5 0.7")


def test_changes_of_both_in_other_lines_are_merged(harness, path):
    """The user moves the light and looks around; the other program changes a sphere and adds lines."""
    edit(harness)
    harness.play("press C", "press d")
    session, before = harness.session, harness.session.state.scene
    write(path, "# at the top\n" + OTHER + "sp 1,1,1 1 9,9,9  # added\n")
    notify(harness)
    after = session.state.scene
    assert session.screen.banner == ""
    assert "both are here" in session.state.message
    assert after.lights == before.lights != scene().lights
    assert [ball.diameter for ball in after.spheres] == [7, 1]
    assert after.camera == before.camera != scene().camera
    assert contents_differ(after, session.saved)
    harness.play(UNDO)
    assert session.state.scene.spheres == before.spheres
    harness.play("press Ctrl+Y", SAVE)
    assert path.read_text().startswith("# at the top\n# a comment\n")
    assert "# added" in path.read_text()
    assert not path.with_name("scene-1.rt").exists()


@pytest.mark.parametrize(
    ("mine", "theirs", "both"),
    [
        ("a b c", "a b c", "a b c"),
        ("a x c", "a b c", "a x c"),
        ("a x c", "a b y", "a x y"),
        ("a x c", "a y c", None),
        ("a x c", "a x c", "a x c"),
        ("a c", "a y c", None),
        ("a b c m", "a b c t", "a b c m t"),
        ("m a b c", "a b", "m a b"),
        ("c b a", "b a c", None),
        ("", "a b c", ""),
    ],
)
def test_versions_are_merged_line_by_line(mine, theirs, both):
    found = merged(list("abc"), mine.split(), theirs.split())
    assert found == (None if both is None else both.split())


def test_when_both_changed_a_line_a_banner_asks_and_saving_keeps_a_copy_of_the_other_version(harness, path):
    edited = edit(harness)
    write(path, OTHER_LIGHT)
    notify(harness)
    assert dump(harness.session.state.scene) == edited
    assert "Ctrl+R reads it" in harness.session.screen.banner
    harness.play(SAVE)
    assert path.read_text() == edited
    assert path.with_name("scene-1.rt").read_text() == OTHER_LIGHT
    assert harness.session.screen.banner == ""
    assert "scene-1.rt" in harness.session.state.message
    harness.play("press d")
    harness.play(SAVE)
    assert not path.with_name("scene-2.rt").exists()
    write(path, BROKEN)  # the change is not noticed yet
    harness.play(SAVE)
    assert path.with_name("scene-2.rt").read_text() == BROKEN


# Of a dialect, but for the length of a direction, of which there is a notice, too.
FOREIGN = TEXT.replace("sp 0,0,0 2 255,0,0", "sp 0, 0, 0 2 255,0,0 100").replace("0,0,-1 90", "0,0,-2 90")
FOREIGN += "qd 1,2,3 4 9,8,7\nqd 0,0,0 4 9,8,7\n"


def test_a_file_in_a_dialect_is_opened_and_saving_asks_before_it_is_written_in_this_format(harness, tmp_path):
    session, other = harness.session, tmp_path / "other.rt"
    other.write_text(FOREIGN)
    drop(harness, other)
    assert session.window.title == "miniRT - other.rt: 2 shapes are missing: qd"
    assert session.state.message.startswith("opened: ")
    assert session.state.message.endswith(
        "\nother.rt is in the dialect of another program, and is read as --lenient does"
    )
    harness.play("press Tab", "press d", SAVE)
    assert other.read_text() == FOREIGN
    assert (
        "other.rt is in the dialect of another program: Ctrl+S again writes it in this format" in session.screen.banner
    )
    harness.play(SAVE)
    assert (session.screen.banner, session.lenient) == ("", False)
    saved = load(other).scene
    assert saved == session.state.scene == session.saved
    assert dump(saved).count("# missing: qd") == 2
    harness.play("press d", SAVE)  # asks no more
    assert load(other).scene == session.state.scene


def test_a_file_in_this_format_is_saved_without_a_question_also_when_lenient(harness, path):
    harness.session.lenient = True
    edited = edit(harness)
    harness.play(SAVE)
    assert path.read_text() == edited


def test_another_file_is_opened_and_unsaved_changes_are_kept(harness, path, tmp_path, monkeypatch):
    edited, watched, session = edit(harness), [], harness.session
    session.watches_file = True
    monkeypatch.setattr(WatchedFile, "watch", lambda file, _: watched.append(file.path))
    other = tmp_path / "other one.rt"
    other.write_text(OTHER)
    drop(harness, other)
    kept = path.with_name("scene.recovered.rt")
    assert kept.read_text() == edited
    assert str(kept) in session.state.message
    assert session.path == other
    assert session.window.title == "miniRT - other one.rt"
    assert diameter(harness) == 7
    assert session.state.undo_stack == ()
    assert watched == [other]
    edit(harness)
    harness.play(SAVE)
    assert path.read_text() == TEXT
    assert other.read_text() != OTHER
    open_another(session, path)
    assert watched == [other, path]


@pytest.mark.parametrize(("name", "text"), [("broken.rt", BROKEN), ("picture.png", "x"), ("none.rt", None)])
def test_a_file_that_is_no_scene_gives_a_message(harness, path, tmp_path, name, text):
    if text:
        (tmp_path / name).write_text(text)
    before = harness.session.state.scene
    drop(harness, tmp_path / name)
    assert harness.session.state.scene is before
    assert harness.session.path == path
    assert name in harness.session.state.message


def test_a_file_that_cannot_be_written_is_not_copied_first(harness, path):
    harness.session.path = path.with_suffix(".txt")
    harness.session.path.write_text(TEXT)
    harness.session.file = WatchedFile(harness.session.path)
    write(harness.session.path, OTHER)
    with pytest.raises(SceneError, match=r"ends in '\.rt'"):
        save_scene(harness.session)
    assert {each.name for each in path.parent.iterdir()} == {"scene.rt", "scene.txt"}


# Unsaved changes are kept on disk while the program runs, and offered when the scene is opened again.


def killed_after_an_edit(path) -> str:
    """Edit the scene in a program that is killed; return the text of the edited scene."""
    harness = opened(path)
    edited = edit(harness)
    harness.session.recovery.close(delete=False)
    return edited


def kept() -> list[str]:
    """Return the names of all files with unsaved changes."""
    return [each.name for each in state_folder().glob("*.rt")]


def test_the_changes_of_a_killed_program_are_offered_until_they_are_taken(path):
    edited = killed_after_an_edit(path)
    for _ in range(2):
        harness = opened(path)
        assert "unsaved changes of " in harness.session.screen.banner
        assert "found: Ctrl+R takes them" in harness.session.screen.banner
        assert harness.session.state.scene == scene()
        end_recovery(harness.session)
        assert not path.with_name("scene.recovered.rt").exists()
    harness = opened(path)
    harness.play("press Ctrl+r")
    assert dump(harness.session.state.scene) == edited
    assert harness.session.screen.banner == ""
    harness.session.recovery.flush()
    assert len(kept()) == 1  # that of this session
    assert harness.session.recovery.path.read_text() == edited
    harness.play(SAVE)
    assert path.read_text() == edited
    harness.session.recovery.flush()
    assert kept() == []
    end_recovery(harness.session)
    assert "unsaved" not in opened(path).session.screen.banner


@pytest.mark.parametrize(
    ("name", "message"),
    [
        ("opning.rt", "a new scene: Ctrl+S writes opning.rt, did you mean 'opening.rt'?"),
        ("new.rt", "a new scene: Ctrl+S writes new.rt"),
        ("opening.rt", ""),
    ],
)
def test_a_new_scene_is_said_with_a_file_of_a_like_name_that_may_be_meant(tmp_path, name, message):
    (tmp_path / "opening.rt").write_text(TEXT)
    harness = SessionHarness()
    session = harness.session
    session.watch_file(tmp_path / name)
    session.saved = parse(TEXT, session.path).scene
    tell_new(session)
    assert session.state.message == message


def test_the_changes_of_a_new_scene_are_offered_though_its_file_is_not_there(path):
    edited = killed_after_an_edit(path)
    path.unlink()
    harness = opened(path)
    assert "unsaved changes of " in harness.session.screen.banner
    harness.play("press F5")
    assert dump(harness.session.state.scene) == edited
    end_recovery(harness.session)


@pytest.mark.parametrize("end", [end_recovery, lose_window])
def test_an_end_with_unsaved_changes_leaves_a_recovery_file_that_is_offered(path, end, capsys):
    harness = opened(path)
    edited = edit(harness)
    end(harness.session)
    copy = path.with_name("scene.recovered.rt")
    assert str(copy) in capsys.readouterr().out
    assert kept() == []
    harness = opened(path)
    assert "(scene.recovered.rt) found" in harness.session.screen.banner
    harness.play("press F5")
    assert dump(harness.session.state.scene) == copy.read_text() == edited
    assert copy.exists()
    end_recovery(harness.session)


def test_changes_stay_kept_where_no_recovery_file_can_be_written(path, monkeypatch):
    harness = opened(path)
    edit(harness)

    def fail(*_: object) -> None:
        raise OSError

    monkeypatch.setattr(desktop, "save_recovery", fail)
    with pytest.raises(OSError):  # noqa: PT011 - any
        end_recovery(harness.session)
    assert len(kept()) == 1


def test_changes_with_an_error_are_said_and_kept(path):
    copy = path.with_name("scene.recovered.rt")
    copy.write_text(TEXT.replace("sp 0,0,0 2", "sp 0,0,0 -2"))
    harness = opened(path)
    harness.play("press F5")
    assert "sphere diameter must be > 0" in harness.session.state.message
    assert copy.exists()
    end_recovery(harness.session)


def test_another_file_that_is_opened_offers_its_own_changes(harness, tmp_path):
    other = tmp_path / "other.rt"
    other.write_text(TEXT)
    os.utime(other, (1000, 1000))
    edited = killed_after_an_edit(other)
    drop(harness, other)
    assert "Ctrl+R takes them" in harness.session.screen.banner
    harness.play("press F5")
    assert dump(harness.session.state.scene) == edited
