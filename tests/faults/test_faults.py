"""Any operation on files fails, or the program is killed there: old or new files, one sentence, and no traceback.

A random sample of all faults; `python -m tests.faults` tries each.
"""

from __future__ import annotations

import random
from contextlib import nullcontext, suppress
from pathlib import Path

import pytest

from minirt.helpers import file_io
from minirt.helpers.file_io import writing
from tests.faults.calls import UNUSABLE
from tests.faults.judge import Judge
from tests.faults.supervised import KILL, Fault, run
from tests.faults.workloads import NAMES, Laboratory, Workload
from tests.seeds import seed_of

SAMPLE = 8  # faults of each workload: a third of a minute in all

pytestmark = [
    pytest.mark.filterwarnings("ignore:.*multi-threaded:DeprecationWarning"),  # what Python 3.12 says of a fork
    pytest.mark.skipif(bool(UNUSABLE), reason=UNUSABLE or "none"),
]


@pytest.fixture(scope="module")
def laboratory(tmp_path_factory: pytest.TempPathFactory) -> Laboratory:
    """A folder for faulty work; the tests are skipped where the system lets no process answer another's calls."""
    folder = tmp_path_factory.mktemp("faults").resolve()
    try:
        run(lambda: 0, folder)
    except OSError as error:
        pytest.skip(f"the system allows no seccomp filter with a listener: {error}")
    return Laboratory(folder)


@pytest.fixture(scope="module")
def workloads(laboratory: Laboratory) -> dict[str, Workload]:
    return {each.name: each for each in laboratory.workloads()}


@pytest.mark.parametrize("name", NAMES)
def test_a_fault_leaves_old_or_new_files_and_is_one_sentence(
    name: str, laboratory: Laboratory, workloads: dict[str, Workload]
) -> None:
    seed = seed_of(f"faults of {name}")
    judge = Judge(laboratory, workloads[name])
    wrong = [judge.verdict(each) for each in random.Random(seed).sample(judge.faults(), SAMPLE)]
    assert not list(filter(None, wrong)), f"seed {seed}"


def test_all_workloads_are_named(workloads: dict[str, Workload]) -> None:
    assert tuple(workloads) == NAMES


# Wrong variants, each with a fault that shows it.


def in_place(path: Path, data: bytes, permissions: int | None = None) -> None:
    """Write over an old file."""
    Path(path).write_bytes(data[:100])
    with Path(path).open("ab") as file:
        file.write(data[100:])


def planted(variant: str, patch: pytest.MonkeyPatch) -> None:
    """Let this process write files in a wrong way."""
    if variant == "in place":
        patch.setattr(file_io, "write", in_place)
    elif variant == "left":
        patch.setattr(writing, "delete", lambda *_: None)
    elif variant == "silent":
        patch.setattr(file_io, "told_errors", lambda *_: suppress(OSError))
    else:
        patch.setattr(file_io, "told_errors", lambda *_: nullcontext())


@pytest.mark.parametrize(
    ("variant", "kind", "told"),
    [
        ("in place", KILL, "out.png is neither old nor new"),
        ("left", "EIO", "is left"),
        ("silent", "EIO", "out.png is not new"),
        ("raised", "EIO", "a traceback"),
    ],
)
def test_a_wrong_variant_is_noticed(
    variant: str, kind: str, told: str, laboratory: Laboratory, workloads: dict[str, Workload]
) -> None:
    with pytest.MonkeyPatch.context() as patch:
        planted(variant, patch)
        judge = Judge(laboratory, workloads["picture"])
        last = len(judge.operations) - judge.operations[::-1].index("write")
        assert any(told in judge.verdict(Fault(number, kind)) for number in range(last, last + 3))
