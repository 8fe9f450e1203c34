"""Process that runs one fuzzer until its time is over, and prints what it counted; a crash ends this process alone.

Before an input is checked it stands in a file, so that it is not lost with the process.
"""

from __future__ import annotations

import json
import sys
import time
import traceback
from collections import Counter
from pathlib import Path

from tests import environment
from tests.fuzz import inputs, scenes
from tests.fuzz.mutations import Fuzzer, seeded
from tests.guards import must_end

FUZZERS = {
    "scenes": scenes.SCENES,
    "meshes": inputs.MESHES,
    "pictures": inputs.PICTURES,
    "replays": inputs.REPLAYS,
    "arguments": inputs.ARGUMENTS,
    "extremes": scenes.EXTREMES,
}
MOST_KEPT = 20  # inputs that failed


def fuzz(name: str, first: int, seconds: float, folder: Path) -> Counter[str]:
    """Check inputs of a fuzzer, from number `first` on; count their verdicts and failures."""
    end, number, counts = time.monotonic() + seconds, first, Counter[str]()
    while time.monotonic() < end:
        outcome = attempt(FUZZERS[name], name, number, folder)
        counts[outcome] += 1
        number += 1
    return counts


def attempt(fuzzer: Fuzzer, name: str, number: int, folder: Path) -> str:
    """Check one input; return the verdict on it, or the failure, whose input is kept."""
    data = fuzzer.make(seeded(name, number))
    current = folder / f"{name}-current"
    current.write_bytes(data)
    try:
        with must_end():
            return fuzzer.check(data)
    except TimeoutError:
        return keep(current, "hangs", number)
    except AssertionError:
        return keep(current, "wrong verdicts", number)
    except Exception:
        return keep(current, "crashes", number)


def keep(current: Path, failure: str, number: int) -> str:
    """Keep an input that failed, with the traceback; return the failure."""
    kept = current.with_name(current.name.replace("current", str(number)))
    if len(list(kept.parent.glob("*.txt"))) < MOST_KEPT:
        kept.write_bytes(current.read_bytes())
        kept.with_name(f"{kept.name}.txt").write_text(f"{failure}\n{traceback.format_exc()}", encoding="utf-8")
    return failure


if __name__ == "__main__":
    environment.prepare()
    print(json.dumps(fuzz(sys.argv[1], int(sys.argv[2]), float(sys.argv[3]), Path(sys.argv[4]))))
