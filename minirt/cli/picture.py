"""Rendering one picture to a file or to standard output."""

from __future__ import annotations

import argparse
from typing import TYPE_CHECKING

from minirt.cli.arguments import SAMPLES
from minirt.cli.exit_status import FAILED, OK
from minirt.cli.output import say_bytes, tell
from minirt.gc_pause import gc_paused

if TYPE_CHECKING:
    from minirt.image import Image
    from minirt.rendering import Renderer
    from minirt.scene import Scene


def render_to_file(scene: Scene, options: argparse.Namespace) -> int:
    """Render the scene and write the picture to the output."""
    with gc_paused():
        image = render(scene, options)
        write(image, options.output)
    return FAILED if options.strict and image.reached and not image.reached.is_reached else OK


def render(scene: Scene, options: argparse.Namespace) -> Image:
    """Render the scene as the options ask; print measurements and notices to standard error."""
    from time import perf_counter

    import minirt
    from minirt.rendering.queries.in_view import notice_about

    width, height = options.size or minirt.size_of(scene)
    start = perf_counter()
    renderer = minirt.renderer(options.threads, options.precision, options.depth, options.dither)
    if options.verbose:
        renderer.prepare(scene)
        tell(f"kernel ready after {perf_counter() - start:.2f} s")
        start = perf_counter()
    samples = options.samples or SAMPLES
    image = minirt.render(
        scene,
        width,
        height,
        samples=samples,
        error=options.error,
        time=options.time,
        threads=options.threads,
        precision=options.precision,
        depth=options.depth,
        linear=False,
        dither=options.dither,
    )
    if image.reached:
        tell(image.reached)
        if image.reached.notice:
            tell(f"notice: {image.reached.notice}")
    if options.precision == "single":
        from minirt.report.measurements.stiffness import lost_in_single

        for stiff in lost_in_single(scene, renderer.packing, width, height):
            tell(f"notice: single precision cannot show {stiff}")
    if options.verbose:
        sampling = "" if image.reached else f"{samples} samples a pixel, "
        tell(
            f"{width}x{height}, {sampling}{renderer.threads} threads, {renderer.precision} precision: "
            f"{(perf_counter() - start) * 1e3:.1f} ms"
        )
        tell(f"rays whose light is not finite: {renderer.not_finite}")
        for note in renderer.notes:
            tell(note)
        tell(clipped(scene, renderer, width, height))
    if notice := notice_about(scene, image.array):
        tell(f"notice: {notice}")
    return image


def clipped(scene: Scene, renderer: Renderer, width: int, height: int) -> str:
    """Count the pixels that are brighter than the picture can show, by their light with one sample each."""
    import numpy as np

    from minirt.rendering.developing.develop import clipped_pixels

    light = np.zeros((height, width, 3))
    renderer.render(scene, np.empty((height, width, 4), np.uint8), 1, light)
    count = clipped_pixels(light, scene.camera.tone)
    share = f"{100 * count / (width * height):.2g} %"
    return (
        f"clipped pixels, brighter than the picture can show: {count} of {width * height} ({share}), by one sample each"
    )


def write(image: Image, output: str) -> None:
    """Write a picture to a file, or to standard output as PNG when `output` is `-`."""
    if output == "-":
        say_bytes(image.encode())
        return
    image.save(output)
