"""Plain PGM and PPM pictures have the pixels that Pillow reads, and damaged ones are refused."""

from __future__ import annotations

import io

import numpy as np
import pytest
from PIL import Image

from minirt.jail import decoder, plain_pnm
from minirt.jail.decoder import DecodingError

WIDTH, HEIGHT = 13, 7


def picture(form: str, greatest: int, separator: str = " ") -> bytes:
    """Return a picture of random levels as text."""
    levels = np.random.default_rng(1).integers(0, greatest + 1, WIDTH * HEIGHT * (3 if form == "P3" else 1))
    return f"{form}\n{WIDTH} {HEIGHT}\n{greatest}\n{separator.join(map(str, levels))}\n".encode()


PICTURES = {
    f"{form} {greatest}": picture(form, greatest) for form in ("P2", "P3") for greatest in (1, 7, 255, 256, 65535)
} | {
    "all blanks": picture("P3", 255, " \t\n\v\f\r "),
    "leading zeros": picture("P3", 99, " 00"),
    "more levels": picture("P2", 255) + b"12 no level",
    "no end of line": picture("P2", 255).rstrip(),
}


@pytest.mark.parametrize("name", PICTURES)
@pytest.mark.parametrize("chunk", [2**16, 8, 12, 13])
def test_the_pixels_are_those_of_pillow(name: str, chunk: int, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(plain_pnm, "CHUNK", chunk)
    monkeypatch.setattr(plain_pnm, "MOST_KNOWN", 5)
    expected = Image.open(io.BytesIO(PICTURES[name]))
    expected = expected if expected.mode == "I" else expected.convert("RGB")
    decoded = decoder.decode(PICTURES[name])
    assert decoded == (expected.mode, WIDTH, HEIGHT, expected.tobytes())


@pytest.mark.parametrize(
    ("body", "message"),
    [
        (b"1 2 3", "it ends before its 4 levels"),
        (b"1 2 3           ", "it ends 1 levels before its last one"),
        (b"1 2 256 4", "expected a level from 0 to 255, got b'256'"),
        (b"1 2 -3 4", "expected a level from 0 to 255, got b'-3'"),
        (b"1 " + b"2" * 99 + b" 3 4", f"expected a level from 0 to 255, got b'{'2' * 20}'"),
        (b"1 " + b"0" * 11 + b" 3 4", "expected a level from 0 to 255, got b'00000000000'"),
        (b"1 2 3 x", "expected a level from 0 to 255, got b'x'"),
    ],
)
@pytest.mark.parametrize("chunk", [2**16, 32])
def test_damaged_levels_are_refused(body: bytes, message: str, chunk: int, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(plain_pnm, "CHUNK", chunk)
    with pytest.raises(DecodingError, match="is a damaged picture") as error:
        decoder.decode(b"P2 2 2 255\n" + body)
    assert message in str(error.value)


def test_each_byte_is_read_a_few_times_at_most(monkeypatch: pytest.MonkeyPatch) -> None:
    read = 0

    class Text(bytes):
        def __getitem__(self, place: slice) -> bytes:  # type: ignore[override]
            nonlocal read
            part = super().__getitem__(place)
            read += len(part)
            return part

    monkeypatch.setattr(plain_pnm, "CHUNK", 64)
    text = Text(b"12 " * 5000)
    assert plain_pnm.read_levels(text, 0, 5000, plain_pnm.Levels(255, 255, 1)) == b"\x0c" * 5000
    assert read < 2 * len(text)
