"""Fuzz for a number of seconds; exit with status 1 where an input crashed, hung or had a wrong verdict.

python -m tests.fuzz 60                    # seconds
python -m tests.fuzz 3600 7 scenes meshes  # with another seed, and some fuzzers alone
python -m tests.fuzz --input scenes FILE   # check an input that was kept in out/fuzz

The same seed gives the same inputs. `make fuzz SECONDS=60 SEED=7` does the same.
"""

from __future__ import annotations

import json
import subprocess
import sys
from collections import Counter
from contextlib import suppress
from pathlib import Path

from tests.fuzz.worker import FUZZERS
from tests.paths import ROOT
from tests.processes import started
from tests.waiting import HANG_LIMIT

OUT = ROOT / "out" / "fuzz"
SECONDS, SEED = "60", "1"
SLICE = 20.0  # seconds of a process, after which the next fuzzer has its turn
FAILURES = ("crashes", "hangs", "wrong verdicts")


def run_slice(name: str, first: int, seconds: float) -> Counter[str]:
    """Run a fuzzer in a process of its own; a process that dies or hangs is one failure."""
    command = [sys.executable, "-m", "tests.fuzz.worker", name, str(first), str(seconds), str(OUT)]
    current = OUT / f"{name}-current"
    with (
        (OUT / f"{name}-stderr").open("w") as errors,
        started(command, cwd=ROOT, stdout=subprocess.PIPE, stderr=errors) as process,
    ):
        try:
            out, _ = process.communicate(timeout=seconds + 2 * HANG_LIMIT)
        except subprocess.TimeoutExpired:
            current.replace(OUT / f"{name}-hung-{first}")
            return Counter(hangs=1)
    if process.returncode:
        (OUT / f"{name}-stderr").replace(OUT / f"{name}-crashed-{first}.txt")
        if current.exists():
            current.replace(OUT / f"{name}-crashed-{first}")
        return Counter(crashes=1)
    return Counter(json.loads(out))


def fuzz(seconds: float, seed: int, names: list[str]) -> dict[str, Counter[str]]:
    """Run fuzzers in turn until the seconds are over, or until Ctrl+C; count the verdicts of each."""
    OUT.mkdir(parents=True, exist_ok=True)
    counts = {name: Counter[str]() for name in names}
    left, turn = seconds, 0
    with suppress(KeyboardInterrupt):
        while left > 0:
            each = min(SLICE, seconds / len(names), left)
            name = names[turn % len(names)]
            counts[name] += run_slice(name, seed * 10**9 + turn * 10**6, each)
            left, turn = left - each, turn + 1
    return counts


def table(counts: dict[str, Counter[str]]) -> str:
    """Return a line for each fuzzer: inputs, failures and verdicts."""
    lines = []
    for name, each in counts.items():
        failures = ", ".join(f"{each[failure]} {failure}" for failure in FAILURES)
        verdicts = ", ".join(f"{count} {verdict}" for verdict, count in sorted(each.items()) if verdict not in FAILURES)
        lines.append(f"{name:<10} {each.total():>9,} inputs: {failures} ({verdicts})")
    return "\n".join(lines)


def main(arguments: list[str]) -> int:
    """Fuzz, or check one input; return the exit status."""
    if arguments[:1] == ["--input"]:
        print(FUZZERS[arguments[1]].check(Path(arguments[2]).read_bytes()))
        return 0
    seconds, seed, *names = arguments + [SECONDS, SEED][len(arguments) :]
    counts = fuzz(float(seconds), int(seed), names or list(FUZZERS))
    print(table(counts))
    failed = any(each[failure] for each in counts.values() for failure in FAILURES)
    if failed:
        print(f"The inputs that failed are in {OUT}.")
    return int(failed)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
