"""Send programs signals that ask them to end, at random moments, and check how they end.

python -m tests.cli.ends KIND COUNT [SEED]     # prints each fault, and a line of figures; status 1 with faults

A moment is an amount of processor time that the program and its children have used. A program ends with the documented
status, within `LIMIT`, says no more than what it keeps, and leaves nothing else behind.
"""

from __future__ import annotations

import os
import random
import re
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Sequence
from contextlib import ExitStack, suppress
from pathlib import Path
from typing import Any, NamedTuple

from tests import processes
from tests.cli.program import PROGRAM, environment
from tests.paths import ROOT
from tests.viewer.idle_waits import group
from tests.waiting import HANG_LIMIT, until

SIGNALS = (signal.SIGTERM, signal.SIGINT, signal.SIGHUP)
LIMIT = 3.0  # seconds from a signal to the end, asked for by hand alone
FILM = ("--turntable", "40", "--size", "640x360", "--samples", "64")
CLUSTER = ("--cluster", "local", "-o")
AT_REST = 30  # looks at the processor time, with a pause of up to 0.05 s
KEYS = "press Right\nwait 0.2\n" * 200


class Kind(NamedTuple):
    """A kind of programs: alternative arguments, and seconds of processor time in which the signals come."""

    arguments: tuple[tuple[str, ...], ...]
    longest: float


KINDS = {
    "start": Kind((("--size", "4000x3000", "--samples", "64", "-o", "x.png"),), 0.3),
    "film": Kind(tuple((*FILM, "-o", f"x.{each}") for each in ("gif", "mp4", "webp", "png")), 12.0),
    "cluster": Kind((("--size", "20000x9000", *CLUSTER, "x.tif"), (*FILM, *CLUSTER, "x.gif")), 16.0),
    "report": Kind((("--report", "report", "--quick"),), 10.0),
    "replay": Kind((("--replay", "keys.txt", "--size", "640x360", "-o", "x.gif"),), 8.0),
    "window": Kind(((), ("--size", "1280x720")), 4.0),
}
SAID = re.compile(
    r"\d+ of \d+ (?:pictures of the film|bands of the picture) (?:is|are) kept in (\S+); .* goes on|notice: .*"
    r"|Measuring scene\.rt at 1280x720 pixels with \d+ threads?: about .*"
    r"|Interrupted before anything was measured; no report was written\."
)
REPORTED = re.compile(r"^Interrupted while measuring .* is missing\.\n(?:.*\n)+?The report is in .*\n", re.MULTILINE)


class End(NamedTuple):
    """The end of a program after a signal: its time, and the faults of that end."""

    number: int  # of the signal
    is_handled: bool  # whether the program, and not the system, had a handler of the signal
    seconds: float  # from the signal to the end
    faults: list[str]


def used(program: int) -> float:
    """Return the seconds of processor time that the processes of a program's group have used."""
    total = 0
    for each in group(program):
        for thread in Path(f"/proc/{each}/task").glob("*/schedstat"):
            with suppress(OSError):
                total += int(thread.read_text().split()[0])
    return total / 1e9


def handles(program: int, number: int) -> bool:
    """Whether a program has a handler of a signal."""
    status = Path(f"/proc/{program}/status").read_text()
    caught = next((line for line in status.splitlines() if line.startswith("SigCgt")), "SigCgt: 0")  # it has ended
    return bool(int(caught.split()[1], 16) >> (number - 1) & 1)


def trial(
    kind: str, chance: random.Random, variables: dict[str, str], limit: float = HANG_LIMIT, share: float = 1.0
) -> End:
    """Start a program of a kind, end it by a signal at a random moment, and check its end.

    `variables` of its environment. `limit` in seconds, after which a program hangs. `share` of the span of the kind;
    less than all of it begins when the program has a handler of the signal.
    """
    number, moment = chance.choice(SIGNALS), chance.uniform(0.0, share * KINDS[kind].longest)
    arguments = chance.choice(KINDS[kind].arguments)
    is_for_all = chance.random() < 0.5  # processes of the program, as Ctrl+C in a terminal, its end and `timeout`
    with ExitStack() as stack:
        home, folder = (Path(stack.enter_context(tempfile.TemporaryDirectory())) for _ in range(2))
        for each in ("tmp", "state"):
            (home / each).mkdir()
        (folder / "scene.rt").write_bytes((ROOT / "scenes" / "demo.rt").read_bytes())
        (folder / "keys.txt").write_text(KEYS)
        variables = variables | {"TMPDIR": str(home / "tmp"), "XDG_STATE_HOME": str(home / "state")}
        errors = stack.enter_context((home / "errors").open("w"))
        command = [*PROGRAM, "scene.rt", *arguments]
        process = stack.enter_context(
            processes.started(command, cwd=folder, env=variables, stdout=subprocess.DEVNULL, stderr=errors)
        )

        looks: list[float] = []  # at the time used, which no more changes in a window that is at rest

        def is_time() -> bool:
            looks.append(round(used(process.pid), 2))  # a thread that watches the file uses less
            is_over = looks[-1] >= moment or looks[-AT_REST:] == looks[-1:] * AT_REST
            # Python itself has a handler of Ctrl+C.
            is_handled = handles(process.pid, signal.SIGTERM)
            return process.poll() is not None or (is_over and (share == 1 or is_handled))

        until(is_time, "the moment of a signal")
        if process.poll() is not None:
            told = (home / "errors").read_text()
            return End(number, True, 0.0, [f"ended by itself: {process.returncode}\n{told}"])
        is_handled = handles(process.pid, signal.SIGTERM)
        start = time.monotonic()
        if is_for_all:
            processes.kill_group(process, number)
        else:
            process.send_signal(number)
        faults = check_end(process, number, is_handled, limit)
        seconds = time.monotonic() - start
        told = (home / "errors").read_text()
        faults += check_traces(folder, home, arguments, told)
        about = f"{signal.Signals(number).name}{' to all' * is_for_all} after {moment:.3f} s of {' '.join(arguments)}"
        told = "\n".join(told.splitlines()[-60:])
        return End(number, is_handled, seconds, [f"{about}: {'; '.join(faults)}\n{told}"] if faults else [])


def check_end(process: subprocess.Popen[Any], number: int, is_handled: bool, limit: float) -> list[str]:
    """Return what is wrong with the end of a program after a signal."""
    faults = []
    try:
        status = process.wait(limit)
        if status != 128 + number and (is_handled or status != -number):
            faults.append(f"status {status}")
    except subprocess.TimeoutExpired:
        faults.append("hangs")
        states = [Path(f"/proc/{each}/stat").read_text().split()[2] for each in group(process.pid)]
        faults.append(f"processes {states}")
        os.kill(process.pid, signal.SIGABRT)
        process.wait()
    start = time.monotonic()
    while (left := group(process.pid)) and time.monotonic() < start + min(limit, LIMIT):
        time.sleep(0.01)
    return faults + [f"{len(left)} processes left"] * bool(left)


def check_traces(folder: Path, home: Path, arguments: Sequence[str], told: str) -> list[str]:
    """Return what is wrong with what a program has said and left."""
    lines = [SAID.fullmatch(line) for line in REPORTED.sub("", told).splitlines()]
    faults = [] if all(lines) else ["says more than it should"]
    kept = {line[1] for line in lines if line and line[1]}
    left = {str(each.relative_to(folder)) for each in folder.rglob("*")} - {"scene.rt", "keys.txt"}
    allowed = {"report"} if "report" in arguments and "while measuring" in told else set()
    unfit = {each for each in left ^ kept if each.split("/")[0] not in allowed or each.endswith(".tmp")}
    unfit = {each for each in unfit if not re.fullmatch(r"x-\d{4}\.png", each)}
    unfit |= {str(each.relative_to(home)) for part in ("tmp", "state") for each in (home / part).rglob("*")}
    unfit -= {"state/minirt"}
    return faults + [f"left or missing: {sorted(unfit)}"] * bool(unfit)


def main(kind: str, count: int, seed: int = 1) -> int:
    """Run the trials and print their faults."""
    chance, ends = random.Random(seed), list[End]()
    with ExitStack() as stack:
        variables = environment()
        if kind == "window":
            from tests.windows import open_desktop

            variables = variables | stack.enter_context(open_desktop()).environment
        for number in range(count):
            ends.append(trial(kind, chance, variables, 3 * LIMIT))
            for each in ends[-1].faults:
                print(f"{number}: {each}", flush=True)
    faulty, early = sum(bool(each.faults) for each in ends), sum(not each.is_handled for each in ends)
    late = [each.seconds for each in ends if each.seconds > LIMIT]
    print(f"{kind}: {count} signals, {faulty} with faults, {early} before a handler, {len(late)} beyond {LIMIT:.0f} s")
    print("seconds:", *(f"{each:.2f}" for each in sorted(each.seconds for each in ends)[-5:]))
    return int(faulty > 0 or bool(late))


if __name__ == "__main__":
    sys.exit(main(sys.argv[1], int(sys.argv[2]), *map(int, sys.argv[3:])))
