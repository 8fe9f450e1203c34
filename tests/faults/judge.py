"""Judge of the files and the output of faulty work."""

from __future__ import annotations

import io
import signal
from collections.abc import Iterator
from fnmatch import fnmatch

from PIL import Image as pillow  # noqa: N813

from minirt.helpers.file_io.writing import TEMPORARY
from tests.faults.supervised import CRASHED, KILL, KINDS, SHORT, STICKY, Ended, Fault, run
from tests.faults.workloads import SCENE, Files, Laboratory, Workload, contents, surroundings


class Judge:
    """Does one workload with faults, and compares the files with those before and with those of a run without faults.

    `operations` are the names of its operations on files."""

    def __init__(self, laboratory: Laboratory, workload: Workload) -> None:
        self.laboratory, self.workload = laboratory, workload
        self.before = laboratory.base | workload.files
        ended, self.good = self.do(None)
        assert ended.status == 0, f"{workload.name}: {ended}"
        assert not any(fnmatch(name, f"*{TEMPORARY}") for name in self.good)
        self.operations = ended.operations

    def do(self, fault: Fault | None, prepared: bool = False) -> tuple[Ended, Files]:
        """Do the work with a fault; return its end and the files after it."""
        folder = self.laboratory.folder if prepared else self.laboratory.prepare(self.workload.files)
        with surroundings(folder):
            ended = run(self.workload.work, folder, fault)
        return ended, contents(folder)

    def verdict(self, fault: Fault) -> str:
        """Do the work with a fault; return what is wrong, with the fault and the output, or ''."""
        ended, files = self.do(fault)
        wrong = [*self.wrong_files(fault, ended, files), *self.wrong_end(fault, ended)]
        if self.workload.is_exact and files.keys() - self.good.keys():
            again, files = self.do(None, prepared=True)
            if again.status or any(files.get(name) != data for name, data in self.outputs.items()):
                wrong.append(f"the same work again: {again.status} {again.output!r}")
        if not wrong:
            return ""
        name = dict(enumerate(ended.operations, 1)).get(fault.number)
        return f"{self.workload.name} {fault.number} {name} {fault.kind}: {wrong} {ended.status} {ended.output!r}"

    def faults(self) -> list[Fault]:
        """Return all faults: each operation fails in each way, and writes can be short."""
        names = enumerate(self.operations, 1)
        return [Fault(number, kind) for number, name in names for kind in KINDS if kind != SHORT or name == "write"]

    @property
    def outputs(self) -> Files:
        """The files that the work makes or changes."""
        return {
            name: data
            for name, data in self.good.items()
            if self.before.get(name) != data and not any(fnmatch(name, each) for each in self.workload.may_leave)
        }

    def wrong_files(self, fault: Fault, ended: Ended, files: Files) -> Iterator[str]:
        """Yield what is wrong with the files."""
        deletes = fault.kind.endswith(STICKY) or "unlink" in "".join(ended.operations[fault.number - 1 : fault.number])
        for name in sorted(files.keys() | self.good.keys() | self.before.keys()):
            data, known = files.get(name), {self.before.get(name), self.good.get(name)}
            if fnmatch(name, f"*{TEMPORARY}"):
                if fault.kind != KILL and not deletes:
                    yield f"{name} is left"
            elif data in known or any(fnmatch(name, each) for each in self.workload.may_leave):
                pass
            elif self.workload.is_exact:
                yield f"{name} is neither old nor new"
            elif data is None and name in self.before:
                yield f"{name} is lost"
            elif data is not None and not is_whole(name, data):
                yield f"{name} is not whole"
        if ended.status == 0:
            for name, data in self.outputs.items():
                is_new = files.get(name) == data if self.workload.is_exact else name in files
                if not (is_new or fnmatch(name, self.workload.may_miss)):
                    yield f"{name} is not new"

    def wrong_end(self, fault: Fault, ended: Ended) -> Iterator[str]:
        """Yield what is wrong with the exit status and the output."""
        lines = [line for line in ended.output.splitlines() if not line.startswith("notice: ")]
        if "Traceback" in ended.output or ended.status == CRASHED:
            yield "a traceback"
        elif ended.status == 1:
            if lines[:1] != ["Error"] or lines.count("Error") > 1 or not lines[1:]:
                yield "not one sentence"
        elif ended.status and (ended.status, fault.kind) != (-signal.SIGKILL, KILL):
            yield "its exit status"


def is_whole(name: str, data: bytes) -> bool:
    """Whether data are a whole picture or film, or a scene with as many lines as the first one has."""
    if name.endswith(".mp4"):
        import av

        with av.open(io.BytesIO(data)) as film:
            return sum(1 for _ in film.decode(video=0)) > 1
    if name.endswith(".png"):
        with pillow.open(io.BytesIO(data)) as picture:
            picture.load()
        return True
    return data.endswith(b"\n") and data.count(b"\n") >= SCENE.count("\n")
