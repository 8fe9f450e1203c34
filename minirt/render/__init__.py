"""The package is now minirt.rendering (minirt.render is a function); this stands here for a few minutes only: import from minirt.rendering."""
from minirt.rendering import Renderer, pick  # noqa
