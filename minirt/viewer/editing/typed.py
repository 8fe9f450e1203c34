"""Typed values: numbers, sums of them, and changes of the present value.

3.5 or 3,5       that value; a comma where one number is expected is a decimal comma
-3               a negative number
2*3+1  (1+2)/4   the result
1,2,3  1 2 3     three numbers for a colour, sizes, a position or a direction, even if one part of it is active;
                 in the picture they are the position where one number is active
*=2  +=0.5       the present value times 2, or plus 0.5; also -= and /=

In the picture a digit begins a value, and = any other one: =-3, =+=0.5.
"""

from __future__ import annotations

import ast
from collections.abc import Callable
from math import isfinite
from operator import add, mul, neg, pos, sub, truediv
from typing import Any

from minirt.element import Element
from minirt.errors import ElementError, FieldError
from minirt.fields import Colour, Direction, Three, Whole
from minirt.fields.scalars import found, number
from minirt.viewer.editing.placing import keep_standing
from minirt.viewer.editing.state import State
from minirt.viewer.editing.values import Value, position_value, values

OPERATIONS: dict[Any, Any] = {ast.Mult: mul, ast.Div: truediv, ast.Add: add, ast.Sub: sub, ast.USub: neg, ast.UAdd: pos}
CHARACTERS = "0123456789.,+-*/=()"  # of which typed values are made
SIGNS = tuple("*/+-")
CHANGES: dict[str, Callable[[float, float], float]] = {"+=": add, "-=": sub, "*=": mul, "/=": truediv}


def set_typed(state: State, value: Value, text: str, now: float) -> State:
    """The state whose selected element has what was typed as a value, or which says what is wrong with it."""
    try:
        return with_value(state, value, lambda element, own: typed(own, element, text), now)
    except FieldError as error:
        reason = f"{value.name} {error}"
    except ElementError as error:  # of the element, or of the record that is the value of its field
        reason = str(error).removeprefix(f"{state.element.title} ")
    return state.with_message(f"{state.element.title} {reason}")


def with_value(state: State, value: Value, new: Callable[[Element, Value], Any], now: float) -> State:
    """The state whose selected elements have another value, as far as they have one of that name.

    `new(element, value)` gives the new value of an element; in place of a part it may give the whole triple. Raises
    what `new` raises, and ValueError for a value out of range. The change is undone by itself.
    """
    changed = dict[int, Element]()
    for index in state.chosen:
        element, primary = state.scene.elements[index], state if index == state.selected else state.select(index)
        own = value if primary is state else next((each for each in values(element) if is_like(each, value)), None)
        if own:
            given = new(element, own)
            whole = own._replace(channel=None) if isinstance(given, tuple) else own
            after = element.replace(**{own.field.name: whole.replaced(element, given)})
            changed[index] = keep_standing(primary, element, after)
    return state.end_merging().edit_elements(changed, f"typed {value.name}", now).end_merging()


def value_for(state: State, text: str) -> Value:
    """The value that a typed text is for: the active one; where that is one number, the position for three of them."""
    active = state.active
    is_for_place = not isinstance(active.get(state.element), tuple) and three_words(text.removeprefix("="))
    place = position_value(state.element)
    return place._replace(channel=None) if is_for_place and place else active


def is_like(one: Value, other: Value) -> bool:
    """Whether two values have the same name and are spelled in the same way."""
    return one.name == other.name and type(one.leaf) is type(other.leaf)


def typed(value: Value, element: Element, text: str) -> Any:
    """The number or triple that `text` asks for as a value of an element, in range or not.

    One number counts for all parts of a triple; three numbers give a triple even if `value` is a part of one. A
    direction may have any length. FieldError for a text that gives no number, a wrong count of numbers, and a value
    that is no number.
    """
    old, current = value.get(element), value.current(element)
    presents = current if isinstance(current, tuple) else (current,)
    if any(isinstance(part, bool) or not isinstance(part, int | float) for part in presents):
        raise FieldError("is not a number: + and - change it")
    body = text.removeprefix("=").strip()
    change = CHANGES.get(body[:2])
    body = body[2:].strip() if change else body
    texts = (three_words(body) if isinstance(old, tuple) else []) or body.split(",")
    if len(texts) == Three.width and isinstance(old, tuple):
        presents = old
    elif len(presents) == 1 and (len(texts) == 2 or any(each in body[1:] for each in SIGNS)):
        texts = [".".join(texts)]  # commas are decimal commas
    elif len(texts) != 1:
        numbers = "one number" if len(presents) == 1 else f"one number or {len(presents)}"
        raise FieldError(f"takes {numbers}, got {len(texts)}")
    texts *= len(presents) // len(texts)
    given: list[Any] = [sum_of(each, change, present) for each, present in zip(texts, presents, strict=True)]
    if isinstance(value.leaf, Colour | Whole):
        given = [round(part) for part in given]
    if isinstance(value.leaf, Direction) and len(given) > 1:
        longest = max(1.0, *map(abs, given))  # so that all components are in range
        given = [part / longest for part in given]
    return tuple(given) if len(given) > 1 else given[0]


def three_words(text: str) -> list[str]:
    """The words of a text of three numbers, with commas or blanks between them; none of any other, such as 1 + 2."""
    words = text.replace(",", " ").split()
    are_numbers = all(any(map(str.isdigit, each)) and each[0] not in "*/" for each in words)
    return words if len(words) == Three.width and are_numbers else []


def sum_of(text: str, change: Callable[[float, float], float] | None, present: float) -> float:
    """The result of a sum, product or quotient of numbers, or of `change(present, result)` if there is a change.

    FieldError for a text that is no arithmetic, a division by 0, and a result that is not finite.
    """
    if not change and not any(sign in text[1:] for sign in "*/+-()"):
        return number(text)
    try:
        value = result(ast.parse(text, mode="eval").body)
        value = change(present, value) if change else value
        if isfinite(value):
            return value
    except ZeroDivisionError:
        raise FieldError("cannot be divided by 0") from None
    except (SyntaxError, OverflowError, RecursionError, MemoryError):
        pass
    raise FieldError("must be a number, " + found(text))


def result(node: ast.expr) -> float:
    """The result of a node of a parsed sum; SyntaxError for anything that is no arithmetic."""
    match node:
        case ast.BinOp(left, operator, right) if type(operator) in OPERATIONS:
            return float(OPERATIONS[type(operator)](result(left), result(right)))
        case ast.UnaryOp(operator, operand) if type(operator) in OPERATIONS:
            return float(OPERATIONS[type(operator)](result(operand)))
        case ast.Constant(int() | float() as constant) if not isinstance(constant, bool):
            return float(constant)
    raise SyntaxError
