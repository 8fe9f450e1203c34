"""No test reads a clock, sleeps, or limits a wait other than by `HANG_LIMIT`: checked in the sources of all tests."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from pathlib import Path

TESTS = Path(__file__).parent
CLOCKS = {
    f"{name}{unit}"
    for name in ("time", "monotonic", "perf_counter", "process_time", "thread_time")
    for unit in ("", "_ns")
}
CLOCKS |= {"sleep"}
WAITS = {"wait", "join", "communicate", "acquire", "result"}  # methods with seconds as an argument
LIMITS = {"timeout", "patience", "deadline"}  # arguments in seconds
EXEMPT = {  # files that measure time, or run for a given time
    "waiting.py",
    "fuzz/soak.py",
    "fuzz/__main__.py",
    "viewer/monkey.py",
    "viewer/kill.py",
    "viewer/test_recovery.py",  # which dates files
    "kernel/machine_code/test_cache.py",  # which simulates sleeping
    "mlx/maze.py",  # programs that run in simulated time
    "mlx/two_windows.py",
    *(
        path.relative_to(TESTS).as_posix()
        for path in (TESTS / "bench").rglob("*.py")
        if not path.name.startswith("test_")
    ),
}


def violations(source: str) -> list[str]:
    """List the places of a source that depend on time, as line and reason."""
    return [f"{node.lineno}: {reason}" for node in ast.walk(ast.parse(source)) for reason in reasons(node)]


def reasons(node: ast.AST) -> Iterator[str]:
    """Yield the reasons why a node of the syntax tree depends on time."""
    if isinstance(node, ast.ImportFrom) and node.module == "time":
        yield from (f"imports {each.name}" for each in node.names if each.name in CLOCKS)
    if isinstance(node, ast.Attribute) and ast.unparse(node.value) == "time" and node.attr in CLOCKS:
        yield f"uses time.{node.attr}"
    if isinstance(node, ast.Constant) and isinstance(node.value, str):
        yield from (
            f"a program that uses {name}" for name in re.findall(rf"\btime\.(?:{'|'.join(CLOCKS)})\b", node.value)
        )
    if isinstance(node, ast.Call):
        yield from (
            f"{each.arg} is {ast.unparse(each.value)}"
            for each in node.keywords
            if each.arg in LIMITS and is_number(each.value)
        )
        method = getattr(node.func, "attr", "") if not in_simulated_time(node.func) else ""
        yield from (f"{method} for {ast.unparse(each)} s" for each in node.args if method in WAITS and is_number(each))
        if method == "run" and any(isinstance(each, ast.Constant) and each.value == "sleep" for each in node.args):
            yield "runs sleep"


def in_simulated_time(function: ast.AST) -> bool:
    """Whether a function is a method of the memory back end, whose seconds are simulated."""
    return isinstance(function, ast.Attribute) and ast.unparse(function.value).split(".")[-1].strip("_") == "memory"


def is_number(node: ast.AST) -> bool:
    """Whether a node is a literal number."""
    return isinstance(node, ast.Constant) and isinstance(node.value, (int, float)) and not isinstance(node.value, bool)


def test_no_test_depends_on_time() -> None:
    found = {
        path.relative_to(TESTS).as_posix(): violations(path.read_text(encoding="utf-8"))
        for path in TESTS.rglob("*.py")
        if path.relative_to(TESTS).as_posix() not in EXEMPT and path != Path(__file__)
    }
    assert not {name: places for name, places in found.items() if places}
