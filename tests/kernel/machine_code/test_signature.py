"""Signatures: plain data that says as much of the arguments of a kernel as numba's own types do."""

from __future__ import annotations

import json
from functools import cache
from typing import Any, NamedTuple

import numpy as np
import pytest
from numba import typeof

import minirt
from minirt.kernel import interpreted
from minirt.kernel.compiler.argument_types import type_of
from minirt.kernel.machine_code import functions, signature
from minirt.kernel.machine_code.signature import dtype_of, key_of, signature_of, tuple_class
from minirt.rendering.frame import frame_arguments
from minirt.rendering.needed_kernels import minimal_scene
from minirt.rendering.scene_packing import Packing
from tests.paths import scene_files

Arguments = tuple[Any, ...]


class Pair(NamedTuple):
    first: Any
    second: Any


class Recorder:
    """The interpreted functions that pack a scene. The arguments of each call are kept."""

    def __init__(self) -> None:
        self.arguments: list[Arguments] = []

    def __getattr__(self, name: str) -> Any:
        def run(*arguments: Any) -> Any:
            self.arguments.append(arguments)
            return getattr(interpreted, name)(*arguments)

        return run


@cache
def arguments_of_scenes() -> list[Arguments]:
    """Return the arguments of all functions that draw the scenes of this project, in both precisions."""
    found = []
    for path in scene_files():
        scene = minimal_scene(minirt.load(path, lenient=True))
        for precision in ("double", "single"):
            recorder = Recorder()
            with np.errstate(all="ignore"):
                arrays = Packing(recorder, precision).pack(scene, 1, 1)
            found += [*recorder.arguments, frame_arguments(arrays, np.zeros((1, 1, 4), np.uint8))]
    return found


def through_json(value: Any) -> Any:
    """Return the signature of a value as another process reads it."""
    return json.loads(json.dumps(signature_of(value)))


def test_the_arguments_of_all_scenes_have_the_types_that_numba_sees_in_them() -> None:
    all_arguments = arguments_of_scenes()
    assert len({key_of(each) for each in all_arguments}) > 20
    for arguments in all_arguments:
        for each in arguments:
            assert type_of(through_json(each)) == typeof(each)


@pytest.mark.parametrize(
    "value",
    [
        None,
        7,
        -(2**63),
        0.5,
        np.zeros(3),
        np.zeros((2, 3, 4), np.float32),
        np.zeros((0, 4), np.uint8),
        np.zeros(2, np.bool_),
        np.zeros(2, [("a", "<f8"), ("b", "<f4", (3,)), ("c", "<i8", (2, 2))]),
        (),
        (1, 0.5, None),
        ((np.zeros(1), (2,)), Pair(np.zeros((1, 1)), (None, Pair(1, 2.0)))),
        Pair(np.zeros(1), np.zeros(1)),
    ],
    ids=lambda value: type(value).__name__,
)
def test_every_type_of_argument_survives_json(value: Any) -> None:
    assert type_of(through_json(value)) == typeof(value)


def test_integers_and_floats_of_numpy_are_passed_as_those_of_python() -> None:
    assert signature_of(np.int32(3)) == signature_of(np.uint8(3)) == signature_of(True) == signature_of(3) == "int"
    assert signature_of(np.float64(3)) == signature_of(3.0) == "float"


def test_classes_and_dtypes_are_found_by_their_signatures() -> None:
    record = np.dtype([("a", "<f8"), ("b", "<f4", (3,))])
    assert tuple_class(through_json(Pair(1, 2))) is Pair
    assert tuple_class(through_json((1, 2))) is tuple
    assert dtype_of(through_json(np.zeros(1, record))) == record
    assert dtype_of(through_json(np.zeros(1, np.float32))) == np.float32


@pytest.mark.parametrize("value", ["text", [1, 2], {1: 2}, 1j, np.float32(1), np.bool_(True), object(), np.zeros])
def test_what_no_kernel_takes_is_an_error(value: Any) -> None:
    for each in (value, (1, value), Pair(1, (value,))):
        with pytest.raises(TypeError, match=f"^no kernel takes {type(value).__name__}$"):
            signature_of(each)


def keys_tell_signatures_apart() -> bool:
    """Whether all arguments of the scenes that have the same key have the same signature."""
    found: dict[Any, Any] = {}
    return all(
        found.setdefault(signature.key_of(each), signature_of(each)) == signature_of(each)
        for each in arguments_of_scenes()
    )


def test_arguments_with_the_same_key_have_the_same_signature() -> None:
    assert keys_tell_signatures_apart()


@pytest.mark.parametrize("forgotten", [np.ndarray, tuple])
def test_a_key_that_forgets_something_would_be_found_here(forgotten: type, monkeypatch: pytest.MonkeyPatch) -> None:
    """Contents of arrays, or of tuples."""

    def forgetful(value: Any) -> Any:
        if isinstance(value, forgotten):
            return forgotten
        return (type(value), *map(forgetful, value)) if isinstance(value, tuple) else key_of(value)

    monkeypatch.setattr(signature, "key_of", forgetful)
    assert not keys_tell_signatures_apart()


def test_values_of_different_signatures_have_different_keys() -> None:
    record = np.zeros(1, [("a", "<f8")]), np.zeros(1, [("b", "<f8")]), np.zeros(1, [("a", "<f8", (3,))])
    arrays = [np.zeros(1), np.zeros((1, 1)), np.zeros(1, np.float32), np.zeros(1, np.int64), *record]
    values = [None, 1, 1.0, *arrays, (), (1,), (1.0,), ((1,),), (None, 1), (1, None), Pair(None, 1), (np.zeros(1), 1)]
    assert len({json.dumps(signature_of(each)) for each in values}) == len(values)
    assert len({key_of(each) for each in values}) == len(values)


def test_keys_of_other_values_of_the_same_types_are_equal() -> None:
    """Or each picture would look for its kernel anew."""
    one, other = (Pair(np.full((n, n), 0.5 * n), (n, None, 0.5 * n)) for n in (2, 3))
    assert key_of(one) == key_of(other)
    assert hash(key_of(one)) == hash(key_of(other))


def test_functions_are_named_so_that_another_process_finds_them() -> None:
    for name, each in vars(functions).items():
        if isinstance(each, functions.CompiledFunction):
            module, found = each.name.split(":")
            assert (found, module.split(".")[:2]) == (name, ["minirt", "kernel"])
            assert each.call(1, 2.0) == (each.name, (1, 2.0))
