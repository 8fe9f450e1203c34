"""Fields of the elements of a scene: each is declared once, and the parser, the writer, the editor and the
documentation derive from the declaration.
"""

from minirt.errors import FieldError
from minirt.fields.field import Field, PictureFile, Repair, declare
from minirt.fields.meshes import MeshField, MeshFile
from minirt.fields.numerals import number, spelled, whole
from minirt.fields.orientation import upright
from minirt.fields.pictures import Paint, Picture
from minirt.fields.scalars import FARTHEST, LEAST_LENGTH, Count, Factor, Flag, Length, Real, Whole, clamp
from minirt.fields.triples import Colour, Direction, Lengths, Point, Three, Triple, unit

__all__ = [
    "FARTHEST",
    "LEAST_LENGTH",
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
    "declare",
    "number",
    "spelled",
    "unit",
    "upright",
    "whole",
]
