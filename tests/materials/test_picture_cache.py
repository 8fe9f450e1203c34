"""Picture files: their pixels, reasons for refusing them, and that each is decoded once."""

from __future__ import annotations

import os
import struct
import zlib
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from minirt.errors import FileError
from minirt.materials import picture_files
from minirt.materials.picture_cache import heights, picture
from minirt.rendering.packing.lights import Colours
from minirt.rendering.packing.materials import TexturePool
from minirt.scene import parse
from tests.guards import must_not_open

COLOURS = np.array([[[255, 0, 0], [0, 255, 0]], [[0, 0, 255], [10, 20, 30]], [[255, 255, 255], [0, 0, 0]]], np.uint8)


def refusal(path: Path) -> str:
    """The reason for which a file is refused, both as colours and as heights."""
    reasons = set()
    for read in (picture, heights):
        with pytest.raises(FileError) as caught:
            read(path)
        assert str(caught.value) == f"{path}: {caught.value.reason}"
        reasons.add(caught.value.reason)
    (reason,) = reasons
    return reason


@pytest.mark.parametrize("name", ["a.png", "a.bmp", "a.tiff", "a.ppm", "a.tga", "a"])
def test_the_pixels_are_those_of_the_file_its_upper_row_first(tmp_path: Path, name: str) -> None:
    Image.fromarray(COLOURS).save(tmp_path / name, format=None if "." in name else "PNG")
    read = picture(tmp_path / name)
    assert (read.dtype, read.shape) == (np.uint8, (3, 2, 3))
    assert np.array_equal(read, COLOURS)
    assert np.array_equal(picture(str(tmp_path / name)), COLOURS)


@pytest.mark.parametrize("mode", ["P", "RGBA", "L", "LA", "1", "CMYK"])
def test_every_pixel_format_becomes_red_green_and_blue(tmp_path: Path, mode: str) -> None:
    path = tmp_path / ("a.tiff" if mode == "CMYK" else "a.png")
    image = Image.fromarray(COLOURS).convert(mode)
    image.save(path)
    assert np.array_equal(picture(path), np.asarray(image.convert("RGB")))


def test_a_picture_for_which_memory_is_short_is_not_called_damaged(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def no_memory(_self: Image.Image, _mode: str) -> None:
        raise MemoryError

    Image.fromarray(COLOURS[..., 0]).save(tmp_path / "a.png")
    monkeypatch.setattr(Image.Image, "convert", no_memory)
    assert refusal(tmp_path / "a.png") == "needs more memory than there is to decode it"


def test_all_links_to_a_file_share_one_array_until_one_is_replaced(tmp_path: Path) -> None:
    Image.fromarray(COLOURS).save(tmp_path / "a.png")
    os.link(tmp_path / "a.png", tmp_path / "hard.png")
    first, hard = picture(tmp_path / "a.png"), picture(tmp_path / "hard.png")
    assert first is hard
    Image.fromarray(255 - COLOURS).save(tmp_path / "new.png")
    (tmp_path / "new.png").replace(tmp_path / "hard.png")
    assert np.array_equal(picture(tmp_path / "hard.png"), 255 - COLOURS)
    assert picture(tmp_path / "a.png") is first


@pytest.mark.parametrize("decodes", [False, True])
def test_all_links_to_a_file_are_packed_once(tmp_path: Path, decodes: bool) -> None:
    Image.fromarray(COLOURS).save(tmp_path / "a.png")
    Image.fromarray(COLOURS).save(tmp_path / "same_pixels.png")
    os.link(tmp_path / "a.png", tmp_path / "hard.png")
    scene = parse("A 1 255,255,255\nC 0,0,-5 0,0,1 70\nL 0,9,0 1 255,255,255\n", str(tmp_path / "x.rt")).scene
    pool = TexturePool(scene)
    names = "a.png", "hard.png", "same_pixels.png", "hard.png"
    assert [pool.number(name, Colours(decodes).texture) for name in names] == [1, 1, 2, 1]
    assert pool.arrays()["texels"].size == 2 * COLOURS.size


def test_heights_are_the_luminance_from_0_to_1(tmp_path: Path) -> None:
    path = tmp_path / "a.png"
    Image.fromarray(COLOURS).save(path)
    read = heights(path)
    assert (read.dtype, read.shape) == (np.float32, (3, 2))
    blue = (10 * 0.2126 + 20 * 0.7152 + 30 * 0.0722) / 255
    assert read == pytest.approx(np.array([[0.2126, 0.7152], [0.0722, blue], [1, 0]]), abs=1e-6)
    assert read.max() <= 1


def test_heights_keep_16_bits_and_colours_are_rounded_to_8(tmp_path: Path) -> None:
    path = tmp_path / "a.png"
    levels = np.array([[0, 1, 256, 257, 32768, 65535]], np.uint16)
    Image.fromarray(levels).save(path)
    assert heights(path) == pytest.approx(levels / 65535, abs=1e-7)
    assert picture(path)[0, :, 0].tolist() == [0, 0, 1, 1, 128, 255]
    assert picture(path).shape == (1, 6, 3)


def test_a_file_is_decoded_once_and_again_when_it_changes(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = tmp_path / "a.png"
    decoded: list[Path] = []
    real = picture_files.decode
    monkeypatch.setattr(picture_files, "decode", lambda path: decoded.append(path) or real(path))
    Image.fromarray(COLOURS).save(path)
    first = picture(path)
    assert picture(path) is first
    assert len(decoded) == 1
    heights(path)
    heights(path)
    assert len(decoded) == 2
    Image.fromarray(COLOURS[::-1]).save(path)
    os.utime(path, ns=(1, 1))
    assert np.array_equal(picture(path), COLOURS[::-1])
    assert np.array_equal(first, COLOURS)
    assert len(decoded) == 3
    path.unlink()
    assert "no such file" in refusal(path)


def test_cached_pixels_are_read_only(tmp_path: Path) -> None:
    Image.fromarray(COLOURS).save(tmp_path / "a.png")
    for read in (picture, heights):
        with pytest.raises(ValueError, match="read-only"):
            read(tmp_path / "a.png")[0] = 0


def test_files_without_a_picture_are_refused(tmp_path: Path) -> None:
    (tmp_path / "folder").mkdir()
    os.mkfifo(tmp_path / "fifo")
    (tmp_path / "empty").touch()
    (tmp_path / "text.png").write_text("sp 0,0,0 1 1,2,3\n")
    (tmp_path / "program.eps").write_text("%!PS-Adobe-3.0 EPSF-3.0\n%%BoundingBox: 0 0 2 2\n%%EndComments\n")
    assert refusal(tmp_path / "missing") == "cannot be read: no such file or directory"
    assert refusal(tmp_path / "folder") == "is a folder"
    with must_not_open(tmp_path / "fifo", Path("/dev/zero")):
        assert refusal(tmp_path / "fifo") == "is not a regular file"
        assert refusal(Path("/dev/zero")) == "is not a regular file"
    assert refusal(tmp_path / "empty") == "is empty"
    assert refusal(tmp_path / "text.png") == "is not a picture"
    assert refusal(tmp_path / "program.eps") == "is not a picture"  # nobody runs programs that a scene names


def test_every_truncated_picture_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "a.png"
    random = np.random.default_rng(1)
    Image.fromarray(random.integers(0, 256, (8, 8, 3), np.uint8)).save(path)
    whole = path.read_bytes()
    for end in range(1, len(whole) - 24, 7):  # the last bytes say only that it ends, and are sums
        path.write_bytes(whole[:end])
        os.utime(path, ns=(end, end))
        assert refusal(path).startswith(("is not a picture", "is a damaged picture ("))


def png(width: int, height: int) -> bytes:
    """A picture file whose header claims this size, without pixels."""

    def chunk(name: bytes, data: bytes) -> bytes:
        return struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))

    header = struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(b"")) + chunk(b"IEND", b"")


@pytest.mark.parametrize(
    ("width", "height", "reason"),
    [
        (8193, 1, "has 8193x1 pixels, more than 8192x8192"),
        (1, 8193, "has 1x8193 pixels, more than 8192x8192"),
        (10_000, 10_000, "has 10000x10000 pixels, more than 8192x8192"),
        (60_000, 60_000, "has more than 8192x8192 pixels"),
    ],
)
def test_a_picture_that_would_fill_the_memory_is_not_decoded(
    tmp_path: Path, width: int, height: int, reason: str
) -> None:
    (tmp_path / "bomb.png").write_bytes(png(width, height))
    assert refusal(tmp_path / "bomb.png") == reason


def test_the_largest_picture_is_read(tmp_path: Path) -> None:
    Image.new("L", (8192, 2), 51).save(tmp_path / "wide.png")
    assert picture(tmp_path / "wide.png").shape == (2, 8192, 3)
    assert heights(tmp_path / "wide.png")[1, 8191] == pytest.approx(0.2)


def test_a_file_of_too_many_bytes_is_not_read(tmp_path: Path) -> None:
    with (tmp_path / "large.png").open("wb") as file:
        file.truncate(256 * 2**20 + 1)
    assert refusal(tmp_path / "large.png") == "larger than 256 MiB"
