"""Write the names of the elements of a scene for type checkers and editors anew: python -m tests.make_plurals"""

from __future__ import annotations

from minirt.scene import Scene
from minirt.scene.registry import ELEMENTS
from tests.paths import PACKAGE

FILE = PACKAGE / "scene" / "plurals.py"
HEAD = '''"""Elements of a scene by kind, as type checkers and editors see them: `scene.spheres`.

`python -m tests.make_plurals` writes this file from the registry of elements.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
'''
CLASS = '''

class Plurals:
    """Base class of scenes: the elements of each kind, in the order of the file."""

    if TYPE_CHECKING:
'''


def plurals() -> str:
    """Text of the file."""
    kinds = [kind for kind in ELEMENTS.values() if kind.plural not in vars(Scene)]
    names: dict[str, list[str]] = {}
    for kind in kinds:
        names.setdefault(kind.__module__, []).append(kind.__name__)
    imports = (f"    from {module} import {', '.join(sorted(names[module]))}\n" for module in sorted(names))
    properties = (
        f"\n        @property\n        def {kind.plural}(self) -> tuple[{kind.__name__}, ...]: ...\n" for kind in kinds
    )
    return HEAD + "".join(imports) + CLASS + "".join(properties)


if __name__ == "__main__":
    FILE.write_text(plurals(), encoding="utf-8")
