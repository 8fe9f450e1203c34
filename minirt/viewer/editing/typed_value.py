"""Typed values: set the active value to a number, or change it by one.

3.5          that value; three numbers with commas for a colour or sizes, one for all three
=*2  =/2     the value times or divided by a number
=+0.5  =-1   the value plus or minus a number
"""

from __future__ import annotations

from collections.abc import Callable
from operator import add, mul, sub, truediv
from typing import Any

from minirt.errors import FieldError
from minirt.fields import Colour, Count, Field, number
from minirt.viewer.editing.standing import keep_standing
from minirt.viewer.editing.state import State

OPERATIONS: dict[str, Callable[[float, float], float]] = {"*": mul, "/": truediv, "+": add, "-": sub}
CHARACTERS = "0123456789.,+-*/="  # of which typed values are made


def set_typed(state: State, text: str, now: float) -> State:
    """The state whose active value is what was typed, or which says what is wrong with it."""
    active = state.active
    if active is None:
        return state.with_message(f"{state.element.title} has no value to type")
    try:
        new = typed(active.inner or active.field, active.get(state.element), text)
        changed = state.element.replace(**{active.field.name: active.replaced(state.element, new)})
    except (FieldError, ValueError) as error:
        reason = str(error)
        return state.with_message(reason if reason.startswith(state.element.title) else f"{active.name} {reason}")
    changed = keep_standing(state, changed)
    return state.end_merging().edit_element(changed, f"typed {active.name}", now).end_merging()


def typed(field: Field, old: Any, text: str) -> Any:
    """The value of a field that `text` asks for. FieldError if it is no number, or out of the field's range."""
    count = len(old) if isinstance(old, tuple) else 1
    if isinstance(old, (bool, str)) or not all(isinstance(part, (int, float)) for part in parts_of(old)):
        raise FieldError("is not a number: + and - change it")
    body = text.removeprefix("=")
    relative = text.startswith("=") and body[:1] in OPERATIONS and len(body) > 1
    given = [number(part) for part in (body[1:] if relative else body).split(",")]
    if len(given) not in (1, count):
        raise FieldError(f"takes {'one number' if count == 1 else f'one number or {count}'}, got {len(given)}")
    given *= count // len(given)
    if relative:
        if body[0] == "/" and 0 in given:
            raise FieldError("cannot be divided by 0")
        given = [OPERATIONS[body[0]](part, by) for part, by in zip(parts_of(old), given, strict=True)]
    if isinstance(field, (Colour, Count)):
        given = [round(part) for part in given]
    return field.check(tuple(given) if isinstance(old, tuple) else given[0])


def parts_of(value: Any) -> tuple[Any, ...]:
    """The components of a value."""
    return value if isinstance(value, tuple) else (value,)
