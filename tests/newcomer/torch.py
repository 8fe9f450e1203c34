"""A made-up light for `minirt/scene/elements.py`: a flame, whose light does not reach far."""

from __future__ import annotations

from minirt.fields import Colour, Length, Point, Real, Triple, declare
from minirt.records import record
from minirt.scene.elements import FADE, RATIO, Lamp


# What goes into minirt/scene/elements.py.
@record()
class Torch(Lamp):
    """`fl x,y,z ratio reach [R,G,B]`: a made-up light: a flame, whose light fades to nothing within its reach."""

    code, title, plural = "fl", "torch", "torches"
    position: Triple = declare(Point, "position of the flame")
    brightness: float = declare(Real, "brightness", shared=RATIO)
    fade: float = declare(Length, FADE, initial=16.0)
    colour: Triple = declare(Colour, "colour", default=(255, 160, 60))
