"""The memory that is allowed: default, option, refusals."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from PIL import Image as pillow  # noqa: N813

import minirt
from minirt.cli import main
from minirt.cli.arguments import memory_size
from minirt.helpers import system
from minirt.rendering.packing.materials import Reader
from tests.cli.program import SCENE

MIB = 2**20
TEXTURED = "A 1 255,255,255\nC 0,0,-9 0,0,1 60\n" + "".join(
    f"sp {3 * i},0,0 1 255,255,255 texture:{i}.png\n" for i in range(4)
)


@pytest.fixture(autouse=True)
def default_limit() -> Iterator[None]:
    """Restore the default."""
    yield
    minirt.limit_memory(None)


@pytest.mark.parametrize(
    ("text", "size"), [("4G", 4 * 2**30), ("512MiB", 512 * MIB), ("1048576", MIB), ("1tb", 2**40), ("1.5g", 3 * 2**29)]
)
def test_sizes_are_parsed(text: str, size: int) -> None:
    assert memory_size(text) == size


@pytest.mark.parametrize("size", [0, -5])
def test_a_limit_is_positive(size: int) -> None:
    with pytest.raises(minirt.RenderError, match=f"at least 1 byte, got {size}"):
        minirt.limit_memory(size)


def test_the_container_limits_the_default(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    files = tmp_path / "missing", tmp_path / "unlimited", tmp_path / "limited"
    monkeypatch.setattr(system, "CONTAINER", files)
    files[1].write_text("max\n")
    machine = system.default_total.__wrapped__()
    files[2].write_text(f"{300 * MIB}\n")
    assert system.default_total.__wrapped__() == 300 * MIB * 7 // 8 < machine


def test_what_the_process_holds_is_counted() -> None:
    before = system.room()
    minirt.limit_memory(system.resident() + 500 * MIB)
    least = system.room()
    held = np.ones(200 * MIB, np.uint8)
    assert least - system.room() > held.nbytes / 2
    assert least <= 500 * MIB
    assert before > 0


@pytest.mark.parametrize("arguments", [["-o", "x.png"], ["-o", "x.exr"], ["-o", "x.gif", "--turntable", "3"]])
def test_the_program_refuses_a_large_picture(
    arguments: list[str], tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("ball.rt").write_text(SCENE)
    assert main(["ball.rt", *arguments, "--size", "8000x6000", "--memory", "64M"]) == 1
    assert capsys.readouterr().err.startswith("Error\na picture of 8000x6000 pixels needs about ")
    assert [each.name for each in tmp_path.iterdir()] == ["ball.rt"]


def test_a_tiff_file_that_does_not_fit_is_written_in_bands(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    Path("ball.rt").write_text(SCENE)
    size = "--size", "2600x2000"
    assert main(["ball.rt", "-o", "whole.tif", *size]) == 0
    monkeypatch.setattr(system, "SMALL", 0)
    monkeypatch.setattr(system, "room", lambda: 25 * MIB)  # whatever other tests have left in memory
    assert main(["ball.rt", "-o", "bands.tif", *size]) == 0
    first, second = (np.asarray(pillow.open(name)) for name in ("whole.tif", "bands.tif"))
    assert np.array_equal(first, second)
    assert b"II+\0" == Path("bands.tif").read_bytes()[:4] != Path("whole.tif").read_bytes()[:4]  # BigTIFF, and Pillow's


@pytest.mark.parametrize(
    ("size", "words"),
    [
        (0, "0 B"),
        (1000, "1000 B"),
        (2**16, "64 KiB"),
        (2**20 - 512, "1024 KiB"),
        (2**28, "256 MiB"),
        (3 * 2**29, "1.5 GiB"),
    ],
)
def test_a_size_is_never_rounded_to_nothing(size: int, words: str) -> None:
    assert system.size_in_words(size) == words


def write_textures(folder: Path, side: int) -> None:
    """Write four pictures, the last of them a link to the first."""
    for number in range(3):
        pillow.new("RGB", (side, side), (number, 99, 9)).save(folder / f"{number}.png")
    (folder / "3.png").hardlink_to(folder / "0.png")


def test_textures_count_together_and_links_once(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    write_textures(tmp_path, 64)
    (tmp_path / "x.rt").write_text(TEXTURED)
    scene = minirt.load(tmp_path / "x.rt")
    needs: list[int] = []
    monkeypatch.setattr(system, "check_memory", lambda needed, *_: needs.append(needed))
    pool = Reader(scene)
    for number in range(4):
        pool.number(f"{number}.png", minirt.materials.pictures.picture)
    texels = pool.arrays()["texels"]
    assert texels.dtype == np.float32
    assert max(needs) == needs[-1] == texels.nbytes == 3 * 64 * 64 * 3 * 4


def test_too_large_a_texture_is_refused_with_its_place(tmp_path: Path) -> None:
    write_textures(tmp_path, 1024)
    (tmp_path / "x.rt").write_text(TEXTURED)
    minirt.limit_memory(MIB)
    with pytest.raises(
        minirt.SceneError, match=r"x.rt:3:.*need.? about .* MiB of memory, allowed 0 B \(what is left of 1 MiB\)"
    ):
        minirt.load(tmp_path / "x.rt")
