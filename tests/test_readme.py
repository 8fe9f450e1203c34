"""README.md is short, and what it says and shows is so; so is its short form in pyproject.toml."""

from __future__ import annotations

import re
import tomllib
from pathlib import Path

from PIL import Image as pillow  # noqa: N813

from minirt.cli import main
from tests.make_tables import index_text
from tests.pages import links, read
from tests.paths import ROOT, SCENES, scene_files

README = read("README.md")
WORDS = 1_200
GALLERY_ROW = r"^\| !\[(.*)\]\(\.\./(.*)\) \| (.*)<br>`miniRT (.*)`<br>[0-9.]+ s \|$"


def test_it_is_short() -> None:
    assert len(README.split()) <= WORDS


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


def test_continuous_integration_installs_what_a_newcomer_is_told_to() -> None:
    pages = README + read("CONTRIBUTING.md")
    told = set(" ".join(re.findall(r"^apt-get install (.*)$", pages, re.MULTILINE)).split()) - {"make"}
    script = (ROOT / ".ci/run").read_text()
    (packages,) = re.findall(r'^packages="(.*?)"$', script, re.MULTILINE | re.DOTALL)
    assert set(packages.split()) == told
    for command in re.findall(r"\bmake \w+", script):
        assert f"\n{command} " in pages


def test_the_gallery_is_made_by_its_commands() -> None:
    rows = re.findall(GALLERY_ROW, read("scenes/README.md"), re.MULTILINE)
    assert len(rows) >= 8
    for alternative, picture, caption, command in rows:
        scene, size, samples, out = re.fullmatch(r"(\S+) --size (\S+) --samples (\S+) -o (\S+)", command).groups()  # type: ignore[union-attr]
        assert alternative == caption == (ROOT / scene).read_text().splitlines()[0].removeprefix("# ")
        assert (picture, samples) == (f"assets/gallery-{out}", "64")
        with pillow.open(ROOT / picture) as image:
            assert "x".join(map(str, image.size)) == size
        assert (ROOT / picture).stat().st_size < 250_000
    shown = {picture for _, picture, _, _ in rows}
    assert shown == {f"assets/{path.name}" for path in (ROOT / "assets").glob("gallery-*")}
    assert shown == {target for target in links("README.md") if "gallery-" in target}


def test_scenes_that_its_page_lists_are_all_scenes() -> None:
    page = read("scenes/README.md").partition("## The scenes of this folder")[2].partition("##")[0]
    patterns = re.findall(r"`([\w*-]+\.rt)`", page)
    assert {path for each in patterns for path in SCENES.glob(each)} - set(SCENES.glob("*.recovered*")) == set(
        scene_files()
    )


def test_the_text_for_package_indexes_is_as_generated() -> None:
    project = tomllib.loads(read("pyproject.toml"))["project"]
    assert project["readme"]["text"] == index_text(), "write it anew: python -m tests.make_tables"
    assert not re.findall(r"\]\(|<img|href", index_text())
    assert len(index_text().split()) > 200
    assert "urls" not in project
