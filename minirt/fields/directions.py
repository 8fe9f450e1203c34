"""The field of a direction; unit vectors, rounded and written; the upright frame of a view, and angles in degrees."""

from __future__ import annotations

import math
from contextlib import suppress
from itertools import product
from math import cos, hypot, radians, sin
from typing import Any

from minirt.errors import FieldError
from minirt.fields.field import Repair
from minirt.fields.scalars import Scalar, number, spelled
from minirt.fields.triples import Three, Triple
from minirt.records import record

SCALED = "directions are scaled to length 1"  # a notice
SLACK = 1e-3  # by which the length of a direction may differ from 1 without a notice
DIGITS = 9  # significant digits of a neat component
LEAST = 1e-12  # a neat component that is smaller is 0
ROUNDS = 8  # of rounding and scaling in turn; two or three are enough


@record(kw_only=True)
class Direction(Three):
    """A direction with components in [-1, 1]; kept at unit length."""

    component = Scalar(doc="a component", low=-1.0, high=1.0)

    instead: Triple = (0.0, 1.0, 0.0)  # the direction that a lenient reader takes for 0,0,0
    may_be_zero: bool = False  # whether a strict reader takes it, too, as in the example that the subject prints

    def check(self, value: Triple) -> Triple:
        checked = super().check(value)
        if not any(checked):
            raise FieldError("must not be 0,0,0: it points nowhere")
        return unit(checked)

    def fits(self, numbers: Any) -> Any:
        return super().fits(numbers) & [not self.remark(each) for each in numbers.tolist()]

    def values(self, numbers: Any) -> list[Triple]:
        return list(map(unit, super().values(numbers)))

    def remark(self, value: Triple) -> str:
        return SCALED if abs(math.hypot(*value) - 1) > SLACK else ""

    def format(self, value: Triple) -> str:
        return ",".join(map(plain_decimal, shortest(value)))

    def repair(self, text: str) -> Repair | None:
        head, _, tail = text.rpartition(",")
        deed = ""
        with suppress(FieldError):
            if text.count(",") == 3 and number(tail) == 0:  # a direction in homogeneous coordinates
                text, deed = head, "drops the fourth component"
            if self.may_be_zero and not any(self.parse(text)):
                text = self.format(self.instead)
                deed = f"takes {text}"
            return Repair(self.check(self.parse(text)), deed) if deed else None
        return None

    @property
    def notation(self) -> str:
        components = ",".join(self.name[:1] + axis for axis in "xyz")
        return f"{self.prefix}{components}" if self.keyed else components


def unit(vector: Triple) -> Triple:
    """Return `vector`, which is not 0, scaled to length 1, even if its squares would underflow or overflow.

    A vector of length 1 within rounding is returned unchanged, so that saving and loading change nothing, unless a
    component is beyond 1, which no file may have. The quotient below is off by at most 2u in length and `hypot` by 2u
    more (u = 2^-53), so that scaling once is enough.
    """
    x, y, z = vector
    largest = max(abs(x), abs(y), abs(z))
    if largest <= 1.0 and abs(math.hypot(x, y, z) - 1.0) <= 4 * 2.0**-53:
        return float(x), float(y), float(z)
    x, y, z = x / largest, y / largest, z / largest
    length = math.hypot(x, y, z)
    return x / length, y / length, z / length


def places(part: float) -> int:
    """Decimals of a component that has `DIGITS` significant digits."""
    return DIGITS - 1 - math.floor(math.log10(abs(part)))


def rounded(direction: Triple) -> Triple:
    """Round the components to `DIGITS` significant digits, and those below `LEAST` to 0."""
    x, y, z = (round(part, places(part)) if abs(part) >= LEAST else 0.0 for part in direction)
    return x, y, z


def neat(direction: Triple) -> Triple:
    """Return the unit vector that nine digits in a file stand for, next to a direction."""
    for _ in range(ROUNDS):
        before, direction = direction, unit(rounded(direction))
        if direction == before:
            break
    return direction


def shortest(direction: Triple) -> Triple:
    """Return nine digits of each component that are read as the same direction, or all digits where there are none.

    The rounded components may be off by one in the last digit: scaled to unit length, others are read as the direction.
    """
    short = rounded(direction)
    if not any(short):
        return direction
    around = product(*map(neighbours, short))
    return next(((x, y, z) for x, y, z in around if unit((x, y, z)) == direction), direction)


def neighbours(part: float) -> list[float]:
    """A rounded component, and what differs from it by one in the last digit."""
    return [part, *(round(part + step * 10.0 ** -places(part), places(part)) for step in (-1, 1) if part)]


def plain_decimal(value: float) -> str:
    """Format a number without an exponent, unless it is smaller than `LEAST`."""
    text = spelled(value)
    if "e" not in text or abs(value) < LEAST:
        return text
    from decimal import Decimal

    return f"{Decimal(text):f}"


def upright(x: float, y: float, z: float) -> tuple[Triple, Triple]:
    """Return right and up, as unit vectors, for a view along the unit vector x, y, z.

    Right is the cross product of that vector and (0,1,0). For a view straight up or down, where this is zero, right is
    +x, and up is +z or -z.
    """
    largest = max(abs(x), abs(z))
    if not largest:
        return (1.0, 0.0, 0.0), (0.0, 0.0, y)
    # Scale the horizontal part first, so that its direction is kept even if its length is 1e-300.
    a, b = x / largest, z / largest
    length = hypot(a, b)
    a, b = a / length, b / length
    return (-b, 0.0, a), (-a * y, hypot(x, z), -b * y)


def cos_and_sin(degrees: float) -> tuple[float, float]:
    """Cosine and sine of an angle; exact for multiples of a right angle."""
    quarters = round(degrees / 90)
    rest = radians(degrees - 90 * quarters)
    c, s = cos(rest), sin(rest)
    return ((c, s), (-s, c), (-c, -s), (s, -c))[quarters % 4]
