"""Picture files: their pixels, reasons for refusing them, and that each is decoded once."""

from __future__ import annotations

import io
import os
import struct
import zlib
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image

from minirt.errors import FileError
from minirt.helpers import system
from minirt.materials import pictures
from minirt.materials.pictures import heights, picture
from minirt.rendering.packing.lights import Colours
from minirt.rendering.packing.materials import Reader
from minirt.scene import parse

COLOURS = np.array([[[255, 0, 0], [0, 255, 0]], [[0, 0, 255], [10, 20, 30]], [[255, 255, 255], [0, 0, 0]]], np.uint8)


NOISE = np.random.default_rng(1).integers(0, 256, (13, 17, 3), np.uint8)


def encoded(form: str, mode: str = "RGB", **options: Any) -> bytes:
    """Return the file of a picture of noise."""
    buffer = io.BytesIO()
    Image.fromarray(NOISE).convert(mode).save(buffer, form, **options)
    return buffer.getvalue()


FILES = {
    **{form: encoded(form) for form in ("PNG", "JPEG", "BMP", "GIF", "TIFF", "PPM", "TGA", "WEBP")},
    **{f"TIFF {each}": encoded("TIFF", compression=each) for each in ("tiff_lzw", "jpeg", "packbits")},
    "fax": encoded("TIFF", "1", compression="group4"),
    "CMYK": encoded("JPEG", "CMYK"),
    "palette": encoded("PNG", "P"),
    "moving WEBP": encoded("WEBP", save_all=True, append_images=[Image.new("RGB", (17, 13))]),
}


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


@pytest.mark.parametrize("decodes", [False, True])
def test_a_file_is_packed_once_under_all_its_names(tmp_path: Path, decodes: bool) -> None:
    Image.fromarray(COLOURS).save(tmp_path / "a.png")
    Image.fromarray(COLOURS).save(tmp_path / "same_pixels.png")
    (tmp_path / "link.png").symlink_to("a.png")
    os.link(tmp_path / "a.png", tmp_path / "hard.png")
    scene = parse("A 1 255,255,255\nC 0,0,-5 0,0,1 70\nL 0,9,0 1 255,255,255\n", str(tmp_path / "x.rt")).scene
    pool = Reader(scene)
    names = "a.png", "link.png", "same_pixels.png", "hard.png"
    pool.colours = Colours(decodes)
    assert [pool.texture(name, (255, 255, 255)) for name in names] == [1, 1, 2, 1]
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
    real = pictures.decode
    monkeypatch.setattr(pictures, "decode", lambda path: decoded.append(path) or real(path))
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
    (tmp_path / "empty").touch()
    (tmp_path / "text.png").write_text("sp 0,0,0 1 1,2,3\n")
    (tmp_path / "program.eps").write_text("%!PS-Adobe-3.0 EPSF-3.0\n%%BoundingBox: 0 0 2 2\n%%EndComments\n")
    assert refusal(tmp_path / "empty") == "is empty"
    assert refusal(tmp_path / "text.png") == "is not a picture"
    assert refusal(tmp_path / "program.eps") == "is not a picture"  # nobody runs programs that a scene names


@pytest.mark.parametrize("name", FILES)
def test_every_truncated_picture_is_read_or_refused(tmp_path: Path, name: str) -> None:
    data, path = FILES[name], tmp_path / "a"
    step = max(len(data) // 40, 1)
    for end in (*range(1, len(data) // 2, step), len(data)):
        path.write_bytes(data[:end])
        os.utime(path, ns=(end, end))
        if end == len(data):
            assert picture(path).shape == (13, 17, 3)
        else:
            assert refusal(path).startswith(("is not a picture", "is a damaged picture"))


def after(form: str, beginning: int, part: bytes) -> bytes:
    """Return a file with many equal parts behind its beginning."""
    return FILES[form][:beginning] + part * PARTS + FILES[form][beginning:]


PARTS = 3000
TEXT = b"tEXta\0b"
OF_MANY_PARTS = {
    "JPEG, padding of a marker": after("JPEG", 2, b"\xff"),
    "JPEG, comments": after("JPEG", 2, b"\xff\xfe\0\4ab"),
    "PNG, texts": after("PNG", 33, struct.pack(">I", 3) + TEXT + struct.pack(">I", zlib.crc32(TEXT))),
    "GIF, comments": after("GIF", 13 + 3 * 2 ** (1 + (FILES["GIF"][10] & 7)), b"\x21\xfe\x01a\0"),
    "PPM, blanks": FILES["PPM"][:3] + b" " * PARTS + FILES["PPM"][3:],
}


@pytest.mark.parametrize("name", OF_MANY_PARTS)
def test_a_file_of_too_many_parts_is_refused(tmp_path: Path, name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "few").write_bytes(FILES[name.partition(",")[0]])
    (tmp_path / "many").write_bytes(OF_MANY_PARTS[name])
    monkeypatch.setattr(pictures, "MOST_PARTS", 500)  # ordinary files have fewer
    expected = picture(tmp_path / "few")
    assert refusal(tmp_path / "many") == "is a damaged picture (it has more than 500 parts)"
    monkeypatch.setattr(pictures, "MOST_PARTS", 10 * PARTS)
    assert np.array_equal(picture(tmp_path / "many"), expected)


def test_a_jpeg_of_too_many_scans_is_refused(tmp_path: Path) -> None:
    data = encoded("JPEG", progressive=True)
    scan = data[data.rindex(b"\xff\xda") : -2]
    for count in (100, 200):
        (tmp_path / f"{count}").write_bytes(data[:-2] + scan * count + data[-2:])
    assert picture(tmp_path / "100").shape == (13, 17, 3)
    assert refusal(tmp_path / "200") == "is a damaged picture (it has more than 200 scans)"


def test_comments_in_plain_pictures_are_left_out(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    plain = f"P3\n17 13\n255\n{' '.join(map(str, NOISE.ravel()))}\n".encode()
    commented = plain.replace(b"\n", b" # 1 2 3\n#\n\n#4\r") + b"#" * 10_000
    (tmp_path / "a.ppm").write_bytes(commented)
    monkeypatch.setattr(pictures, "MOST_PARTS", 2000)
    assert np.array_equal(picture(tmp_path / "a.ppm"), NOISE)


def test_memory_is_checked_before_a_picture_is_decoded(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "large.png").write_bytes(png(8192, 8192))  # which could not be decoded
    monkeypatch.setattr(system, "room", lambda: 2**28)
    assert refusal(tmp_path / "large.png").startswith("a picture of 8192x8192 pixels needs about 512 MiB of memory")


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
        (9000, 9000, "has 9000x9000 pixels, more than 8192x8192"),
        (10_000, 10_000, "has more than 8192x8192 pixels"),
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
