"""Files that this process decodes by itself: those that the helper has decoded well before."""

from __future__ import annotations

import os
import sys
from contextlib import suppress
from pathlib import Path

import PIL
import pytest

import minirt
from minirt import jail, load
from minirt.jail import decoder, helper, known_files
from minirt.materials import picture_cache
from minirt.rendering.scene_packing import Packing
from tests.cli.program import PROGRAM, SCENE, environment, program
from tests.jail.pictures import FILES, PNG, WITH_COMPLAINTS
from tests.processes import run

TEXTURED = SCENE.replace("10,0,255", "10,0,255 texture:a.png")


@pytest.fixture
def starts(monkeypatch: pytest.MonkeyPatch) -> list[int]:
    """A list with an entry for each start of a helper."""
    starts: list[int] = []
    real = helper.start
    monkeypatch.setattr(helper, "start", lambda: starts.append(1) or real())
    return starts


def test_a_file_is_known_after_it_was_decoded_well(starts: list[int]) -> None:
    for _ in range(3):
        assert jail.decode(PNG) == decoder.decode(PNG)
    assert starts == [1]
    jail.decode(FILES["BMP"])
    assert starts == [1, 1]
    jail.decode(PNG)
    jail.decode(FILES["BMP"])
    assert starts == [1, 1]


def test_a_session_has_one_process_and_leaves_none(starts: list[int]) -> None:
    with jail.session():
        with jail.session():
            jail.decode(PNG)
        jail.decode(FILES["palette"])
        assert jail.decoding.state.helper
        process = jail.decoding.state.helper.process
    assert starts == [1]
    assert process
    assert process.returncode is not None


@pytest.mark.parametrize("data", [PNG[:200], WITH_COMPLAINTS], ids=["damaged", "with complaints"])
def test_other_files_stay_unknown(starts: list[int], data: bytes) -> None:
    for _ in range(2):
        with suppress(decoder.DecodingError):
            jail.decode(data)
    assert starts == [1, 1]


def test_another_version_of_pillow_knows_no_file(starts: list[int], monkeypatch: pytest.MonkeyPatch) -> None:
    jail.decode(PNG)
    monkeypatch.setattr(PIL, "__version__", "0.1")
    jail.decode(PNG)
    assert starts == [1, 1]


def test_trusted_files_need_no_process(starts: list[int], monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(jail.decoding.state, "trusts_all", True)
    assert jail.decode(PNG) == decoder.decode(PNG)
    assert starts == []
    assert not known_files.path().exists()


def test_without_trust_known_files_are_decoded_in_the_helper(starts: list[int]) -> None:
    for _ in range(2):
        jail.decode(PNG)
    assert starts == [1]
    jail.trust_no_files()
    for data in (PNG, FILES["BMP"]):
        assert jail.decode(data) == decoder.decode(data)
    assert starts == [1, 1, 1]
    assert len(known_files.known()) == 1  # a file of doubtful origin does not become known


def test_the_list_is_private() -> None:
    jail.decode(PNG)
    assert known_files.path().stat().st_mode & 0o777 == 0o600
    assert known_files.path().parent.stat().st_mode & 0o777 == 0o700


def open_to_others(path: Path) -> None:
    path.chmod(0o666)


def in_a_folder_open_to_others(path: Path) -> None:
    path.parent.chmod(0o777)


def as_a_link(path: Path) -> None:
    path.rename(path.with_name("other"))
    path.symlink_to(path.with_name("other"))


def as_a_pipe(path: Path) -> None:
    path.unlink()
    os.mkfifo(path)


def as_a_folder(path: Path) -> None:
    path.unlink()
    path.mkdir()


def of_another_user(path: Path) -> None:
    if os.geteuid():
        pytest.skip("only root gives files away")
    os.chown(path, 65534, 65534)


@pytest.mark.skipif(sys.platform == "win32", reason="Windows has no modes")
@pytest.mark.parametrize(
    "change", [open_to_others, in_a_folder_open_to_others, as_a_link, as_a_pipe, as_a_folder, of_another_user]
)
def test_a_list_that_others_may_have_written_is_not_read(starts: list[int], change: object) -> None:
    jail.decode(PNG)
    assert known_files.known()
    change(known_files.path())  # type: ignore[operator]
    assert not known_files.known()
    jail.decode(PNG)
    assert starts == [1, 1]


def test_a_damaged_list_knows_nothing_and_a_long_one_begins_anew(starts: list[int]) -> None:
    jail.decode(PNG)
    known_files.path().write_bytes(b"\xff\0" * known_files.MOST)
    assert jail.decode(PNG) == decoder.decode(PNG)
    assert starts == [1, 1]
    assert len(known_files.known()) == 1
    assert known_files.path().stat().st_size == 2 * known_files.DIGEST_SIZE + 1


def test_without_a_place_for_the_list_files_are_decoded(starts: list[int], monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("XDG_CACHE_HOME", "/dev/null")
    for _ in range(2):
        assert jail.decode(PNG) == decoder.decode(PNG)
    assert starts == [1, 1]


def test_scenes_use_one_process_for_all_pictures(tmp_path: Path, starts: list[int]) -> None:
    (tmp_path / "a.png").write_bytes(PNG)
    (tmp_path / "b.png").write_bytes(FILES["16 bits"])
    (tmp_path / "a.rt").write_text(TEXTURED + "sp 3,0,0 2 1,2,3 texture:a.png bump:b.png,1\nbg b.png\n")
    picture_cache.entries.clear()
    load(tmp_path / "a.rt")
    assert starts == [1]
    picture_cache.entries.clear()
    load(tmp_path / "a.rt")
    assert starts == [1]


def test_a_scene_without_pictures_loads_no_part_of_the_helper(tmp_path: Path) -> None:
    (tmp_path / "a.rt").write_text(SCENE)
    source = "import sys, minirt; minirt.load('a.rt'); print(*{'subprocess', 'minirt.jail.helper'} & {*sys.modules})"
    assert run([sys.executable, "-c", source], cwd=tmp_path, env=environment(), text=True).stdout == "\n"


@pytest.mark.parametrize("arguments", [(), ("--trust",), ("--no-trust",)])
def test_the_program_decodes_pictures_and_leaves_no_other_words(tmp_path: Path, arguments: tuple[str, ...]) -> None:
    (tmp_path / "a.png").write_bytes(PNG)
    (tmp_path / "a.rt").write_text(TEXTURED)
    assert program(tmp_path, "a.rt", "--check", *arguments) == (0, b"a.rt: no errors, 2 shapes, 1 lights\n", "")
    assert known_files.path().exists() == (not arguments)


def test_the_words_of_decoders_do_not_come_before_an_error(tmp_path: Path) -> None:
    (tmp_path / "a.png").write_bytes(WITH_COMPLAINTS)
    (tmp_path / "a.rt").write_text(TEXTURED + "nonsense\n")
    ended = run([*PROGRAM, "a.rt", "--check"], cwd=tmp_path, env=environment(), text=True)
    assert ended.stderr.startswith("Error\na.rt:6:1: ")


def test_the_process_starts_before_numpy_is_imported_and_only_for_an_unknown_file(tmp_path: Path) -> None:
    (tmp_path / "a.png").write_bytes(PNG)
    source = (
        "from minirt import jail\nfrom minirt.jail.decoding import state\nwith jail.session():\n"
        "    jail.expect('missing.png')\n    print(state.helper is None)\n"
        "    jail.expect('a.png')\n    print(state.helper is None)\n"
        "    jail.decode(open('a.png', 'rb').read())\nprint(state.helper is None)"
    )
    for unknown in (True, False):
        ended = run([sys.executable, "-W", "ignore", "-c", source], cwd=tmp_path, env=environment(), text=True)
        assert ended.stdout.split() == ["True", str(not unknown), "True"], ended.stderr


def test_a_scene_of_a_program_uses_one_process_for_all_pictures(tmp_path: Path, starts: list[int]) -> None:
    for name in ("a", "b"):
        (tmp_path / f"{name}.png").write_bytes(FILES["palette" if name == "a" else "16 bits"])
    spheres = [
        minirt.Sphere((x, 0, 0), 1, (1, 2, 3), texture=str(tmp_path / f"{name}.png")) for x, name in enumerate("ab")
    ]
    camera = minirt.Camera((0, 0, -5), (0, 0, 1), 60)
    picture_cache.entries.clear()
    Packing().pack(minirt.Scene((camera, *spheres)), 4, 3)
    assert starts == [1]
