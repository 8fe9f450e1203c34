"""Registry of all elements that a scene file may hold, by identifier."""

from __future__ import annotations

from minirt.element import Element
from minirt.scene.elements import Ambient, Background, Camera, Resolution
from minirt.scene.lights import FurtherLight, Light, ParallelLight, SpotLight
from minirt.shapes import ALL_KINDS

KNOWN: tuple[type[Element], ...] = (
    *(Resolution, Ambient, Background, Camera),
    *(Light, FurtherLight, ParallelLight, SpotLight),
    *(kind.element for kind in ALL_KINDS),
)

ELEMENTS = {element.code: element for element in KNOWN}

# By every identifier that a line may begin with, aliases included.
SPELLINGS = {**ELEMENTS, **{alias: element for element in KNOWN for alias in element.aliases}}
