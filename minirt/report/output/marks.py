"""Marks of a diagram: points of several forms, error bars and rings."""

from __future__ import annotations

from math import cos, pi, sin

from minirt.report.output.svg import Point, element, path

RADIUS = 4.5  # pixels
CORNERS = {"square": (4, 0.25), "diamond": (4, 0.0), "triangle": (3, 0.5), "pentagon": (5, 0.5), "wedge": (3, 0.0)}
FORMS = ("circle", *CORNERS)  # corners of a regular polygon, and its turn in steps from one to the next


def mark(form: str, at: Point, is_hollow: bool = False) -> str:
    """Draw a point as a circle or a regular polygon."""
    style = "mark hollow" if is_hollow else "mark"
    if form == "circle":
        return element("circle", cx=at[0], cy=at[1], r=RADIUS, class_=style)
    corners, turn = CORNERS[form]
    angles = [2 * pi * (corner + turn) / corners - pi / 2 for corner in range(corners)]
    radius = RADIUS * 1.25  # so that its area is about that of the circle
    points = [(at[0] + radius * cos(angle), at[1] + radius * sin(angle)) for angle in angles]
    return element("polygon", points=" ".join(f"{x:.1f},{y:.1f}" for x, y in points), class_=style)


def cross(at: Point) -> str:
    """Draw the two bars of confidence intervals."""
    (x, y), arm = at, RADIUS * 1.7
    return path([(x - arm, y), (x + arm, y)], class_="interval") + path([(x, y - arm), (x, y + arm)], class_="interval")


def ring(at: Point) -> str:
    """Draw the ring around a recommended point."""
    return element("circle", cx=at[0], cy=at[1], r=RADIUS * 2, class_="ring")
