"""What surfaces are made of: one file an attribute, with its manual page.

`minirt.shapes.shape` gives them to all shapes. `pictures` reads the files that some of them name.
"""

from minirt.materials.bump import Bump
from minirt.materials.checker import Checker
from minirt.materials.compound import Compound
from minirt.materials.glass import Glass
from minirt.materials.mirror import Mirror
from minirt.materials.normal_map import NormalMap
from minirt.materials.specular import Specular
from minirt.materials.texture import Texture

__all__ = ["Bump", "Checker", "Compound", "Glass", "Mirror", "NormalMap", "Specular", "Texture"]
