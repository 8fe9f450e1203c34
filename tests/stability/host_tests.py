"""Tests that run the lines of host code: recorded once, then chosen for each change."""

from __future__ import annotations

import json
import sys
import threading
import time
from collections import defaultdict
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from types import CodeType, FrameType
from typing import Any, NamedTuple

import pytest

from tests.scheduling import file_of


class Recorded(NamedTuple):
    """A test that passes: its name, its seconds, and the lines of the package that it runs, by file."""

    name: str
    seconds: float
    lines: dict[str, set[int]]


class Recorder:
    """Plugin of pytest: notes the lines of a package that each test runs, in all threads but in no other process.

    Formulas are left out: a test runs their lines thousands of times."""

    def __init__(self, package: Path) -> None:
        self.prefix = f"{package}/"
        self.formulas = tuple(f"{package}/{name}/" for name in ("kernel", "lanes", "shapes"))
        self.lines: dict[str, set[int]] = defaultdict(set)
        self.tests: list[Recorded] = []
        self.failed: list[str] = []

    def enter(self, frame: FrameType, event: str, value: object) -> Any:
        """Trace the lines of functions of the package."""
        file = frame.f_code.co_filename
        return self.line if file.startswith(self.prefix) and not file.startswith(self.formulas) else None

    def line(self, frame: FrameType, event: str, value: object) -> Any:
        """Note a line."""
        if event == "line":
            self.lines[frame.f_code.co_filename.removeprefix(self.prefix)].add(frame.f_lineno)
        return self.line

    @pytest.hookimpl(wrapper=True)
    def pytest_runtest_protocol(self, item: pytest.Item) -> Iterator[None]:
        """Record a test with its fixtures."""
        self.lines = defaultdict(set)
        started, failures = time.monotonic(), len(self.failed)
        threading.settrace(self.enter)
        sys.settrace(self.enter)
        try:
            return (yield)
        finally:
            sys.settrace(None)
            threading.settrace(None)  # type: ignore[arg-type]
            if len(self.failed) == failures:
                self.tests.append(Recorded(item.nodeid, time.monotonic() - started, self.lines))

    def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
        """Note a test that fails."""
        if report.failed:
            self.failed.append(report.nodeid)

    def write(self, path: Path) -> None:
        """Write the record."""
        tests = [[name, took, {file: sorted(at) for file, at in lines.items()}] for name, took, lines in self.tests]
        path.write_text(json.dumps({"tests": tests, "failed": self.failed}))


class Choice:
    """Chooses the tests of a line."""

    def __init__(self, package: Path, record: Path) -> None:
        self.package = package
        read = json.loads(record.read_text())
        self.failed: list[str] = read["failed"]
        self.tests = [
            Recorded(name, took, {f: set(at) for f, at in lines.items()}) for name, took, lines in read["tests"]
        ]

    def tests_of(self, path: Path, line: int, seconds: float) -> list[Recorded]:
        """Return the tests that run a line, as many as run in so many seconds: quick before slow, near before far.

        A line that runs in other processes alone, or during imports, has the tests of its folder."""
        at = executable_line(self.package / path, line)
        found = [test for test in self.tests if at in test.lines.get(str(path), ())]
        found = found or [test for test in self.tests if is_near(test.name, path)]
        chosen, total = [], 0.0
        for test in sorted(found, key=lambda test: (test.seconds > 1.0, distance(test.name, path), test.seconds)):
            total += test.seconds
            if chosen and total > seconds:
                break
            chosen.append(test)
        return chosen


def distance(test: str, path: Path) -> int:
    """Return 0 for a test of the file, 1 for one of its folder, 2 for others."""
    file = Path(file_of(test))
    return 0 if file.name == f"test_{path.name}" else 1 if file.parent == Path("tests") / path.parent else 2


def is_near(test: str, path: Path) -> bool:
    """Whether a test is in the folder of a file's tests, or in the closest one that there is."""
    return Path("tests") / (path.parts[0] if len(path.parts) > 1 else "") in Path(file_of(test)).parents


def executable_line(path: Path, line: int) -> int:
    """Return the last line up to `line` that begins something executable."""
    return max((each for each in executable_lines(path) if each <= line), default=line)


@cache
def executable_lines(path: Path) -> frozenset[int]:
    """Return all lines of a source that begin something executable."""
    found: set[int] = set()
    waiting: list[CodeType] = [compile(path.read_text(encoding="utf-8"), str(path), "exec")]
    while waiting:
        code = waiting.pop()
        found |= {line for _, _, line in code.co_lines() if line}
        waiting += [each for each in code.co_consts if isinstance(each, CodeType)]
    return frozenset(found)
