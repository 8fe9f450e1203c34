"""Records behave as the frozen dataclasses that they replace."""

from __future__ import annotations

import pickle
from collections.abc import Callable
from dataclasses import KW_ONLY, FrozenInstanceError, dataclass, field, fields, replace
from inspect import signature
from typing import Any

import pytest

from minirt.element import Record
from minirt.fields import Field, Length
from minirt.records import Immutable, record
from minirt.shapes import Sphere


def kinds(decorate: Any, base: type) -> tuple[Any, Any]:
    """Make a class with all sorts of fields, and one that inherits them, overrides a default, and checks another."""

    @decorate
    class Small(base):  # type: ignore[misc]
        __qualname__ = "Small"
        first: Any
        second: Any = 2
        _: KW_ONLY
        third: Any = field(default=3, compare=False, repr=False)

    @decorate
    class Large(Small):
        __qualname__ = "Large"
        second: Any = 20
        fourth: Any = 4
        last: Any = field(kw_only=True, default=None)

        def __post_init__(self) -> None:
            if self.fourth is None:
                raise ValueError("fourth")
            object.__setattr__(self, "last", self.fourth)

    return Small, Large


Small, Large = kinds(record(), Immutable)
SmallPeer, LargePeer = kinds(dataclass(frozen=True), object)
PAIRS = [(Small, SmallPeer), (Large, LargePeer)]
ARGUMENTS: list[tuple[tuple[Any, ...], dict[str, Any]]] = [
    ((1,), {}),
    ((1, 5), {"third": 7}),
    ((), {"first": 1}),
    ((), {"second": 8, "first": float("nan")}),
    ((1, 2, 3), {}),
    ((1, 2), {"last": 9}),
    ((1, 2, None), {}),
    ((), {}),
    ((1,), {"first": 1}),
    ((1, 2, 3, 4), {}),
    ((1,), {"unknown": 1}),
    (([],), {}),
]


def outcome(act: Callable[[], Any]) -> Any:
    """The result of a function, or its error."""
    try:
        return act()
    except (TypeError, ValueError) as error:
        return type(error)


def described(kind: Any, values: tuple[Any, ...], named: dict[str, Any]) -> Any:
    """All that can be seen of an object: its values in their order, its hash."""
    each = kind(*values, **named)
    return list(vars(each).items()), outcome(lambda: hash(each)) is TypeError


@pytest.mark.parametrize("kinds", PAIRS, ids=["small", "large"])
@pytest.mark.parametrize(("values", "named"), ARGUMENTS)
def test_a_record_takes_what_a_frozen_dataclass_takes(
    kinds: tuple[Any, Any], values: tuple[Any, ...], named: dict[str, Any]
) -> None:
    ours, theirs = (outcome(lambda kind=kind: described(kind, values, named)) for kind in kinds)
    assert repr(ours) == repr(theirs)


def test_a_wrong_argument_is_named() -> None:
    with pytest.raises(TypeError, match="missing a required argument: 'first'"):
        Small()
    with pytest.raises(TypeError, match="Small has no field 'unknown'"):
        Small(1, unknown=2)


def test_records_are_equal_if_their_compared_values_and_kinds_are() -> None:
    assert Small(1) == Small(1, 2, third=9)
    assert hash(Small(1)) == hash(Small(1, third=9))
    assert Small(1) != Small(2)
    assert Small(1, 20) != Large(1)
    assert Small(1) != SmallPeer(1)
    assert len({Small(1), Small(1), Large(1)}) == 2


def test_a_representation_leaves_out_defaults() -> None:
    assert repr(Small(1, third=9)) == "Small(first=1)"
    assert repr(Large(1, 2, fourth=5)) == "Large(first=1, second=2, fourth=5, last=5)"


def test_a_record_does_not_change() -> None:
    each = Small(1)
    with pytest.raises(FrozenInstanceError, match="cannot assign to field 'first'"):
        each.first = 2
    with pytest.raises(FrozenInstanceError, match="cannot delete field 'first'"):
        del each.first
    assert each.first == 1


@pytest.mark.parametrize(("kind", "peer"), PAIRS)
def test_tools_for_dataclasses_work(kind: Any, peer: Any) -> None:
    assert str(signature(kind)) == str(signature(peer)).removesuffix(" -> None")
    assert [each.name for each in fields(kind)] == [each.name for each in fields(peer)]
    assert kind.__match_args__ == peer.__match_args__
    changed = replace(kind(1), second=7)
    assert (changed.first, changed.second) == (1, 7)
    assert vars(pickle.loads(pickle.dumps(changed))) == vars(changed)


def below(kind: type[Any]) -> set[type[Any]]:
    """A class of the program and all of its subclasses."""
    return {kind}.union(*(below(each) for each in kind.__subclasses__() if each.__module__.startswith("minirt.")))


def test_elements_and_fields_write_no_methods_of_their_own() -> None:
    """Each method that a decorator writes would be compiled at every start."""
    kinds = below(Record) | below(Field)
    assert {Sphere, Length} < kinds
    written = {"__init__", "__eq__", "__hash__", "__repr__", "__setattr__", "__delattr__"}
    assert {kind: written & vars(kind).keys() for kind in kinds if written & vars(kind).keys()} == {}
    assert written & vars(SmallPeer).keys() == written


COLUMNS = {"centre": [(0.0, 1.0, 2.0), (3.0, 4.0, 5.0)], "diameter": [1.0, 2.0], "colour": [(1, 2, 3)] * 2}


def test_elements_made_at_once_are_equal_frozen_and_pickled_like_single_ones() -> None:
    batch = Sphere.of_columns(2, {**COLUMNS, "source": ["a", "b"]})
    built = [Sphere(*row) for row in zip(*COLUMNS.values(), strict=True)]
    assert batch == built
    assert list(map(hash, batch)) == list(map(hash, built))
    assert [each.source for each in batch] == ["a", "b"]
    again = pickle.loads(pickle.dumps(batch))
    assert [vars(each) for each in again] == [vars(each) for each in batch]
    assert batch[1].replace(diameter=9).diameter == 9
    with pytest.raises(ValueError, match="diameter"):
        batch[1].replace(diameter=-1)
    with pytest.raises(FrozenInstanceError):
        batch[0].diameter = 5.0  # type: ignore[misc]
