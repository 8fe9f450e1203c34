"""Additions to the program as a newcomer makes them by `minirt/README.md`: what goes where in a copy of the project.

A new file is copied. Of a class or a function that goes into a file of the project, only what stands below the line
`# What goes into` is added, so that linters see a whole module here.
"""

from __future__ import annotations

import shutil
from pathlib import Path
from typing import NamedTuple

HERE = Path(__file__).parent
BELOW = "# What goes into "
SHADING, MATERIALS, ELEMENTS = "minirt/kernel/shading", "minirt/materials/__init__.py", "minirt/scene/elements.py"
BINDINGS, COMMANDS, CHECKS = (
    "minirt/viewer/bindings.py",
    "minirt/viewer/app/commands.py",
    "tests/viewer/test_bindings.py",
)


class Addition(NamedTuple):
    """New files, from those of this folder, and texts that replace others in files of the project."""

    new: tuple[tuple[str, str], ...] = ()  # the name here, and the file there
    changed: tuple[tuple[str, str, str], ...] = ()  # the file, a text that it has once, and what replaces that

    @property
    def folders(self) -> set[str]:
        """The folders that get a new file."""
        return {str(Path(file).parent) for _, file in self.new}

    @property
    def files(self) -> set[str]:
        """The files that change."""
        return {file for file, _, _ in self.changed}


def below(file: str, anchor: str, line: str) -> tuple[str, str, str]:
    """A line that is put below the one that is the anchor."""
    return file, f"{anchor}\n", f"{anchor}\n{line}\n"


def part(name: str) -> str:
    """The class or the function of a file of this folder."""
    _, text = (HERE / name).read_text(encoding="utf-8").split(BELOW)
    return text.split("\n", 1)[1]


def field(name: str, title: str, doc: str, above: str) -> tuple[str, str, str]:
    """The field of a material, above that of another."""
    line = f'    {name}: {title} | None = declare(Compound, "{doc}", record={title}, default=None, shared=SHARED)\n'
    return MATERIALS, f"    {above}:", f"{line}    {above}:"


SHAPE = "from minirt.shapes.{0} import {1} as {1}"
MAPPED = 'MAPPED: dict[str, Any] = {"mapped": True} | SHARED'
ARRAY = "    rough: Any = None  # (n,) squared slope of matt surfaces, see `minirt.kernel.shading.rough`"
GLOW = "    glow = splat(scene.glow[index], point.x) if has_rows(scene.glow) else splat(0.0, point.x)"
AIM = "from minirt.kernel.shading.lights import aim, is_spread, remembered_part, sources_in_reach, specular"
COSINE = "        cosine = dot(shading_normal, to_light) * strength"
SHARE = """        if has_rows(scene.rough):
            cosine = cosine * rough_share(surface.rough, shading_normal, to_light, ray.direction)"""
CAMERA_KEY = '    once(FILE, "copy camera", "copy the camera\'s line", "Ctrl+C"),'
CAMERA_CHECK = '    "copy camera": ((), lambda _, after: memory(after).clipboard == describe(scene().camera)),'
CHECK = '    "copy line": (SPHERE, lambda _, after: memory(after).clipboard == describe(after.state.element)),'

# By the rows of the table of `minirt/README.md`.
ADDITIONS = {
    "capsule": Addition(
        (("capsule.py", "minirt/shapes/capsule.py"),),
        (below("minirt/shapes/__init__.py", SHAPE.format("torus", "Torus"), SHAPE.format("capsule", "Capsule")),),
    ),
    "sheen": Addition(
        changed=(
            below(MATERIALS, MAPPED, f"\n\n{part('sheen.py')}\n"),
            field("sheen", "Sheen", "soft highlight", "clouds"),
        )
    ),
    "rough": Addition(
        (("rough.py", f"{SHADING}/rough.py"),),
        (
            (MATERIALS, "\n\nSHARED: dict", f"\n\n\n{part('rough_class.py')}\n\nSHARED: dict"),
            field("rough", "Rough", "roughness of a matt surface", "glow"),
            below("minirt/kernel/scene_arrays.py", "    # the kernel has the feature and the scene lacks it.", ARRAY),
            (
                f"{SHADING}/surfaces.py",
                "    glow: Number",
                "    rough: Number  # the shape's row of `SceneArrays.rough`\n    glow: Number",
            ),
            below(f"{SHADING}/surfaces.py", GLOW, GLOW.replace("glow", "rough")),
            (f"{SHADING}/surfaces.py", "reflective, glow, fades", "reflective, rough, glow, fades"),
            below(f"{SHADING}/shade.py", AIM, "from minirt.kernel.shading.rough import rough_share"),
            below(f"{SHADING}/shade.py", COSINE, SHARE),
            below(
                "minirt/rendering/packing/features.py",
                '    "glow": Feature("glow", 0.0, single=True),',
                '    "rough": Feature("rough surfaces", 0.0, single=True),',
            ),
        ),
    ),
    "torch": Addition(
        changed=(
            (ELEMENTS, "\n\nFURTHER: dict", f"\n\n{part('torch.py')}\n\nFURTHER: dict"),
            (ELEMENTS, "ParallelLight, SpotLight)\n", "ParallelLight, SpotLight, Torch)\n"),
        )
    ),
    "copy line": Addition(
        changed=(
            below(BINDINGS, CAMERA_KEY, '    once(FILE, "copy line", "copy the line of the element", "J"),'),
            below(COMMANDS, '    "copy camera": copy_camera,', '    "copy line": copy_line,'),
            (COMMANDS, "\n\nCOMMANDS: dict", f"\n\n{part('copy_line.py')}\n\nCOMMANDS: dict"),
            below(CHECKS, CAMERA_CHECK, CHECK),
        )
    ),
}


def add(addition: Addition, root: Path) -> None:
    """Make an addition in a copy of the project."""
    for name, file in addition.new:
        shutil.copy(HERE / name, root / file)
    for file, old, new in addition.changed:
        text = (root / file).read_text(encoding="utf-8")
        assert text.count(old) == 1, f"{file} has {old!r} {text.count(old)} times"
        (root / file).write_text(text.replace(old, new), encoding="utf-8")
