"""Errors survive pickling, as they must to come out of another process: type, message and attributes."""

from __future__ import annotations

import copy
import pickle
from pathlib import Path

import pytest

from minirt import errors
from minirt.meshes.obj_lines import ObjError

PROBLEM = errors.Problem("ball.rt", 3, 5, "sp 0,0,0 -2 é", "diameter must be > 0", 2)
ERRORS = [
    errors.MiniRTError("something"),
    errors.SceneError((PROBLEM, PROBLEM)),
    errors.RenderError("size 0x0"),
    errors.FileError(Path("folder") / "stone\n.png", "is empty"),
    errors.ReplayError("keys.txt:1: unknown"),
    errors.MlxError("no display"),
    errors.FieldError("must be > 0", 2),
    errors.ElementError("two cameras"),
    ObjError("no such vertex", 7),
]


def survives(error: Exception) -> bool:
    """Whether an error is the same after pickling and after copying."""
    try:
        loaded = [pickle.loads(pickle.dumps(error, level)) for level in range(pickle.HIGHEST_PROTOCOL + 1)]
    except Exception:
        return False
    again = [*loaded, copy.copy(error), copy.deepcopy(error)]
    return all(
        (type(each), str(each), vars(each), each.args) == (type(error), str(error), vars(error), error.args)
        for each in again
    )


@pytest.mark.parametrize("error", ERRORS, ids=lambda error: type(error).__name__)
def test_errors_survive_pickling(error: Exception) -> None:
    assert survives(error)


def test_all_errors_are_tested() -> None:
    kinds = {kind for kind in vars(errors).values() if isinstance(kind, type) and issubclass(kind, Exception)}
    assert kinds <= {type(error) for error in ERRORS}
