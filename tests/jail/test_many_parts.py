"""Files of many small parts, for each of which Pillow runs some Python, are refused after a million of them."""

from __future__ import annotations

import zlib
from struct import pack

import numpy as np
import pytest

from minirt.jail import decoder, helper
from minirt.jail.decoder import DecodingError
from minirt.jail.helper import Helper
from tests.jail.pictures import FILES, NOISE, PNG

PARTS = 3000
TEXT = b"tEXta\0b"
PLAIN = f"P3\n17 13\n255\n{' '.join(map(str, NOISE.ravel()))}\n".encode()


def after(form: str, beginning: int, part: bytes) -> bytes:
    """Return a file with many equal parts behind its beginning."""
    return FILES[form][:beginning] + part * PARTS + FILES[form][beginning:]


BOMBS = {
    "JPEG, padding of a marker": after("JPEG", 2, b"\xff"),
    "JPEG, comments": after("JPEG", 2, b"\xff\xfe\0\4ab"),
    "PNG, texts": after("PNG", 33, pack(">I", len(TEXT) - 4) + TEXT + pack(">I", zlib.crc32(TEXT))),
    "GIF, comments": after("GIF", 13 + 3 * 2 ** (1 + (FILES["GIF"][10] & 7)), b"\x21\xfe\x01a\0"),
    "PPM, blanks": FILES["PPM"][:3] + b" " * PARTS + FILES["PPM"][3:],
}


@pytest.mark.parametrize("name", BOMBS)
def test_a_file_of_too_many_parts_is_refused(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    assert decoder.decode(BOMBS[name]) == decoder.decode(FILES[name.split(",", maxsplit=1)[0]])
    monkeypatch.setattr(decoder, "MOST_READS", PARTS - 1)
    with pytest.raises(DecodingError, match=r"is a damaged picture \(it has more than 2,999 parts\)"):
        decoder.decode(BOMBS[name])


def test_ordinary_files_have_few_parts(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(decoder, "MOST_READS", 500)
    for name, data in FILES.items():
        assert decoder.decode(data).pixels, name


def test_comments_in_plain_pictures_are_left_out(monkeypatch: pytest.MonkeyPatch) -> None:
    commented = PLAIN.replace(b"\n", b" # 1 2 3\n#\n\n#4\r")
    given: list[bytes] = []

    class File(decoder.File):
        def __init__(self, data: bytes) -> None:
            given.append(data)
            super().__init__(data)

    monkeypatch.setattr(decoder, "File", File)
    for data in (PLAIN, commented, commented + b"#" * 100):
        assert np.frombuffer(decoder.decode(data).pixels, np.uint8).tolist() == NOISE.ravel().tolist()
    assert not any(b"#" in each for each in given)


def test_a_process_that_dies_of_its_first_file_is_not_started_again(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(helper, "COMMAND", (*helper.COMMAND[:4], "raise SystemExit(3)", *helper.COMMAND[5:]))
    starts = []
    original = helper.start
    monkeypatch.setattr(helper, "start", lambda: starts.append(None) or original())
    used = Helper()
    used.start()
    with pytest.raises(DecodingError, match="its decoder ended with status 3"):
        used.decode(PNG)
    assert len(starts) == 1
