"""Renders scenes to pixels: packing, culling, sampling and threads.

Knows no window and no file; imports the compiler only when the first picture is made.
"""

from minirt.rendering.renderer import Renderer

__all__ = ["Renderer"]
