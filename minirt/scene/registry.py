"""Every element that a scene file may hold, by its identifier."""

from __future__ import annotations

from minirt.element import Element
from minirt.scene.elements import Ambient, Camera, FurtherLight, Light, Resolution
from minirt.shapes import KINDS

KNOWN: tuple[type[Element], ...] = (Resolution, Ambient, Camera, Light, FurtherLight, *(kind.element for kind in KINDS))

ELEMENTS = {element.code: element for element in KNOWN}

# The same by every word that a line may begin with.
SPELLINGS = {**ELEMENTS, **{alias: element for element in KNOWN for alias in element.aliases}}
