"""The options with which functions are compiled: read from the compiler, and from the sources."""

from __future__ import annotations

import ast

from minirt.kernel.compiler import jit, options
from minirt.kernel.rows import row_type
from minirt.shapes import KINDS
from tests.paths import PACKAGE
from tests.shapes.test_sphere import BENIGN
from tests.shapes.ways import compiled, kernel

COMPILERS = {"njit", "jit", "vectorize", "guvectorize", "cfunc", "stencil"}
FASTMATH = "fastmath"


def test_the_kernel_divides_as_ieee_754_says_and_keeps_nan() -> None:
    options = jit.kernel_of((), row_type(KINDS[0])).targetoptions
    assert options["error_model"] == "numpy"
    assert options[FASTMATH] == {"contract"}


def test_what_the_kernel_calls_has_no_flags_of_its_own() -> None:
    # It is compiled with those of its caller.
    assert not {"error_model", FASTMATH} & set(options.INLINED)


def calls(source: str) -> list[ast.Call]:
    """All calls in a source."""
    return [node for node in ast.walk(ast.parse(source)) if isinstance(node, ast.Call)]


def wrong(source: str) -> list[str]:
    """What a source compiles without the project's flags."""
    found = []
    for call in calls(source):
        name = call.func.id if isinstance(call.func, ast.Name) else getattr(call.func, "attr", "")
        keywords = {each.arg: ast.unparse(each.value) for each in call.keywords}
        if keywords.get(FASTMATH, "{'contract'}") != "{'contract'}":
            found.append(f"{name} with fastmath={keywords[FASTMATH]}")
        if name in COMPILERS and keywords.get("error_model") != "'numpy'" and keywords.get(None) != "FLAGS":
            found.append(f"{name} without the error model of numpy")
    return found


def test_no_source_compiles_with_other_flags() -> None:
    sources = {path: path.read_text(encoding="utf-8") for path in PACKAGE.rglob("*.py")}
    assert {path.name: wrong(source) for path, source in sources.items() if wrong(source)} == {}
    assert sum("njit(" in source for source in sources.values()) == 2


def test_other_flags_do_not_pass() -> None:
    assert wrong("njit(fastmath=True, error_model='numpy')(f)") == ["njit with fastmath=True"]
    assert wrong("@numba.njit(cache=True)\ndef f(): pass") == ["njit without the error model of numpy"]
    assert wrong("njit(**FLAGS)(f)") == []
    assert wrong("register_jitable(fastmath={'nnan'})(f)") == ["register_jitable with fastmath={'nnan'}"]


def test_instructions_may_contract_and_nothing_else() -> None:
    compiled(*BENIGN[0])
    code = "\n".join(kernel().inspect_llvm().values())
    assert " contract " in code
    for forbidden in (" fast ", " nnan ", " ninf ", " nsz ", " arcp ", " reassoc ", " afn "):
        assert forbidden not in code
