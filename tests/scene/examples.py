"""Example scenes of the tests of this folder."""

from __future__ import annotations

from minirt.errors import Problem, SceneError
from minirt.scene import Scene, parse

AMBIENT = "A 0.2 255,255,255"
CAMERA = "C 0,0,-5 0,0,1 70"
LIGHT = "L -40,0,30 0.7 255,255,255"
SPHERE = "sp 0,0,20 12.6 10,0,255"
PLANE = "pl 0,-1,0 0,1,0 200,200,200"
CYLINDER = "cy 0,0,20 0,1,0 2 5 255,200,0"
WHOLE = "\n".join((AMBIENT, CAMERA, LIGHT, "", "# shapes", SPHERE, PLANE, CYLINDER, ""))

SUBJECT = "\n".join(  # as printed in the subject: a camera without a direction, a normal of four numbers
    (
        "A 0.2 255,255,255",
        "C -50,0,20 0,0,0 70",
        "L -40,0,30 0.7 255,255,255",
        "pl 0,0,0 0,1,0,0 255,0,225",
        "sp 0,0,20 20 255,0,0",
        "cy 50.0,0.0,20.6 0,0,1.0 14.2 21.42 10,0,255",
        "",
    )
)


def scene_with(*lines: str) -> str:
    """Return the text of a scene: ambient light, camera, then `lines`."""
    return "\n".join((AMBIENT, CAMERA, *lines, ""))


def read(*lines: str, lenient: bool = False) -> Scene:
    """Parse the scene with `lines`."""
    return parse(scene_with(*lines), "test.rt", lenient).scene


def problems(text: str | bytes, lenient: bool = False) -> tuple[Problem, ...]:
    """Return the errors of a scene; AssertionError when it is accepted."""
    try:
        parse(text, "test.rt", lenient)
    except SceneError as error:
        return error.problems
    raise AssertionError(f"accepted: {text!r}")


def notices(*lines: str, lenient: bool = False) -> list[tuple[int, int, str]]:
    """Return line, column and message of the notices about an accepted scene with `lines`."""
    return [(each.line, each.column, each.message) for each in parse(scene_with(*lines), "test.rt", lenient).notices]
