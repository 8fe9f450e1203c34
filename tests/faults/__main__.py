"""Let each operation on files fail in each way: python -m tests.faults [WORKLOAD...]

It prints what is wrong, and counts of operations and cases. The status is 1 where something is wrong.
"""

from __future__ import annotations

import sys
import tempfile
from collections import Counter
from pathlib import Path

from tests import environment
from tests.faults.judge import Judge
from tests.faults.workloads import Laboratory


def main(names: list[str]) -> int:
    """Try all faults of the workloads of these names, by default of all."""
    environment.prepare()
    wrong = Counter[str]()
    with tempfile.TemporaryDirectory(prefix="minirt-faults-") as folder:
        laboratory = Laboratory(Path(folder).resolve())
        for workload in laboratory.workloads():
            if names and workload.name not in names:
                continue
            judge, kinds = Judge(laboratory, workload), Counter[str]()
            for fault in judge.faults():
                verdict = judge.verdict(fault)
                kinds[fault.kind] += 1
                if verdict:
                    wrong[workload.name] += 1
                    print(verdict, flush=True)
            cases = ", ".join(f"{count} {kind}" for kind, count in kinds.items())
            operations = ", ".join(f"{count} {name}" for name, count in Counter(judge.operations).most_common())
            print(f"{workload.name}: {len(judge.operations)} operations ({operations})")
            print(f"    {kinds.total()} cases ({cases}), {wrong[workload.name]} wrong", flush=True)
    return int(wrong.total() > 0)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
