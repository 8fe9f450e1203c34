"""Decimal numbers in the bytes of a text: read by compiled code, and rounded as Python's `float` rounds them.

A text is an array of int8, or a list of such numbers. It ends with a byte that is part of no number.
"""

from __future__ import annotations

from typing import Any

PLUS, MINUS, POINT, ZERO, NINE, LOWER_E, UPPER_E = b"+-.09eE"
LARGEST = 10**17  # of whole numbers: larger ones become it
LONGEST = 300  # bytes of a number that a file may have, as in `minirt.fields.scalars`
MOST_DIGITS = 18  # of a number of 63 bits, whatever they are
GREATEST_POWER = 22  # of ten that a float64 holds exactly


def is_digit(byte: int) -> bool:
    return ZERO <= byte <= NINE


def skip_sign(text: Any, at: int) -> int:
    """Return the place behind the sign of a number, if it has one."""
    return at + (text[at] == PLUS or text[at] == MINUS)


def read_whole(text: Any, start: int) -> tuple[int, int]:
    """Return the whole number at a place of a text, and the place behind it: `start` where there is none."""
    value, at = 0, skip_sign(text, start)
    if not is_digit(text[at]):
        return 0, start
    while is_digit(text[at]):
        value = min(10 * value + (int(text[at]) - ZERO), LARGEST)
        at += 1
    return -value if text[start] == MINUS else value, at


def read_decimal(text: Any, start: int) -> tuple[float, int, bool]:
    """Return the number at a place of a text, the place behind it, and whether it is rounded correctly.

    The place is `start` where there is no number. Numbers of at most 18 digits and without large exponents are rounded
    correctly (after Clinger, How to Read Floating Point Numbers Accurately, 1990); other values are of no use.
    """
    at = skip_sign(text, start)
    mantissa, digits, significant, decimals, is_behind_point = 0, 0, 0, 0, False
    while is_digit(text[at]) or (text[at] == POINT and not is_behind_point):
        if text[at] == POINT:
            is_behind_point = True
        else:
            mantissa = 10 * mantissa + (int(text[at]) - ZERO)
            if mantissa > 0 or significant > 0:  # many digits overflow a mantissa of 64 bits
                significant += 1
            if is_behind_point:
                decimals += 1
            digits += 1
        at += 1
    if digits == 0:
        return 0.0, start, True
    exponent, end = 0, at
    if text[at] == LOWER_E or text[at] == UPPER_E:
        exponent, end = read_whole(text, at + 1)
        if end > at + 1:  # else the e is no part of the number
            at = end
    exponent -= decimals
    is_short = significant <= MOST_DIGITS and -GREATEST_POWER <= exponent <= GREATEST_POWER
    value, is_exact = scaled(mantissa, exponent) if is_short else (0.0, False)
    return -value if text[start] == MINUS else value, at, is_exact


def scaled(mantissa: int, exponent: int) -> tuple[float, bool]:
    """Return `mantissa` times 10 to the power of `exponent`, from -22 to 22, and whether it is rounded correctly.

    The number is of no use where it is not.
    """
    power, power_of_5 = 1.0, 1
    for _ in range(abs(exponent)):
        power *= 10.0
        power_of_5 *= 5
    if mantissa <= 2**53:
        return mantissa / power if exponent < 0 else mantissa * power, True
    # A quotient of 53 bits, and its remainder, which is small, and so known from its lower 64 bits.
    quotient, scale, shift = mantissa / power, 1.0, exponent
    while quotient < 2.0**52:
        quotient, scale, shift = 2.0 * quotient, 2.0 * scale, shift + 1
    if shift < 0 or exponent > 0:
        return 0.0, False
    whole = int(quotient)
    twice_remainder = 2 * ((mantissa << shift) - whole * power_of_5)
    whole += (twice_remainder + power_of_5) // (2 * power_of_5)
    return whole / scale, 2**52 < whole <= 2**53
