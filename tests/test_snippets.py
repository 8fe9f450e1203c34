"""The code on the pages of the documentation runs: Python, scenes, error messages and recorded keys."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from PIL import Image as pillow  # noqa: N813

import minirt
from minirt.cli import main
from minirt.scene import dump, parse
from tests.notebook.requirements import require
from tests.pages import PAGES, block, blocks, name
from tests.paths import PACKAGE, ROOT, TESTS

RENDERING, CLUSTER, VIEWER, SCENES_PAGE, MLX = (
    "minirt/rendering/README.md",
    "minirt/cluster/README.md",
    "minirt/viewer/README.md",
    "scenes/README.md",
    "minirt/mlx/README.md",
)
RUN = {  # a word of each Python block that a test below runs, by its page
    "README.md": ("minirt.load",),
    RENDERING: ("Camera.look_at", "minirt.save_movie", "minirt.trace"),
    CLUSTER: ("minirt.render_to",),
    VIEWER: ("notebook=True",),
    MLX: ("minirt.mlx",),
    "minirt/README.md": (
        "squared = ",
        "class Torus",
        "class PackedTorus",
        "def intersect",
        "def boundary",
    ),  # compared with the sources
    "CONTRIBUTING.md": ("not picture_at", "Cull shapes", "scene units"),  # examples of style
}


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder to run code in, with the scenes."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "scenes").symlink_to(ROOT / "scenes")
    return tmp_path


@pytest.mark.parametrize("page", [name(page) for page in PAGES])
def test_all_blocks_of_python_are_run(page: str) -> None:
    assert all(any(word in each for word in RUN.get(page, ())) for each in blocks(page, "python"))


def test_the_example_of_the_readme_runs(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("minirt.view", lambda scene: scene, raising=False)
    names: dict[str, object] = {}
    code = block("README.md", "python", "minirt.load")
    assert len([line for line in code.splitlines() if line]) <= 10
    exec(code, names)
    assert (folder / "demo.png").read_bytes().startswith(b"\x89PNG")
    assert names["scene"].spheres[0].diameter == 3  # type: ignore[attr-defined]
    assert names["hits"].distance.shape == (1,)  # type: ignore[attr-defined]


def test_a_scene_is_made_without_a_file(folder: Path) -> None:
    names = {"minirt": minirt}
    exec(block(RENDERING, "python", "Camera.look_at"), names)
    scene = names["made"]
    again = parse(dump(scene)).scene  # type: ignore[arg-type]
    assert again.items == scene.items  # type: ignore[attr-defined]
    with pillow.open(folder / "beads.png") as picture:
        assert picture.size == (320, 240)
        assert len(picture.getcolors(100_000) or ()) > 1000


def test_the_animation_is_written(folder: Path) -> None:
    assert minirt.load(ROOT / "scenes/demo.rt").spheres[1].colour == (255, 200, 50)  # the golden ball
    exec(block(RENDERING, "python", "minirt.save_movie"), {"minirt": minirt})
    assert (folder / "jump.gif").read_bytes().startswith(b"GIF89a")


def test_processes_render(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    exec(block(CLUSTER, "python", "minirt.render_to"), {"minirt": minirt})
    assert (folder / "large.tif").read_bytes()[:4] == b"II+\0"  # BigTIFF
    means = [float(line) for line in capsys.readouterr().out.splitlines()]
    assert len(set(means)) == 20


def test_rays_are_traced() -> None:
    names: dict[str, object] = {"minirt": minirt, "scene": minirt.load(ROOT / "scenes/demo.rt")}
    exec(block(RENDERING, "python", "minirt.trace"), names)
    assert names["hits"].distance.shape == (1,)  # type: ignore[attr-defined]


def test_the_viewer_of_notebooks_opens() -> None:
    require("anywidget")
    names: dict[str, object] = {}
    exec(block(VIEWER, "python", "notebook=True"), names)
    viewer = names["viewer"]
    viewer.close()  # type: ignore[attr-defined]
    assert viewer.scene == minirt.example("demo")  # type: ignore[attr-defined]


def test_the_window_program_is_the_one_that_is_tested() -> None:
    _, program = (TESTS / "mlx/gradient.py").read_text(encoding="utf-8").split('"""\n\n', 1)
    assert program in blocks(MLX, "python")
    assert len(program.splitlines()) <= 15


def test_the_heart_of_a_sphere_is_in_its_file() -> None:
    source = (PACKAGE / "shapes/sphere.py").read_text(encoding="utf-8")
    for line in block("minirt/README.md", "python", "squared = ").splitlines():
        assert line.split("  #")[0] in source, line


def test_the_boundary_of_a_torus_is_in_its_file() -> None:
    source = (PACKAGE / "shapes/torus.py").read_text(encoding="utf-8")
    for line in block("minirt/README.md", "python", "def boundary").splitlines():
        assert line in source, line


def test_the_scene_is_read(tmp_path: Path) -> None:
    (tmp_path / "scene.rt").write_text(block(SCENES_PAGE, "", "A 0.2"))
    assert main([str(tmp_path / "scene.rt"), "--check"]) == 0


def test_the_errors_are_printed_as_shown(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    errors = block(SCENES_PAGE, "", "Error\n")
    wrong = re.findall(r"^    (s.*)$", errors, re.MULTILINE)
    monkeypatch.chdir(tmp_path)
    Path("scene.rt").write_text("\n".join(["A 0.2 255,255,255", "C 0,2,-12 0,-0.1,1 60", "", *wrong]))
    assert main(["scene.rt"]) == 1
    assert capsys.readouterr().err == errors


def test_the_recorded_keys_are_played(tmp_path: Path) -> None:
    scene = tmp_path / "scene.rt"
    scene.write_bytes((ROOT / "scenes/eval-sphere.rt").read_bytes())  # the keys save it
    (tmp_path / "keys.txt").write_text(block(VIEWER, "", "press Tab"))
    assert main([str(scene), "--replay", str(tmp_path / "keys.txt"), "-o", str(tmp_path / "out.png")]) == 0
    assert (tmp_path / "out.png").exists()
