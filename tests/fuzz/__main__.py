"""Fuzz for a number of seconds; exit with status 1 where an input crashed, hung or had a wrong verdict.

python -m tests.fuzz 60                    # seconds
python -m tests.fuzz 3600 7 scenes meshes  # with another seed, and some fuzzers alone
python -m tests.fuzz --input scenes FILE   # check an input that was kept in out/fuzz

The same seed gives the same inputs. `make fuzz SECONDS=60 SEED=7` does the same. An input stands in a file before it is
checked, so that it is not lost where a library ends the whole process.
"""

from __future__ import annotations

import faulthandler
import os
import sys
import time
import traceback
from collections import Counter
from contextlib import suppress
from pathlib import Path

from tests import environment
from tests.fuzz import inputs, names, scenes
from tests.fuzz.mutations import Fuzzer, seeded
from tests.guards import must_end
from tests.paths import ROOT

FUZZERS = {
    "scenes": scenes.SCENES,
    "names": names.NAMES,
    "meshes": inputs.MESHES,
    "pictures": inputs.PICTURES,
    "replays": inputs.REPLAYS,
    "arguments": inputs.ARGUMENTS,
    "extremes": scenes.EXTREMES,
}
OUT = ROOT / "out" / "fuzz"
SECONDS, SEED = "60", "1"
FAILURES = {TimeoutError: "hangs", AssertionError: "wrong verdicts", Exception: "crashes"}
MOST_KEPT = 20  # inputs that failed


def attempt(fuzzer: Fuzzer, name: str, number: int) -> str:
    """Check one input; return the verdict on it, or the failure, whose input and traceback are kept."""
    data = fuzzer.make(seeded(name, number))
    (OUT / f"{name}-current").write_bytes(data)
    try:
        with must_end():
            return fuzzer.check(data)
    except Exception as error:
        failure = next(word for kind, word in FAILURES.items() if isinstance(error, kind))
        if len(list(OUT.glob("*.txt"))) < MOST_KEPT:
            (OUT / f"{name}-{number}").write_bytes(data)
            (OUT / f"{name}-{number}.txt").write_text(f"{failure}\n{traceback.format_exc()}", encoding="utf-8")
        return failure


def fuzz(seconds: float, seed: int, names: list[str]) -> dict[str, Counter[str]]:
    """Run fuzzers for equal times, until the seconds are over, or until Ctrl+C; count the verdicts of each."""
    counts = {name: Counter[str]() for name in names}
    spent = dict.fromkeys(names, 0.0)
    with suppress(KeyboardInterrupt):
        while sum(spent.values()) < seconds:
            name = min(spent, key=spent.__getitem__)
            start = time.monotonic()
            counts[name][attempt(FUZZERS[name], name, seed * 10**9 + counts[name].total())] += 1
            spent[name] += time.monotonic() - start
    return counts


def table(counts: dict[str, Counter[str]]) -> str:
    """Return a line for each fuzzer: its inputs and their verdicts."""
    return "\n".join(
        f"{name:<10} {each.total():>9,} inputs: "
        + ", ".join(f"{count:,} {verdict}" for verdict, count in sorted(each.items()))
        for name, each in counts.items()
    )


def main(arguments: list[str]) -> int:
    """Fuzz, or check one input; return the exit status."""
    if arguments[:1] == ["--input"]:
        print(FUZZERS[arguments[1]].check(Path(arguments[2]).read_bytes()))
        return 0
    seconds, seed, *names = arguments + [SECONDS, SEED][len(arguments) :]
    counts = fuzz(float(seconds), int(seed), names or list(FUZZERS))
    print(table(counts))
    failed = any(each[failure] for each in counts.values() for failure in FAILURES.values())
    if failed:
        print(f"The inputs that failed are in {OUT}.")
    return int(failed)


if __name__ == "__main__":
    environment.prepare()
    OUT.mkdir(parents=True, exist_ok=True)
    with (OUT / "stderr").open("w") as told:  # what decoders print, and the stack after a crash
        os.dup2(told.fileno(), sys.stderr.fileno())
        faulthandler.enable()
        sys.exit(main(sys.argv[1:]))
