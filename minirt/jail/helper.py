"""The helper process, as this program sees it: it takes the bytes of a picture file, and returns the pixels."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from contextlib import suppress
from pathlib import Path

from minirt.jail.decoder import Decoded, DecodingError
from minirt.jail.messages import CPU_TIME, REQUEST, BrokenAnswerError, read_answer
from minirt.jail.pipes import LONGEST_WAIT, LateError, Patience, ended_when_late, prepare

# Empty packages take the place of `minirt` and `minirt.jail`, whose own modules would take 15 ms to import.
START = """
import sys
from types import ModuleType
for name, folder in zip(("minirt", "minirt.jail"), sys.argv[1:]):
    sys.modules[name] = ModuleType(name)
    sys.modules[name].__path__ = [folder]
from minirt.jail import stand_ins
stand_ins.install()
from minirt.jail.process import main
main()
"""
FOLDER = Path(__file__).parent
# Without the modules of `site`, and with nothing imported from the current folder.
COMMAND = (sys.executable, "-S", "-P", "-c", START, str(FOLDER.parent), str(FOLDER))
# Environment variables by which Python and its libraries are found.
NEEDED = ("PATH", "LD_LIBRARY_PATH", "SYSTEMROOT", "PYTHONHOME", "PYTHONDONTWRITEBYTECODE")


class Helper:
    """A helper process, started by its first picture. It is used by one thread at a time."""

    def __init__(self) -> None:
        self.process: subprocess.Popen[bytes] | None = None
        self.is_used = False  # whether the process has answered

    def decode(self, data: bytes) -> tuple[Decoded, bool]:
        """Return the pixels of a file, and whether its decoder said nothing; DecodingError."""
        if self.process and self.is_used:
            with suppress(BrokenAnswerError):  # the files before it may have used up the process and its time
                return self.ask(self.process, data)
            self.stop()
        try:
            return self.ask(self.process or self.start(), data)
        except BrokenAnswerError:
            status = self.stop()
            raise DecodingError(f"is a damaged picture ({reason_of_end(status)})") from None
        except MemoryError:
            raise DecodingError("needs more memory than there is to decode it") from None

    def ask(self, process: subprocess.Popen[bytes], data: bytes) -> tuple[Decoded, bool]:
        """Send a file to a process and return its answer; DecodingError, or BrokenAnswerError where it gives none."""
        assert process.stdin is not None
        assert process.stdout is not None
        patience, source = Patience(), process.stdout
        try:
            with ended_when_late(process.kill):
                patience.write(process.stdin, REQUEST.pack(len(data)))
                patience.write(process.stdin, data)
                answer, silent = read_answer(lambda size: patience.read(source, size))
        except (OSError, BrokenAnswerError):
            raise BrokenAnswerError from None
        except LateError:
            self.stop()
            raise DecodingError(f"cannot be decoded: its decoder gives no answer for {LONGEST_WAIT:.0f} s") from None
        except BaseException:  # such as Ctrl+C: the rest of the answer must not be taken for that of the next file
            self.stop()
            raise
        self.is_used = True
        if isinstance(answer, DecodingError):
            raise answer
        return answer, silent

    def start(self) -> subprocess.Popen[bytes]:
        """Start the process; DecodingError where that fails."""
        self.process, self.is_used = start(), False
        return self.process

    def stop(self) -> int:
        """End the process, if there is one, and return its status."""
        process, self.process = self.process, None
        if not process:
            return 0
        kill(process)
        for pipe in (process.stdin, process.stdout):
            pipe.close()  # type: ignore[union-attr]
        return process.wait()


def kill(process: subprocess.Popen[bytes]) -> None:
    """Kill a process, and those that it may have started. One that has begun to end keeps its own status."""
    if sys.platform != "win32":
        with suppress(ProcessLookupError, PermissionError):
            os.killpg(process.pid, signal.SIGKILL)
    process.kill()


def start() -> subprocess.Popen[bytes]:
    """Start a process with the modules of this one and without its environment; DecodingError."""
    environment = {name: os.environ[name] for name in NEEDED if name in os.environ}
    environment["PYTHONPATH"] = os.pathsep.join(each or os.curdir for each in sys.path)
    try:
        process = subprocess.Popen(
            COMMAND,
            bufsize=0,
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
            env=environment,
            creationflags=getattr(subprocess, "CREATE_NO_WINDOW", 0),
            process_group=None if sys.platform == "win32" else 0,  # Ctrl+C is for this program alone
        )
    except OSError as error:
        reason = f"cannot be decoded: the process for it does not start ({error.strerror or error})"
        raise DecodingError(f"{reason}; --trust does without") from None
    prepare(process.stdin, process.stdout)  # type: ignore[arg-type]
    return process


def reason_of_end(status: int) -> str:
    """Return in words how a process ended that gave no answer."""
    if status == -getattr(signal, "SIGXCPU", 0):
        return f"decoding it takes more than {CPU_TIME} s"
    try:
        return f"its decoder ended with {signal.Signals(-status).name}"
    except ValueError:
        return f"its decoder ended with status {status}"
