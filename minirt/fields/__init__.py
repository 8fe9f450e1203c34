"""Fields of the elements of a scene: each is declared once, and the parser, the writer, the editor and the
documentation derive from the declaration. File names in them begin at the folder of the scene file.
"""

from minirt.errors import FieldError
from minirt.fields.directions import Direction, cos_and_sin, neat, unit, upright
from minirt.fields.field import Choice, Field, MeshField, MeshFile, Picture, PictureFile, Repair
from minirt.fields.scalars import FARTHEST, Angle, Factor, Flag, Length, Real, Whole, clamp, clamp_length, spelled
from minirt.fields.triples import Colour, Lengths, Paint, Point, Three, Triple
from minirt.records import declare
