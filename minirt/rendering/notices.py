"""Notices about a picture: what it cannot show, what its user may not have expected, and how it was rendered."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from minirt.errors import counted
from minirt.rendering.packing.features import features
from minirt.rendering.queries.no_effect import without_effect
from minirt.rendering.queries.unseen import notice_about
from minirt.rendering.tone_mapping import clipped_pixels
from minirt.scene import Scene

if TYPE_CHECKING:  # a command that only checks a scene imports no renderer
    from minirt.rendering.scene_packing import Packing
    from minirt.rendering.settings import RenderSettings

NOT_COMPUTED = "a notice about the picture cannot be computed"


def notices_about(
    scene: Scene, image: np.ndarray | None, size: tuple[int, int], single: Packing | None = None, samples: object = None
) -> Iterator[str]:
    """Yield sentences about a scene in a picture of this size: what its user may not have expected.

    `image` (h, w, channels) is the picture or a region of it, None where it is not rendered. `single` is the packing of
    a picture that this process has rendered in single precision, None for others, `samples` the number for each pixel.

    A notice costs nobody the picture: numbers that leave the range of a float64 or of a field are told in its place.
    """
    try:
        if single:
            from minirt.rendering.queries.stiffness import lost_in_single
            from minirt.rendering.scene_packing import IN_DOUBLE

            if single.computed_in == IN_DOUBLE:
                yield IN_DOUBLE

            for each in lost_in_single(scene, single, *size):
                yield f"single precision cannot show {each}"
        if (image is None or image.shape[1::-1] == size) and (text := notice_about(scene, size, image)):
            yield text
        if samples == 1 and features(scene) & {"soft", "lens"}:
            yield "with one sample a pixel the size of a light or lens has no effect: try --samples auto"
        yield from without_effect(scene, size)
    except (ArithmeticError, ValueError) as error:
        yield f"{NOT_COMPUTED}: {error}"


def measurements(
    scene: Scene, size: tuple[int, int], settings: RenderSettings, seconds: float, not_finite: int
) -> Iterator[str]:
    """Yield lines about a picture that was rendered in this process, in so many seconds and with `not_finite` rays
    whose light was not: its time, how its scene was packed, and how many pixels are brighter than the picture can show.

    For these the picture is rendered once more, with one sample for each pixel.
    """
    from minirt.rendering.settings import rendered

    renderer = settings.renderer
    place = f"region {','.join(map(str, settings.region))}, " if settings.region else ""
    sampling = "" if settings.samples == "auto" else f"{counted(settings.samples, 'sample')} a pixel, "
    threads = f"{counted(renderer.threads, 'thread')}, {renderer.packing.computed_in.partition(':')[0]}"
    yield f"{size[0]}x{size[1]}, {place}{sampling}{threads}: {seconds * 1e3:.1f} ms"
    yield f"rays whose light is not finite: {not_finite}"
    once = settings.replace(samples=1, error=None, time=None, linear=True, dither=False)
    light = rendered(scene, size, once).light("clipped pixels")
    yield from renderer.notes  # of the whole picture, since this light was rendered
    count, pixels = clipped_pixels(light, scene.camera.tone), light.size // 3
    share = f"{100 * count / pixels:.2g} %"
    yield f"clipped pixels, brighter than the picture can show: {count} of {pixels} ({share}), by one sample each"
