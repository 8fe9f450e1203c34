"""What README.md says is what the program does."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from PIL import Image as pillow  # noqa: N813

import minirt
from minirt.cli import main
from minirt.scene import dump, format_table, parse
from minirt.viewer import keys_markdown
from tests.paths import ROOT

README = (ROOT / "README.md").read_text()


def blocks(language: str) -> list[str]:
    """The code blocks of a language."""
    found = re.findall(r"^```(\w*)\n(.*?)^```$", README, re.MULTILINE | re.DOTALL)
    return [text for named, text in found if named == language]


def test_the_tables_are_those_of_the_program() -> None:
    assert keys_markdown().strip() in README
    assert format_table().strip() in README


def test_the_window_program_is_the_one_that_is_tested() -> None:
    _, program = (ROOT / "tests/mlx/gradient.py").read_text().split('"""\n\n', 1)
    assert program in blocks("python")
    assert len(program.splitlines()) <= 15


def test_the_lines_of_python_run(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (lines,) = (block for block in blocks("python") if "minirt.load" in block)
    monkeypatch.chdir(tmp_path)
    (tmp_path / "scenes").symlink_to(ROOT / "scenes")
    names: dict[str, object] = {}
    exec(lines, names)
    assert (tmp_path / "demo.png").read_bytes().startswith(b"\x89PNG")
    assert names["scene"].spheres[0].diameter == 3  # type: ignore[attr-defined]


def test_a_scene_is_made_without_a_file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (lines,) = (block for block in blocks("python") if "Camera.look_at" in block)
    monkeypatch.chdir(tmp_path)
    names = {"minirt": minirt}
    exec(lines, names)
    scene = names["made"]
    again = parse(dump(scene)).scene  # type: ignore[arg-type]
    assert again.items == scene.items  # type: ignore[attr-defined]
    with pillow.open(tmp_path / "beads.png") as picture:
        assert picture.size == (320, 240)
        assert len(picture.getcolors(100_000) or ()) > 1000


def test_all_blocks_of_python_are_run() -> None:
    known = ("minirt.load", "Camera.look_at", "minirt.save_movie", "minirt.trace", "minirt.mlx", "squared = ")
    assert all(any(word in block for word in known) for block in blocks("python"))


def test_rays_are_traced() -> None:
    (lines,) = (block for block in blocks("python") if "minirt.trace" in block)
    names: dict[str, object] = {"minirt": minirt, "scene": minirt.load(ROOT / "scenes/demo.rt")}
    exec(lines, names)
    assert names["hits"].distance.shape == (1,)  # type: ignore[attr-defined]


def test_the_heart_of_a_sphere_is_in_its_file() -> None:
    (lines,) = (block for block in blocks("python") if "squared = " in block)
    source = (ROOT / "minirt/shapes/sphere.py").read_text()
    for line in lines.splitlines():
        assert line.split("  #")[0] in source, line


def test_the_animation_and_the_window(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (lines,) = (block for block in blocks("python") if "minirt.save_movie" in block)
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("minirt.view", lambda scene: scene, raising=False)
    scene = minirt.load(ROOT / "scenes/demo.rt")
    assert scene.spheres[1].colour == (255, 200, 50)  # the golden one
    names = {"minirt": minirt, "scene": scene}
    exec(lines, names)
    assert (tmp_path / "jump.gif").read_bytes().startswith(b"GIF89a")
    assert names["scene"] is scene


def test_the_moving_picture_is_made_by_the_keys_beside_it(tmp_path: Path) -> None:
    keys = (ROOT / "assets/demo-keys.txt").read_text().splitlines()
    (command,) = re.findall(r"`miniRT (.*? -o assets/demo\.gif)`", README)
    assert keys[1].split(maxsplit=1)[1] == f"miniRT {command}"
    assert (ROOT / "assets/demo.gif").stat().st_size < 1.5e6
    arguments = command.replace("assets/demo.gif", str(tmp_path / "demo.gif")).split()
    full = [str(ROOT / each) if each.startswith(("scenes/", "assets/")) else each for each in arguments]
    assert main(full) == 0
    with pillow.open(ROOT / "assets/demo.gif") as kept, pillow.open(tmp_path / "demo.gif") as made:
        assert kept.size == made.size
        assert abs(kept.n_frames - made.n_frames) <= 3


def test_the_scene_is_read(tmp_path: Path) -> None:
    (scene,) = (block for block in blocks("") if block.startswith("A 0.2"))
    (tmp_path / "scene.rt").write_text(scene)
    assert main([str(tmp_path / "scene.rt"), "--check"]) == 0


def test_the_errors_are_what_is_printed(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    (errors,) = (block for block in blocks("") if block.startswith("Error\n"))
    wrong = re.findall(r"^    (s.*)$", errors, re.MULTILINE)
    monkeypatch.chdir(tmp_path)
    Path("scene.rt").write_text("\n".join(["A 0.2 255,255,255", "C 0,2,-12 0,-0.1,1 60", "", *wrong]))
    assert main(["scene.rt"]) == 1
    assert capsys.readouterr().err == errors


def test_the_replay_plays(tmp_path: Path) -> None:
    (keys,) = (block for block in blocks("") if block.startswith("press Tab"))
    scene = tmp_path / "scene.rt"
    scene.write_bytes((ROOT / "scenes/eval-sphere.rt").read_bytes())  # the keys save it
    (tmp_path / "keys.txt").write_text(keys)
    assert main([str(scene), "--replay", str(tmp_path / "keys.txt"), "-o", str(tmp_path / "out.png")]) == 0
    assert (tmp_path / "out.png").exists()


def test_continuous_integration_installs_what_a_newcomer_is_told_to() -> None:
    told = set(" ".join(re.findall(r"^apt-get install (.*)$", README, re.MULTILINE)).split()) - {"make"}
    script = (ROOT / ".ci/run").read_text()
    (packages,) = re.findall(r'^packages="(.*?)"$', script, re.MULTILINE | re.DOTALL)
    assert set(packages.split()) == told
    assert "make test" in script
    assert "make test" in README


def test_the_gallery_is_made_by_its_commands() -> None:
    rows = re.findall(r"^\| !\[(.*)\]\((.*)\) \| (.*)<br>`miniRT (.*)`<br>[0-9.]+ s \|$", README, re.MULTILINE)
    assert len(rows) >= 8
    for told, picture, again, command in rows:
        scene, size, samples, out = re.fullmatch(r"(\S+) --size (\S+) --samples (\S+) -o (\S+)", command).groups()  # type: ignore[union-attr]
        assert told == again == (ROOT / scene).read_text().splitlines()[0].removeprefix("# ")
        assert (picture, samples) == (f"assets/gallery-{out}", "64")
        with pillow.open(ROOT / picture) as image:
            assert "x".join(map(str, image.size)) == size
        assert (ROOT / picture).stat().st_size < 250_000
    assert {path.name for path in (ROOT / "assets").glob("gallery-*")} == {
        f"gallery-{row[3].split()[-1]}" for row in rows
    }


def test_all_tests_that_their_page_names_are_there() -> None:
    page = (ROOT / "tests" / "README.md").read_text()
    names = re.findall(r"`([\w/]+\.py)`", page)
    assert len(names) > 20
    for name in names:
        assert any((folder / name).is_file() for folder in (ROOT, ROOT / "tests")), name
