"""What grows and shrinks of an element: its numbers, its colours as a whole, and red, green and blue of them."""

from __future__ import annotations

from typing import Any, NamedTuple

from minirt.element import Element, fields_of, once_per_kind
from minirt.fields import Colour, Field


class Value(NamedTuple):
    """A field, or one component of it."""

    field: Field
    part: int | None = None  # 0, 1, 2: red, green, blue

    @property
    def name(self) -> str:
        """What the user sees."""
        return self.field.name if self.part is None else f"{self.field.name}: {('red', 'green', 'blue')[self.part]}"

    def nudged(self, element: Element, steps: float) -> Any:
        """What becomes of the field after so many key presses."""
        old = getattr(element, self.field.name)
        new = self.field.nudge(old, steps)
        return new if self.part is None else (*old[: self.part], new[self.part], *old[self.part + 1 :])


@once_per_kind
def values(kind: type[Element]) -> tuple[Value, ...]:
    """All of them, the components of colours behind everything else."""
    whole = [Value(each) for each in fields_of(kind) if type(each).nudge is not Field.nudge]
    colours = [each.field for each in whole if isinstance(each.field, Colour)]
    return (*whole, *(Value(field, part) for field in colours for part in range(3)))
