"""Required elements of a scene: errors about those that a file does not have, each with a line that could be added."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from itertools import chain, islice
from math import dist

from minirt.element import pattern
from minirt.fields import FARTHEST, clamp
from minirt.scene import files
from minirt.scene.elements import WHITE, Ambient, Camera, FurtherCamera
from minirt.scene.lines import Log, line_from
from minirt.scene.pages import Item
from minirt.scene.registry import SHAPES
from minirt.scene.writer import describe

AMBIENT = Ambient(0.2, WHITE)
USUAL_BOX = (-1.0, -1.0, -1.0), (1.0, 1.0, 1.0)  # that a camera shows where no shape is bounded
MOST_SHOWN = 1000  # elements that the camera of an example shows
BACK = 2.0  # distance of a camera from what it shows, in diameters of that


def check_required(seen: dict[str, int], sources: list[str], runs: list[Sequence[Item]], log: Log) -> None:
    """Report the required elements that a file does not have. `seen` has the identifiers of its lines."""
    if not seen:
        raise files.file_error(log.file, files.NO_ELEMENTS)
    number = len(sources) if sources[-1] or len(sources) == 1 else len(sources) - 1
    last = line_from(number, "")  # which is not to be shown, as nothing is wrong with it
    if Ambient.code not in seen:
        log.error(last, absent(AMBIENT), 1)
    if Camera.code not in seen and (further := seen.get(FurtherCamera.code)):
        message = f"no {Camera.title} 'C': all are further ones, '{FurtherCamera.code}'"
        log.error(line_from(further, sources[further - 1]), message, 1)
    elif Camera.code not in seen:
        log.error(last, absent(camera_before(islice(chain.from_iterable(runs), MOST_SHOWN))), 1)


def absent(example: Ambient | Camera) -> str:
    """Return the message about an absent element, with an example of its line."""
    fields = pattern(type(example)).partition(" [")[0]
    return f"no {example.title}: a scene needs one line '{fields}', such as '{describe(example)}'"


def camera_before(items: Iterable[Item]) -> Camera:
    """Return a camera that looks along z and has the bounded shapes among some items in its picture."""
    boxes = [box for item in items if isinstance(item, SHAPES) and (box := item.bounds())] or [USUAL_BOX]
    low, high = (tuple(map(end, *chain(*boxes, *boxes))) for end in (min, max))
    x, y, z = ((a + b) / 2 for a, b in zip(low, high, strict=True))
    return Camera((rounded(x), rounded(y), rounded(z - BACK * dist(low, high))), (0.0, 0.0, 1.0), 60.0)


def rounded(coordinate: float) -> float:
    """Round a coordinate to three digits, within the range of coordinates."""
    return clamp(float(f"{coordinate:.3g}"), -FARTHEST, FARTHEST)
