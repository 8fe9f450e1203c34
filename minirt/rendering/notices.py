"""Notices about a picture: what it cannot show, and what its user may not have expected."""

from __future__ import annotations

from typing import NamedTuple

from minirt.rendering.image import Image
from minirt.rendering.queries.preview import notice_about
from minirt.rendering.queries.stiffness import lost_in_single
from minirt.rendering.settings import RenderSettings, rendered
from minirt.rendering.tone_mapping import clipped_pixels
from minirt.scene import Scene


class Notices(NamedTuple):
    """Sentences about a picture."""

    lost: list[str]  # for each shape that single precision cannot show
    clipped: str  # how many pixels are brighter than the picture can show; empty unless asked for
    view: str  # that nothing is in view, and what would show the scene; empty for other pictures, and for a region


def notices_about(
    scene: Scene, size: tuple[int, int], settings: RenderSettings, image: Image, counts_clipped: bool
) -> Notices:
    """Look at a picture of this size, or at its region, that was rendered with some settings in this process."""
    lost = list(lost_in_single(scene, settings.renderer.packing, *size)) if settings.precision == "single" else []
    return Notices(
        [f"single precision cannot show {each}" for each in lost],
        clipped(scene, size, settings) if counts_clipped else "",
        "" if settings.region else notice_about(scene, image.array),
    )


def clipped(scene: Scene, size: tuple[int, int], settings: RenderSettings) -> str:
    """Count the pixels that are brighter than the picture can show, by their light with one sample each."""
    once = settings.replace(samples=1, error=None, time=None, linear=True, dither=False)
    light = rendered(scene, size, once).light("clipped pixels")
    count, pixels = clipped_pixels(light, scene.camera.tone), light.size // 3
    share = f"{100 * count / pixels:.2g} %"
    return f"clipped pixels, brighter than the picture can show: {count} of {pixels} ({share}), by one sample each"
