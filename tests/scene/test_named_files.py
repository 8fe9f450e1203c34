"""Mesh files that a scene names are read, refused with their line, column and reason, and written."""

from __future__ import annotations

import ast
import errno
import os
import random
from contextlib import suppress
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image

from minirt.cli import main
from minirt.errors import SceneError
from minirt.materials import Bump, Mirror, pictures
from minirt.meshes import obj_lines
from minirt.scene import describe, dump, load
from minirt.shapes.mesh import Mesh
from tests.fuzz.inputs import originals
from tests.processes import in_child
from tests.scene.examples import AMBIENT, CAMERA
from tests.seeds import seed_of
from tests.test_imports import sources

ONE = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A folder with a mesh file in a subfolder and a broken one."""
    (tmp_path / "meshes").mkdir()
    (tmp_path / "meshes" / "one.obj").write_text(ONE)
    (tmp_path / "bad.obj").write_text("v 0 0 0\nv 1 0 x\n")
    (tmp_path / "loop.obj").symlink_to("loop.obj")
    return tmp_path


def scene(folder: Path, *lines: str) -> Path:
    """Write a scene file with `lines`."""
    path = folder / "scene.rt"
    path.write_text("\n".join([AMBIENT, CAMERA, *lines, ""]))
    return path


def test_mesh_paths_are_relative_to_the_folder_of_the_scene(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir("/")
    path = scene(folder, "ob meshes/one.obj 1,2,3 2 255,0,0 mirror:0.5", f"obj {folder}/meshes/one.obj 0,0,0 1 9,9,9")
    one, other = load(path).scene.shapes
    assert isinstance(one, Mesh)
    assert one.bounds() == ((1, 2, 3), (3, 4, 3))
    assert (one.mirror, one.colour, one.parts) == (Mirror(0.5), (255, 0, 0), 1)
    assert one.file.triangles is other.file.triangles  # the file is read once


REFUSED = {
    "ob meshes/two.obj 0,0,0 1 9,9,9": (4, "cannot be read: no such file or directory"),
    "ob bad.obj 0,0,0 1 9,9,9": (4, "line 2, column 7: v must be a number"),
}


@pytest.mark.parametrize(("line", "expected"), REFUSED.items())
def test_an_unreadable_mesh_file_is_an_error_at_its_name(folder: Path, line: str, expected: tuple[int, str]) -> None:
    with pytest.raises(SceneError) as caught:
        load(scene(folder, line))
    (problem,) = caught.value.problems
    name = line.split()[1]
    assert problem.message == f"mesh file '{name}': {expected[1]}"
    assert (problem.line, problem.column, problem.length, problem.text) == (3, expected[0], len(name), line)


@pytest.mark.parametrize(
    ("line", "message"),
    [
        ("ob meshes/one.obj 0,0,0 0 9,9,9", "mesh scale must be > 0, got 0"),
        ("ob meshes/one.obj 0,0,z 1 9,9,9", "mesh position z must be a number, got 'z'"),
        ("ob meshes/one.obj 0,0,0 1", "mesh colour is missing: expected 'ob file x,y,z scale R,G,B'"),
        ("ob 0,0,0 1 9,9,9", "mesh file is missing: expected 'ob file x,y,z scale R,G,B'"),
        (
            "ob meshes/one.obj 1e15,0,0 1e3 9,9,9",
            "mesh position must not be so far out that the mesh reaches beyond 1e+15",
        ),
    ],
)
def test_a_wrong_mesh_line_is_refused(folder: Path, line: str, message: str) -> None:
    with pytest.raises(SceneError) as caught:
        load(scene(folder, line))
    assert caught.value.problems[0].message == message


def test_a_changed_mesh_file_is_read_again(folder: Path) -> None:
    path = scene(folder, "ob meshes/one.obj 0,0,0 1 9,9,9")
    before = load(path).scene.meshes[0]
    (folder / "meshes" / "one.obj").write_text(ONE + "f 3 2 1\n")
    after = load(path).scene.meshes[0]
    assert before != after
    assert (before.parts, after.parts) == (1, 2)
    assert load(path).scene.meshes[0] == after


def told(path: Path) -> list[str]:
    """Return the messages of the notices about a scene."""
    return [each.message for each in load(path).notices]


def test_names_with_blanks_stand_within_quotes(folder: Path) -> None:
    (folder / "my map.ppm").write_bytes(PLAIN)
    (folder / "meshes" / "one two.obj").write_text(ONE)
    line = 'ob "meshes/one two.obj" 0,0,0 1 9,9,9 texture:"my map.ppm" bump:"my map.ppm",0.5  # \'quoted"'
    path = scene(folder, line, 'bg "my map.ppm"')
    for lenient in (False, True):
        read = load(path, lenient).scene
        assert (read.meshes[0].texture, read.meshes[0].bump) == ("my map.ppm", Bump("my map.ppm", 0.5))
        assert (read.meshes[0].file.name, read.background and read.background.paint) == (
            "meshes/one two.obj",
            "my map.ppm",
        )
        assert dump(read) == path.read_text()
        moved = read.replace(read.meshes[0], scale=2.0, texture="my other.ppm")
        assert dump(moved).splitlines()[2] == line.replace(" 1 ", " 2 ").replace("my map", "my other", 1)
        assert describe(read.meshes[0]) == line.partition("  #")[0]


def test_files_are_looked_for_above_the_scene_up_to_the_working_folder(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (folder / "a" / "b").mkdir(parents=True)
    (folder / "map.ppm").write_bytes(PLAIN)
    path = scene(folder / "a" / "b", "ob meshes/one.obj 0,0,0 1 9,9,9 texture:map.ppm")
    monkeypatch.chdir(folder)
    assert told(path) == [
        "mesh file is not beside the scene, and is read from '../../meshes/one.obj'",
        "mesh texture is not beside the scene, and is read from '../../map.ppm'",
    ]
    assert load(path).scene.beside("map.ppm") == folder / "map.ppm"
    monkeypatch.chdir(folder / "a")
    with pytest.raises(SceneError, match="no such file"):
        load(path)


def test_pointers_of_git_lfs_are_named(folder: Path) -> None:
    (folder / "a.png").write_text("version https://git-lfs.github.com/spec/v1\noid sha256:0\nsize 9\n")
    with pytest.raises(SceneError, match="is a pointer of Git LFS in place of the file: 'git lfs pull' fetches it"):
        load(scene(folder, "sp 0,0,9 1 9,9,9 texture:a.png"))


def test_transparent_parts_are_told_and_pictures_are_turned_by_their_exif_data(folder: Path) -> None:
    pixels = np.arange(24, dtype=np.uint8).reshape(2, 3, 4)
    pixels[..., 3] = 255
    line = "sp 0,0,9 1 9,9,9 texture:a.png"
    turned = Image.Exif()
    turned[0x0112] = 6  # to be turned clockwise
    Image.fromarray(pixels).save(folder / "a.png", exif=turned)
    path = scene(folder, line)
    assert told(path) == []
    assert np.array_equal(pictures.picture(folder / "a.png"), np.rot90(pixels[..., :3], -1))
    pixels[1, 1, 3] = 254
    Image.fromarray(pixels).save(folder / "a.png")
    assert told(path) == ["sphere texture has transparent parts, which are drawn opaque"]
    (folder / "a.png").write_text('/* XPM */ "1 2 2 1", "a c None", "b c #F00", "a", "b"')
    assert told(path) == ["sphere texture has transparent parts, which are drawn opaque"]


# Names that the system does not look at, and why; `odd` stands for one that it cannot look at now, see `deny`.
LONG = "a" * 300
NOT_LOOKED_AT = {
    LONG: errno.ENAMETOOLONG,
    "/".join([LONG] * 2): errno.ENAMETOOLONG,
    "/".join(["folder"] * 900): errno.ENAMETOOLONG,
    "one.ppm/map.ppm": errno.ENOTDIR,
    "loop.obj/map.ppm": errno.ELOOP,
    **{f"odd-{code}": code for code in (errno.EACCES, errno.EIO, errno.ESTALE, errno.EOVERFLOW, errno.ENOMEM)},
}
NAMING = {
    "sp 0,0,9 1 9,9,9 texture:{}": "sphere texture must be a picture file",
    "sp 0,0,9 1 9,9,9 bump:{},0.5": "sphere bump must be a picture file",
    "sp 0,0,9 1 9,9,9 normal:{}": "sphere normal map must be a picture file",
    "bg {}": "background paint must be a picture file",
    "ob {} 0,0,0 1 9,9,9": "mesh file",
}


@pytest.fixture
def deny(monkeypatch: pytest.MonkeyPatch) -> None:
    """Let the system fail to look at files whose names are `odd-` and the number of an error."""

    def look(path: Any, *more: Any, **named: Any) -> os.stat_result:
        code = str(path).rpartition("odd-")[2]
        if "odd-" in str(path):
            raise OSError(int(code), os.strerror(int(code)), str(path))
        return stat(path, *more, **named)

    stat = os.stat
    monkeypatch.setattr(os, "stat", look)


@pytest.mark.usefixtures("deny")
@pytest.mark.parametrize("line", NAMING)
@pytest.mark.parametrize("name", NOT_LOOKED_AT, ids=lambda name: name[-20:])
def test_a_named_file_that_cannot_be_looked_at_is_an_error_at_its_name(folder: Path, line: str, name: str) -> None:
    (folder / "one.ppm").write_bytes(PLAIN)
    written = line.format(name)
    for lenient in (False, True):  # which may leave the shape out
        with suppress(SceneError):
            load(scene(folder, "sp 0,0,9 1 9,9,9", written), lenient)
    with pytest.raises(SceneError) as caught:
        load(scene(folder, written))
    (problem,) = caught.value.problems
    assert problem.message.startswith(NAMING[line])
    assert problem.message.endswith(f": cannot be read: {os.strerror(NOT_LOOKED_AT[name]).lower()}")
    assert (problem.line, problem.column, problem.length) == (3, line.index("{") + 1, len(name))


@pytest.mark.usefixtures("deny")
@pytest.mark.parametrize("name", NOT_LOOKED_AT, ids=lambda name: name[-20:])
def test_materials_and_pictures_that_cannot_be_looked_at_are_left_out_of_a_mesh(folder: Path, name: str) -> None:
    (folder / "one.ppm").write_bytes(PLAIN)
    (folder / "named.mtl").write_text(f"newmtl red\nKd 1 0 0\nmap_Kd {name}\nmap_Bump -bm 2 {name}\n")
    for library, what in ((name, "a file of materials that"), ("named.mtl", "pictures that")):
        (folder / "one.obj").write_text(f"mtllib {library}\nusemtl red\n{ONE}")
        (notice,) = told(scene(folder, "ob one.obj 0,0,0 1 9,9,9"))
        assert f"this is not used: {what} cannot be read" in notice


def test_files_of_folders_without_permission_are_errors_and_end_no_program(folder: Path) -> None:
    (folder / "closed").mkdir()
    (folder / "closed" / "map.ppm").write_bytes(PLAIN)
    path = scene(folder, "sp 0,0,9 1 9,9,9 texture:closed/map.ppm")
    load(path)
    folder.chmod(0o755)
    (folder / "closed").chmod(0)

    def read() -> None:
        os.chdir(folder)  # whose own folders may be closed, too
        if os.geteuid() == 0:  # who may look everywhere
            os.setuid(65534)
        with pytest.raises(SceneError, match=r"map\.ppm': cannot be read: permission denied"):
            load(path.name)

    try:
        assert in_child(read) == 0
    finally:
        (folder / "closed").chmod(0o700)


def test_a_deleted_working_folder_is_no_error(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = scene(folder, "sp 0,0,9 1 9,9,9 texture:none.png")
    (folder / "gone").mkdir()
    monkeypatch.chdir(folder / "gone")
    (folder / "gone").rmdir()
    with pytest.raises(SceneError, match=r"none\.png': cannot be read: no such file or directory"):
        load(path)


LOOKS = {"exists", "is_file", "is_dir", "is_symlink", "is_fifo", "stat", "lstat", "samefile", "owner", "resolve"}
# These handle each OSError, or look at the files of the package.
MAY_LOOK = {"helpers/file_io/reading.py", "helpers/file_io/writing.py", "viewer/recovery.py"} | {
    f"kernel/machine_code/{each}.py" for each in ("cache", "fingerprint")
}


def looks(source: str) -> set[str]:
    """Return the methods of paths that a source calls and that raise where the system lets nobody look at a file."""
    called = (node.func for node in ast.walk(ast.parse(source)) if isinstance(node, ast.Call))
    methods = (each for each in called if isinstance(each, ast.Attribute) and ast.unparse(each.value) != "file_io")
    return {each.attr for each in methods} & LOOKS


def test_files_are_looked_at_by_functions_that_never_raise() -> None:
    found = {path: looks(source) for path, source in sources().items() if path not in MAY_LOOK and looks(source)}
    assert not found, "use `found`, `is_file` and `is_folder` of `minirt.helpers.file_io`"
    assert looks("if Path(name).is_file(): pass") == {"is_file"}, "the planted source is found"


SECRET, NUMBER = b"qzjxkvwqzv", b"9182736450"
PLAIN = b"P3 2 1 255 1 2 3 4 5 6\n"
NAMING_FILE = "ob file 0,0,0 1 9,9,9", "bg file", "sp 0,0,9 1 9,9,9 texture:file bump:file normal:file"
TRIES = 7  # of each file


@pytest.mark.parametrize("wrong", [False, True], ids=["", "planted"])
def test_no_message_quotes_a_file_that_a_scene_names(
    folder: Path, capfd: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch, wrong: bool
) -> None:
    """A secret stands at random places of files of each format. The planted program quotes wrong numbers of meshes."""
    if wrong:
        monkeypatch.setattr(obj_lines, "expected", str)
    seed = seed_of("secrets")
    chance = random.Random(seed)
    path = scene(folder, *NAMING_FILE)
    for data, secret in [
        (ONE.encode(), SECRET),
        (ONE.encode(), NUMBER),
        *((data, SECRET) for data in (PLAIN, *originals())),
    ]:
        for _ in range(TRIES):
            at, blank = chance.randint(0, len(data)), chance.choice((b"", b" ", b"\n"))
            (folder / "file").write_bytes(data[:at] + blank + secret + blank + data[at:])
            main([str(path), "--check"])
    told = "".join(capfd.readouterr())
    assert min(told.count(": is a damaged "), told.count(": line ")) > TRIES / 2
    parts = NUMBER.decode(), *(SECRET[at : at + 4].decode() for at in range(len(SECRET) - 3))
    assert any(part in told for part in parts) == wrong, f"seed {seed}"
