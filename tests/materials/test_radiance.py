"""Radiance pictures: hand-made files in each encoding, orientation and exposure, and damaged ones with their place."""

from __future__ import annotations

from itertools import groupby
from pathlib import Path
from random import Random

import numpy as np
import pytest
from numpy.typing import NDArray

from minirt.errors import FileError, SceneError
from minirt.materials.pictures import SIDE, heights, picture, sky
from minirt.materials.radiance import RadianceError, read_header, read_pixels, read_whole_pixels
from minirt.scene import load, parse
from tests.kernel.pictures import linear

HEADER = b"#?RADIANCE\n# made by hand\nSOFTWARE=none\nFORMAT=32-bit_rle_rgbe\n\n"
RANDOM = np.random.default_rng(4)
RGBE = NDArray[np.uint8]


def noise(height: int, width: int) -> RGBE:
    """Pixels with long and short runs of equal components, none of which begins a scanline of another encoding."""
    pixels = RANDOM.integers(3, 256, (height, width, 4)).astype(np.uint8)
    pixels[:, width // 3 : width // 2] = pixels[:, width // 3 : width // 3 + 1]
    pixels[:, : width // 4, 1] = 77
    pixels[..., 3] = 120 + pixels[..., 3] % 16
    return pixels


def light_of(pixels: RGBE) -> NDArray[np.float64]:
    """The light of pixels: each mantissa a fraction of 256, by two to the power of the exponent less 128."""
    powers = np.array([[2.0 ** (int(e) - 128) for e in row] for row in pixels[..., 3]])
    return pixels[..., :3] / 256 * powers[..., None]


def flat(row: RGBE) -> bytes:
    """A scanline of whole pixels."""
    return row.tobytes()


def old_runs(row: RGBE) -> bytes:
    """A scanline with repeated pixels: counts above 255 take several marks, the lowest bits first."""
    data = b""
    for pixel, group in groupby(row.tolist()):
        data += bytes(pixel)
        repeats = len(list(group)) - 1
        while repeats:
            data += bytes([1, 1, 1, repeats & 255])
            repeats >>= 8
    return data


def new_runs(row: RGBE) -> bytes:
    """A scanline by components, as runs of up to 127 and as up to 128 single values."""
    data = bytes([2, 2, len(row) >> 8, len(row) & 255])
    for component in row.T.tolist():
        for value, group in groupby(component):
            count = len(list(group))
            while count:
                part = min(count, 127)
                data += bytes([128 + part, value]) if part > 2 else bytes([part, *[value] * part])
                count -= part
    return data


def new_singles(row: RGBE) -> bytes:
    """A scanline by components without runs."""
    parts = [part[at : at + 128] for part in row.T for at in range(0, len(row), 128)]
    return bytes([2, 2, len(row) >> 8, len(row) & 255]) + b"".join(bytes([len(p)]) + p.tobytes() for p in parts)


def written(path: Path, pixels: RGBE, encode=flat, size: str = "", header: bytes = HEADER) -> Path:
    """Write a file; `size` is its line about the size, for rows from the top when left out."""
    lines = size or f"-Y {pixels.shape[0]} +X {pixels.shape[1]}"
    path.write_bytes(header + lines.encode() + b"\n" + b"".join(map(encode, pixels)))
    return path


@pytest.mark.parametrize("width", [1, 7, 8, 9, 127, 128, 300, 1000])
@pytest.mark.parametrize("encode", [flat, old_runs, new_runs, new_singles])
def test_every_encoding_gives_the_light_that_was_written(tmp_path: Path, encode, width: int) -> None:
    if encode in (new_runs, new_singles) and width < 8:
        pytest.skip("such short scanlines have no new encoding")
    pixels = noise(5, width)
    pixels[2] = pixels[2, 0]  # a run of the whole scanline
    read = sky(written(tmp_path / "a.hdr", pixels, encode))
    assert (read.dtype, read.shape) == (np.float32, (5, width, 3))
    assert np.array_equal(read, light_of(pixels))


def old_runs_at_random(row: list[bytes], random: Random) -> bytes:
    """Write a scanline, with each run of equal pixels cut at random into pixels, repeats and repeats of none."""
    data, done = b"", 0
    while done < len(row):
        data += row[done]
        equal = next((at for at in range(done, len(row)) if row[at] != row[done]), len(row)) - done
        repeats = random.randrange(equal)
        done += 1 + repeats
        if done < len(row) or repeats:
            digits = [repeats >> shift & 255 for shift in (0, 8, 16, 24)]
            while digits and not digits[-1] and (done == len(row) or random.random() < 0.7):
                digits.pop()  # of the last pixels nothing may follow the digit that fills the scanline
            data += b"".join(bytes([1, 1, 1, digit]) for digit in digits)
    return data


def test_all_ways_to_write_a_scanline_give_its_pixels() -> None:
    random = Random(5)
    for length in [*range(1, 12), 255, 256, 257, 1000, 70_000]:
        for _ in range(20 if length < 2000 else 2):
            row: list[bytes] = []
            while len(row) < length:
                row += [bytes([*random.randbytes(3), 200])] * random.choice([1, 2, 3, length // 2 + 1])
            row = row[:length]
            row = [pixel if pixel[:3] != b"\1\1\1" else b"\2\1\1\1" for pixel in row]
            data = old_runs_at_random(row, random)
            pixels = np.zeros((length, 4), np.uint8)
            assert read_whole_pixels(b"--" + data + b"rest", 2, pixels) == 2 + len(data)
            assert pixels.tobytes() == b"".join(row)


def test_scanlines_of_all_encodings_may_be_mixed(tmp_path: Path) -> None:
    pixels, encodings = noise(8, 40), iter([flat, new_runs, old_runs, new_singles] * 2)
    read = sky(written(tmp_path / "a.hdr", pixels, lambda row: next(encodings)(row)))  # noqa: PLW0108
    assert np.array_equal(read, light_of(pixels))


def test_an_exponent_of_0_is_black_and_the_largest_is_finite(tmp_path: Path) -> None:
    pixels = np.array([[[255, 9, 0, 0], [128, 64, 0, 129], [255, 255, 255, 255], [1, 0, 0, 1]]], np.uint8)
    read = sky(written(tmp_path / "a.hdr", pixels))
    assert read[0, :2].tolist() == [[0, 0, 0], [1, 0.5, 0]]
    assert read[0, 2].tolist() == [255 * 2.0**119] * 3
    assert read[0, 3, 0] == pytest.approx(2.0**-135, rel=1e-6)


@pytest.mark.parametrize(
    ("size", "turn"),
    [
        ("-Y 3 +X 5", lambda light: light),
        ("+Y 3 +X 5", lambda light: light[::-1]),
        ("-Y 3 -X 5", lambda light: light[:, ::-1]),
        ("+Y 3 -X 5", lambda light: light[::-1, ::-1]),
        ("+X 3 -Y 5", lambda light: light.swapaxes(0, 1)),
        ("-X 3 -Y 5", lambda light: light.swapaxes(0, 1)[:, ::-1]),
        ("+X 3 +Y 5", lambda light: light.swapaxes(0, 1)[::-1]),
        ("-X 3 +Y 5", lambda light: light.swapaxes(0, 1)[::-1, ::-1]),
    ],
)
def test_every_orientation_is_turned_upright(tmp_path: Path, size: str, turn) -> None:
    pixels = noise(3, 5)
    assert np.array_equal(sky(written(tmp_path / "a.hdr", pixels, size=size)), turn(light_of(pixels)))


def test_exposures_in_the_header_are_taken_back(tmp_path: Path) -> None:
    pixels = noise(2, 3)
    header = b"#?RGBE\nEXPOSURE=4\nEXPOSURE = .5\n\n"
    assert np.array_equal(sky(written(tmp_path / "a.hdr", pixels, header=header)), light_of(pixels) / 2)
    tiny = written(tmp_path / "b.hdr", pixels, header=b"#?RGBE\nEXPOSURE=1e-300\n\n")
    assert np.isfinite(sky(tiny)).all()


ROWS = b"".join(map(new_runs, np.full((2, 8, 4), 200, np.uint8)))  # 2 scanlines of 4 + 4 * 2 bytes each
START = len(HEADER) + len(b"-Y 2 +X 8\n")
TWO, ONE = HEADER + b"-Y 2 +X 8\n", HEADER + b"-Y 1 +X 4\n"
END = b"\n-Y 2 +X 8\n" + ROWS
EXPOSURE = "the exposure, times those before it, must be a number > 0"
DAMAGED = [
    ("line 6: expected a size such as -Y 512 +X 1024", HEADER + b"-Y 2 +Y 8\n" + ROWS),
    ("line 6: expected a size such as -Y 512 +X 1024", HEADER),
    ("line 6: expected a size such as -Y 512 +X 1024", HEADER + b"2 8\n" + ROWS),
    ("line 2: the header has no end", b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe"),
    ("line 2: the format must be 32-bit_rle_rgbe", b"#?RADIANCE\nFORMAT=32-bit_rle_xyze\n\n"),
    (f"line 2: {EXPOSURE}", b"#?RADIANCE\nEXPOSURE=0\n\n-Y 2 +X 8\n" + ROWS),
    (f"line 2: {EXPOSURE}", b"#?RADIANCE\nEXPOSURE=nan\n\n-Y 2 +X 8\n" + ROWS),
    (f"line 3: {EXPOSURE}", b"#?RGBE\n" + 2 * b"EXPOSURE=1e-300\n" + END),
    (f"line 3: {EXPOSURE}", b"#?RGBE\n" + 2 * b"EXPOSURE=1e300\n" + END),
    ("line 2: the format must be 32-bit_rle_rgbe", b"#?RGBE\nFORMAT=\x1b[31m\n\n"),
    ("line 3: the header has no end", b"#?RGBE\nA=1\n" + bytes(3 * 2**20) + b"\n\n-Y 2 +X 8\n" + ROWS),
    ("line 4: expected a size such as -Y 512 +X 1024", b"#?RGBE\nA=1\n\n" + b" " * 2**20 + b"-Y 2 +X 8\n" + ROWS),
    (f"scanline 1 of 2, byte {START}: the file ends", TWO),
    (f"scanline 2 of 2, byte {START + 23}: the file ends", TWO + ROWS[:-1]),
    (f"scanline 2 of 2, byte {START + 12}: it should have 8 pixels, and has 9", TWO + ROWS[:15] + b"\x09" + ROWS[16:]),
    (f"scanline 1 of 2, byte {START + 4}: 9 pixels, where 8 of 8 are missing", TWO + ROWS[:4] + b"\x89" + ROWS[5:]),
    (f"scanline 1 of 2, byte {START + 4}: 0 pixels, where 8 of 8 are missing", TWO + ROWS[:4] + b"\x00" + ROWS[5:]),
    (f"scanline 1 of 1, byte {START}: no pixel to repeat", ONE + b"\1\1\1\3abcd"),
    (f"scanline 1 of 1, byte {START + 4}: 4 pixels, where 3 of 4 are missing", ONE + b"abcd\1\1\1\4"),
    (f"scanline 1 of 1, byte {START + 6}: the file ends", ONE + b"abcdab"),
]


@pytest.mark.parametrize(("message", "data"), DAMAGED)
def test_a_damaged_file_is_refused_with_its_place(tmp_path: Path, message: str, data: bytes) -> None:
    path = tmp_path / "a.hdr"
    path.write_bytes(data)
    with pytest.raises(FileError) as caught:
        sky(path)
    assert caught.value.reason == f"is a damaged Radiance picture: {message}"


def test_no_cut_or_changed_byte_breaks_the_reader(tmp_path: Path) -> None:
    data = written(tmp_path / "a.hdr", noise(3, 20), new_runs).read_bytes()
    for at in range(len(data)):
        for damaged in (data[:at], data[:at] + bytes([data[at] ^ 1 << RANDOM.integers(8)]) + data[at + 1 :]):
            try:
                header = read_header(damaged)
                if max(header.width, header.height) < 1000:
                    assert np.isfinite(read_pixels(damaged, header)).all()
            except RadianceError:
                continue


@pytest.mark.parametrize("size", ["0 +X 8", "3 +X 0", f"{SIDE + 1} +X 1", f"1 +X {SIDE + 1}", "999999999 +X 999999999"])
def test_a_size_beyond_the_limit_is_refused_before_memory_is_taken(tmp_path: Path, size: str) -> None:
    path = tmp_path / "a.hdr"
    path.write_bytes(HEADER + f"-Y {size}\n".encode())
    with pytest.raises(FileError, match="pixels"):
        sky(path)


def test_only_a_sky_may_be_a_radiance_picture(tmp_path: Path) -> None:
    path = written(tmp_path / "a.hdr", noise(2, 3))
    for read in (picture, heights):
        with pytest.raises(FileError, match="is a Radiance picture, which only a sky may be: 'bg file'"):
            read(path)
    (tmp_path / "a.rt").write_text("A 1 9,9,9\nC 0,0,0 0,0,1 60\nbg a.hdr\nsp 0,0,9 1 9,9,9 texture:a.hdr\n")
    with pytest.raises(SceneError) as caught:
        load(tmp_path / "a.rt")
    (problem,) = caught.value.problems
    assert (problem.line, problem.column) == (4, 26)
    (tmp_path / "a.hdr").write_bytes(HEADER)
    with pytest.raises(
        SceneError, match=r"a\.rt:3:4: background paint must be a picture file, got 'a\.hdr': is a damaged"
    ):
        load(tmp_path / "a.rt")


def test_an_ordinary_picture_is_a_sky_of_bytes() -> None:
    path = Path("scenes/textures/evening.png")
    assert np.array_equal(sky(path), picture(path))


@pytest.mark.parametrize(("tone", "exposure"), [("plain", 0.0), ("srgb", 0.0), ("filmic", -2.0)])
def test_the_light_of_a_sky_has_no_limit(tmp_path: Path, tone: str, exposure: float) -> None:
    pixels = np.full((4, 8, 4), 128, np.uint8)
    pixels[..., 3] = 135  # light of 64
    path = written(tmp_path / "a.hdr", pixels, new_runs)
    text = f"A 0 9,9,9\nC 0,0,0 0,0,1 60 tone:{tone} exposure:{exposure}\nbg {path}\nsp 9,9,-9 1 9,9,9\n"
    assert np.array_equal(linear(parse(text).scene, 8, 4), np.full((4, 8, 3), 64 * 2.0**exposure))
