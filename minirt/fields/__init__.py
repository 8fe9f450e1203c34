"""Fields of the elements of a scene: each is declared once, and the parser, the writer, the editor and the
documentation derive from the declaration.
"""

from minirt.errors import FieldError
from minirt.fields.directions import Direction, neat, unit
from minirt.fields.field import Field, PictureFile, Repair
from minirt.fields.meshes import MeshField, MeshFile
from minirt.fields.numerals import number, spelled, whole
from minirt.fields.orientation import cos_and_sin, upright
from minirt.fields.pictures import Paint, Picture
from minirt.fields.scalars import FARTHEST, LEAST_LENGTH, Angle, Count, Factor, Flag, Length, Real, Whole, clamp
from minirt.fields.triples import Colour, Lengths, Point, Three, Triple
from minirt.fields.words import Choice
from minirt.records import declare

__all__ = [
    "FARTHEST",
    "LEAST_LENGTH",
    "Angle",
    "Choice",
    "Colour",
    "Count",
    "Direction",
    "Factor",
    "Field",
    "FieldError",
    "Flag",
    "Length",
    "Lengths",
    "MeshField",
    "MeshFile",
    "Paint",
    "Picture",
    "PictureFile",
    "Point",
    "Real",
    "Repair",
    "Three",
    "Triple",
    "Whole",
    "clamp",
    "cos_and_sin",
    "declare",
    "neat",
    "number",
    "spelled",
    "unit",
    "upright",
    "whole",
]
