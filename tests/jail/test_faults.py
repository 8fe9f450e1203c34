"""Helper processes that end, stop or lie at each stage of an answer: every one costs an error message, and no more."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from collections.abc import Iterator
from itertools import count
from pathlib import Path
from random import Random

import pytest

from minirt.jail import helper, messages, pipes
from minirt.jail.decoder import BYTES, SIDE, Decoded, DecodingError
from minirt.jail.helper import Helper
from minirt.jail.messages import ANSWER, BrokenAnswerError, read_answer
from tests.cli.program import environment
from tests.jail.pictures import PNG
from tests.lines import next_line
from tests.processes import is_running, started
from tests.waiting import HANG_LIMIT, until

# A process that speaks as the helper does, without decoding, and that meets its fault at one stage.
FAKE = """
import os, signal, struct, sys
stage, fault = sys.argv[1:]
def reached(name):
    if name == stage:
        if fault == "stop":
            os.kill(os.getpid(), signal.SIGSTOP)
        elif fault == "sleep":
            signal.pause()
        elif fault == "kill":
            os.kill(os.getpid(), signal.SIGKILL)
        os._exit(int(fault))
reached("start")
while request := os.read(0, 8):
    reached("request")
    size = struct.unpack("<Q", request)[0]
    if size > 100:
        os.read(0, 100)
        size -= 100
        reached("half of the file")
    while size:
        size -= len(os.read(0, size))
    reached("file")
    header = struct.pack("<?5sHHI", True, b"RGB", 2, 1, 6)
    os.write(1, header[:5])
    reached("half of the header")
    os.write(1, header[5:])
    reached("header")
    os.write(1, b"123")
    reached("half of the pixels")
    os.write(1, b"456")
    reached("answer")
"""
STAGES = ("start", "request", "half of the file", "file", "half of the header", "header", "half of the pixels")
LARGE = PNG + bytes(2**18)  # more than a pipe takes
ENDS = {"0": "ended with status 0", "7": "ended with status 7", "kill": "ended with SIGKILL"}

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="Windows has no such signals")


def plant(monkeypatch: pytest.MonkeyPatch, stage: str, fault: str) -> None:
    """Start helpers that meet a fault at a stage."""
    monkeypatch.setattr(helper, "COMMAND", (sys.executable, "-S", "-c", FAKE, stage, fault))


@pytest.fixture
def used() -> Iterator[Helper]:
    """A helper that ends with the test."""
    used = Helper()
    yield used
    used.stop()


def test_without_a_fault_the_fake_answers(monkeypatch: pytest.MonkeyPatch, used: Helper) -> None:
    plant(monkeypatch, "none", "0")
    for data in (PNG, LARGE):
        assert used.decode(data) == (Decoded("RGB", 2, 1, b"123456"), True)


@pytest.mark.parametrize("stage", STAGES)
def test_a_helper_that_ends_is_an_error(monkeypatch: pytest.MonkeyPatch, used: Helper, stage: str) -> None:
    for fault, words in ENDS.items():
        plant(monkeypatch, stage, fault)
        with pytest.raises(DecodingError, match=words):
            used.decode(LARGE)
        assert used.process is None


@pytest.mark.parametrize("stage", STAGES)
def test_a_helper_that_does_nothing_is_an_error(monkeypatch: pytest.MonkeyPatch, used: Helper, stage: str) -> None:
    monkeypatch.setattr(pipes, "LONGEST_WAIT", pipes.SLICE / 100)
    for fault in ("stop", "sleep"):
        plant(monkeypatch, stage, fault)
        process = used.start()
        with pytest.raises(DecodingError, match="its decoder gives no answer"):
            used.decode(LARGE)
        assert process.returncode == -signal.SIGKILL
        assert used.process is None


def test_a_helper_that_is_done_for_is_replaced(monkeypatch: pytest.MonkeyPatch, used: Helper) -> None:
    for fault in ("0", "kill"):
        plant(monkeypatch, "answer", fault)
        for _ in range(3):
            assert used.decode(PNG)[0].pixels == b"123456"


def test_a_byte_now_and_then_does_not_lengthen_the_wait(monkeypatch: pytest.MonkeyPatch, used: Helper) -> None:
    drip = "import os\nos.write(1, bytes.fromhex(%r))\nwhile True: os.write(1, b'x')"
    header = ANSWER.pack(True, b"RGB", SIDE, SIDE, 3 * SIDE * SIDE)
    monkeypatch.setattr(helper, "COMMAND", (sys.executable, "-S", "-c", drip % header.hex()))
    monkeypatch.setattr(pipes, "SLICE", 2.0**-10)
    monkeypatch.setattr(pipes, "LONGEST_WAIT", 20 * pipes.SLICE)
    monkeypatch.setattr(pipes, "monotonic", count().__next__)  # a second passes before each byte
    with pytest.raises(DecodingError, match="gives no answer"):
        used.decode(PNG)


def test_time_in_which_the_program_is_stopped_does_not_count(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(pipes, "SLICE", 2.0**-10)
    monkeypatch.setattr(pipes, "LONGEST_WAIT", 10 * pipes.SLICE)
    looks = count(0, 1000)  # a thousand seconds pass between two looks at the clock
    monkeypatch.setattr(pipes, "monotonic", looks.__next__)
    empty, other = os.pipe()
    with os.fdopen(empty, "rb", 0) as pipe, os.fdopen(other, "wb", 0), pytest.raises(pipes.LateError):
        pipes.Patience().read(pipe, 1)
    assert next(looks) == 1000 * 11


def test_a_helper_that_hangs_on_to_its_pipes_by_another_process(
    monkeypatch: pytest.MonkeyPatch, used: Helper, tmp_path: Path
) -> None:
    """A decoder may leave a process behind, which keeps the pipes open, where no filter forbids it."""
    note = f"open({str(tmp_path / 'pid')!r}, 'w').write(str(os.getpid()))"
    source = f"import os, signal\nif os.fork(): os._exit(0)\n{note}\nsignal.pause()"
    monkeypatch.setattr(helper, "COMMAND", (sys.executable, "-S", "-c", source))
    process = used.start()
    until(lambda: (tmp_path / "pid").exists() and (tmp_path / "pid").read_text() != "", "the process")
    monkeypatch.setattr(pipes, "LONGEST_WAIT", pipes.SLICE / 100)
    with pytest.raises(DecodingError, match="gives no answer"):
        used.decode(LARGE)
    assert process.returncode == 0
    until(lambda: not is_running(int((tmp_path / "pid").read_text())), "the end of the process")


PROGRAM = """
import sys
from minirt.cli import main
from minirt.jail import helper
helper.COMMAND = (sys.executable, "-S", "-c", {fake!r}, "file", "sleep")
start = helper.start
def noted():
    process = start()
    print(process.pid, flush=True)
    return process
helper.start = noted
sys.exit(main())
"""


def test_ctrl_c_ends_the_wait_and_the_helper(tmp_path: Path) -> None:
    (tmp_path / "a.png").write_bytes(PNG)
    (tmp_path / "a.rt").write_text("A 1 1,2,3\nC 0,0,0 0,0,1 60\nsp 0,0,9 2 1,2,3 texture:a.png\n")
    command = [sys.executable, "-c", PROGRAM.format(fake=FAKE), "a.rt", "--check", "--no-trust"]
    options = {"cwd": tmp_path, "env": environment(), "stdout": subprocess.PIPE, "text": True}
    with started(command, stderr=subprocess.PIPE, **options) as program:
        child = int(next_line(program))
        until(lambda: state_of(child) == "S", "the wait of the helper")
        program.send_signal(signal.SIGINT)
        _, err = program.communicate(timeout=HANG_LIMIT)
    assert "Traceback" not in err
    assert program.returncode in {130, -signal.SIGINT}
    assert not is_running(child)


def state_of(process: int) -> str:
    """Return the state of a process, as Linux calls it."""
    return Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()[0]


def random_answer(random: Random) -> bytes:
    """Return bytes that are, or nearly are, an answer."""
    mode = random.choice([*map(str.encode, BYTES), messages.REASON, random.randbytes(5)])
    width, height = (random.choice([0, 1, 2, 3, SIDE, SIDE + 1, 65535]) for _ in "wh")
    right = BYTES.get(mode.decode("latin-1"), 1) * width * height
    size = random.choice([right, right, 0, 5, 400, 401, 2**32 - 1]) % 2**32
    content = random.randbytes(min(max(size + random.choice([0, 0, -1, 1]), 0), 500))
    answer = ANSWER.pack(random.random() < 0.5, mode, width, height, size) + content
    return answer[: random.choice([len(answer), random.randrange(len(answer))])]


def test_random_answers_are_right_or_broken() -> None:
    random, verdicts = Random(1), set()
    for _ in range(5000):
        data = random_answer(random)
        asked: list[int] = []

        def read(size: int, data: bytes = data, asked: list[int] = asked) -> bytearray:
            asked.append(size)
            return bytearray(data[sum(asked[:-1]) : sum(asked)])

        try:
            answer, _ = read_answer(read)
        except BrokenAnswerError:
            verdicts.add("broken")
            continue
        verdicts.add(type(answer).__name__)
        assert sum(asked) <= len(data)
        if isinstance(answer, Decoded):
            assert 0 < answer.width <= SIDE
            assert 0 < answer.height <= SIDE
            assert len(answer.pixels) == BYTES[answer.mode] * answer.width * answer.height
        else:
            assert len(str(answer)) <= messages.LONGEST_REASON
    assert verdicts == {"broken", "Decoded", "DecodingError"}
