"""Base of solid textures: `marble:`, `wood:` and `clouds:` have the same values.

They are formulas of space in the frame of the shape, computed by `minirt.kernel.shading.patterns`.
"""

from __future__ import annotations

from minirt.fields import Colour, Count, Length, Real, Triple, declare
from minirt.materials.material import Material
from minirt.records import record

MOST_OCTAVES = 12


@record()
class Pattern(Material):
    """The values of a pattern."""

    feature = "patterns"
    size: float = declare(Length, "size of the pattern")
    colour: Triple = declare(Colour, "the second colour", default=(0, 0, 0))
    octaves: int = declare(Count, "levels of detail", low=1, high=MOST_OCTAVES, default=6)
    height: float = declare(Real, "height of the second colour, in sizes", low=-10.0, high=10.0, step=0.01, default=0.0)

    def used_feature(self) -> str:
        return "raised_patterns" if self.height else self.feature
