"""The helper process decodes as this process does; whatever becomes of it, a file is read or refused."""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

from minirt.errors import FileError
from minirt.jail import decoder, helper, messages
from minirt.jail.decoder import DecodingError
from minirt.jail.helper import Helper
from minirt.materials.picture_cache import picture
from tests.jail.pictures import FILES, PNG, WITH_COMPLAINTS

# What a decoder does that an attacker has taken over, in place of decoding.
PLANTED = """
import ctypes, os, sys
from minirt.jail import confinement, decoder, messages, process
confinement.CPU_TIME = 1
real = decoder.decode

def decode(data):
    if not data.endswith(b"attack"):
        return real(data)
    out = sys.stdout.buffer
    {attack}

decoder.decode = decode
process.main()
"""
ATTACKS = {
    "crash": ("ctypes.string_at(0)", "is a damaged picture (its decoder ended with SIGSEGV)"),
    "end": ("os._exit(3)", "is a damaged picture (its decoder ended with status 3)"),
    "spin": ("while True: pass", "is a damaged picture (decoding it takes more than 60 s)"),
    "memory": ("bytes(3 * 2**30)", "is a damaged picture (its decoder ended with status 1)"),
    "too large": (
        "out.write(messages.ANSWER.pack(True, b'RGB', 8193, 1, 3 * 8193)); out.flush(); os._exit(0)",
        "is a damaged picture (its decoder ended with ",
    ),
    "another length": (
        "out.write(messages.ANSWER.pack(True, b'RGB', 2, 2, 2**31)); out.flush(); os._exit(0)",
        "is a damaged picture (its decoder ended with ",
    ),
    "unknown pixels": (
        "out.write(messages.ANSWER.pack(True, b'RGBX', 1, 1, 4) + b'1234'); out.flush(); os._exit(0)",
        "is a damaged picture (its decoder ended with ",
    ),
    "half an answer": (
        "out.write(messages.ANSWER.pack(True, b'RGB', 2, 2, 12) + b'1'); out.flush(); os._exit(0)",
        "is a damaged picture (its decoder ended with ",
    ),
    "words": (r"raise decoder.DecodingError('\033[2J' * 1000)", "[2J [2J"),
}


@pytest.fixture
def used() -> Iterator[Helper]:
    """A helper that ends with the test."""
    used = Helper()
    yield used
    used.stop()


def test_all_formats_are_decoded_as_in_this_process(used: Helper) -> None:
    for name, data in FILES.items():
        assert used.decode(data) == (decoder.decode(data), True), name


def test_a_new_process_decodes_each_format() -> None:
    for data in FILES.values():
        each = Helper()
        assert each.decode(data)[0] == decoder.decode(data)
        each.stop()


def test_one_process_decodes_many_files(used: Helper) -> None:
    used.decode(PNG)
    process = used.process
    for _ in range(5):
        used.decode(PNG)
        with pytest.raises(DecodingError, match="damaged"):
            used.decode(PNG[:100])
    assert used.process is process


@pytest.mark.parametrize(
    "data", [b"sp 0,0,0 1 1,2,3", PNG[:200], b"\x89PNG\r\n", b"BM", b"II*\0nonsense", b"\xff\xd8\xff"]
)
def test_reasons_are_those_of_this_process(used: Helper, data: bytes) -> None:
    with pytest.raises(DecodingError) as expected:
        decoder.decode(data)
    with pytest.raises(DecodingError) as found:
        used.decode(data)
    assert str(found.value) == str(expected.value)


@pytest.mark.skipif(sys.platform != "linux", reason="processes are confined on Linux")
@pytest.mark.parametrize("attack", ATTACKS)
def test_an_attack_costs_an_error_message(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, attack: str) -> None:
    action, reason = ATTACKS[attack]
    planted = helper.START.replace("from minirt.jail.process import main\nmain()", PLANTED.format(attack=action))
    monkeypatch.setattr(helper, "COMMAND", (*helper.COMMAND[:4], planted, *helper.COMMAND[5:]))
    (tmp_path / "good.png").write_bytes(PNG)
    (tmp_path / "bad.png").write_bytes(PNG + b"attack")
    with pytest.raises(FileError) as caught:
        picture(tmp_path / "bad.png")
    assert reason in caught.value.reason
    assert caught.value.reason.isprintable()
    assert len(caught.value.reason) < 2 * messages.LONGEST_REASON
    assert picture(tmp_path / "good.png").shape == (13, 17, 3)


def test_a_process_that_died_between_two_files_is_replaced(used: Helper) -> None:
    used.decode(PNG)
    assert used.process
    used.process.kill()
    used.process.wait()
    assert used.decode(PNG)[0] == decoder.decode(PNG)


def test_complaints_of_decoders_are_noticed_and_not_shown(used: Helper, capfd: pytest.CaptureFixture[str]) -> None:
    assert not used.decode(WITH_COMPLAINTS)[1]
    assert used.decode(PNG)[1]
    assert capfd.readouterr().err == ""
    decoder.decode(WITH_COMPLAINTS)
    assert capfd.readouterr().err  # so it does complain


def test_a_helper_that_cannot_start_is_an_error(monkeypatch: pytest.MonkeyPatch, used: Helper) -> None:
    monkeypatch.setattr(helper, "COMMAND", ("/missing/python",))
    with pytest.raises(DecodingError, match=r"does not start \(No such file or directory\); --trust does without"):
        used.decode(PNG)


def test_the_environment_stays_outside(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("TOKEN", "secret")
    source = "import os; print(*os.environ)"
    monkeypatch.setattr(helper, "COMMAND", (sys.executable, "-c", source))
    process = helper.start()
    out, _ = process.communicate()
    assert b"PYTHONPATH" in out
    assert b"TOKEN" not in out


def test_descriptors_of_the_program_stay_outside(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    write = "try: os.write(each, b'attack')\n    except OSError: pass"
    source = f"import os\nfor each in range(3, 200):\n    {write}\nprint('done')"
    monkeypatch.setattr(helper, "COMMAND", (sys.executable, "-c", source))
    with (tmp_path / "file").open("wb") as file:
        os.set_inheritable(file.fileno(), True)
        assert helper.start().communicate()[0] == b"done\n"
    assert (tmp_path / "file").read_bytes() == b""
