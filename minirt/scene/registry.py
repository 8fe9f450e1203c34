"""Registry of all elements of a scene file, by identifier."""

from __future__ import annotations

from minirt.element import Element
from minirt.scene.elements import Ambient, Background, Camera, Resolution
from minirt.scene.lights import FurtherLight, Light, ParallelLight, SpotLight
from minirt.shapes import ALL_KINDS

KINDS: tuple[type[Element], ...] = (
    *(Resolution, Ambient, Background, Camera),
    *(Light, FurtherLight, ParallelLight, SpotLight),
    *(kind.element for kind in ALL_KINDS),
)

ELEMENTS = {element.code: element for element in KINDS}

# All elements by every word that a line may begin with: identifiers and aliases.
SPELLINGS = {**ELEMENTS, **{alias: element for element in KINDS for alias in element.aliases}}
