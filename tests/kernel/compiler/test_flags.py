"""Compiler options of the kernel and of its functions: NaN is kept, division follows IEEE 754."""

from __future__ import annotations

import ast

from minirt.kernel.compiler import options
from tests.paths import PACKAGE
from tests.shapes.execution_modes import compiled, kernel
from tests.shapes.test_sphere import BENIGN

COMPILERS = {"njit", "jit", "vectorize", "guvectorize", "cfunc", "stencil"}
FASTMATH = "fastmath"
FLAGS = {"FLAGS", "C_FLAGS"}  # names of the project's flags


def test_the_flags_let_kernels_divide_as_ieee_754_says_and_keep_nan() -> None:
    assert options.FLAGS["error_model"] == "numpy"
    assert options.FLAGS[FASTMATH] == {"contract"}


def test_inlined_functions_have_no_flags_of_their_own() -> None:
    # They are compiled with the flags of their caller.
    assert not {"error_model", FASTMATH} & set(options.INLINED)


def calls(source: str) -> list[ast.Call]:
    """Return all calls in a source."""
    return [node for node in ast.walk(ast.parse(source)) if isinstance(node, ast.Call)]


def calls_with_other_flags(source: str) -> list[str]:
    """Describe the calls of a source that compile without the project's flags."""
    descriptions = []
    for call in calls(source):
        name = call.func.id if isinstance(call.func, ast.Name) else getattr(call.func, "attr", "")
        keywords = {each.arg: ast.unparse(each.value) for each in call.keywords}
        if keywords.get(FASTMATH, "{'contract'}") != "{'contract'}":
            descriptions.append(f"{name} with fastmath={keywords[FASTMATH]}")
        if name in COMPILERS and keywords.get("error_model") != "'numpy'" and keywords.get(None) not in FLAGS:
            descriptions.append(f"{name} without the error model of numpy")
    return descriptions


def test_no_source_compiles_with_other_flags() -> None:
    sources = {path: path.read_text(encoding="utf-8") for path in PACKAGE.rglob("*.py")}
    assert [call for source in sources.values() for call in calls_with_other_flags(source)] == []
    assert [sum(f" {name}(" in source for source in sources.values()) for name in ("njit", "cfunc")] == [1, 1]


def test_planted_flags_are_found() -> None:
    assert calls_with_other_flags("njit(fastmath=True, error_model='numpy')(f)") == ["njit with fastmath=True"]
    assert calls_with_other_flags("@numba.njit(cache=True)\ndef f(): pass") == ["njit without the error model of numpy"]
    assert calls_with_other_flags("njit(**FLAGS)(f)") == []
    assert calls_with_other_flags("cfunc(t, **OTHERS)(f)") == ["cfunc without the error model of numpy"]
    assert calls_with_other_flags("register_jitable(fastmath={'nnan'})(f)") == [
        "register_jitable with fastmath={'nnan'}"
    ]


def test_contraction_is_the_only_fast_math_of_instructions() -> None:
    compiled(*BENIGN[0])
    code = "\n".join(kernel().inspect_llvm().values())
    assert " contract " in code
    for forbidden in (" fast ", " nnan ", " ninf ", " nsz ", " arcp ", " reassoc ", " afn "):
        assert forbidden not in code
