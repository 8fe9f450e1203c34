"""Rendering one picture to a file or to standard output."""

from __future__ import annotations

import argparse
from typing import TYPE_CHECKING, Any

from minirt.cli.arguments import FAILED, OK, SAMPLES
from minirt.cli.output import say_bytes, tell
from minirt.cli.target import check_memory, check_region, needs_light
from minirt.helpers.progress import State, progress
from minirt.helpers.system import gc_paused

if TYPE_CHECKING:
    from minirt.cli.part_file import PartFile
    from minirt.cli.strips import Strips
    from minirt.image import Image
    from minirt.rendering import Renderer
    from minirt.scene import Scene


def render_to_file(scene: Scene, options: argparse.Namespace) -> int:
    """Render the scene and write the picture to the output."""
    import minirt
    from minirt.cli.strips import Strips
    from minirt.cli.work import kept_work

    samples = options.samples or SAMPLES
    size = options.size or minirt.size_of(scene)
    with gc_paused():
        if samples == "auto":  # whose samples depend on those before: it cannot go on
            image = render(scene, options, options.output)
            write(image, options.output, scene, options)
        else:
            check_region(options, options.output, *size)
            strips = Strips(scene, options, size, samples)
            with kept_work(scene, options, size, strips.rays, len(strips.strips), "strips of the picture") as part:
                image = render(scene, options, options.output, strips, part)
                write(image, options.output, scene, options)
    return FAILED if options.strict and image.reached and not image.reached.is_reached else OK


def render(
    scene: Scene,
    options: argparse.Namespace,
    output: str,
    strips: Strips | None = None,
    part: PartFile | None = None,
) -> Image:
    """Render the scene for an output as the options ask, with a part file in strips; print measurements and notices to
    standard error."""
    from time import perf_counter

    import minirt
    from minirt.rendering.queries.preview import notice_about

    width, height = options.size or minirt.size_of(scene)
    rows = check_region(options, output, width, height)
    check_memory(options, output, (width, height))
    start = perf_counter()
    renderer = minirt.renderer(options.threads, options.precision, options.depth, options.dither)
    if options.verbose:
        renderer.prepare(scene)
        tell(f"kernel ready after {perf_counter() - start:.2f} s")
        start = perf_counter()
    samples = options.samples or SAMPLES
    settings: dict[str, Any] = {name: getattr(options, name) for name in ("threads", "precision", "depth", "dither")}
    settings["linear"] = needs_light(options, output)
    if strips and part:
        with progress(lambda: State(output, strips.share(renderer))):
            image = strips.render(part, renderer, **settings)
        not_finite = strips.not_finite
    else:
        goal = {"samples": samples, "error": options.error, "time": options.time}
        with progress(lambda: state(renderer, options, rows, perf_counter() - start)):
            image = minirt.render(scene, width, height, region=options.region, **goal, **settings)
        not_finite = renderer.not_finite
    if image.reached:
        tell(image.reached)
        if image.reached.notice:
            tell(f"notice: {image.reached.notice}")
    if options.precision == "single":
        from minirt.report.stiffness import lost_in_single

        for stiff in lost_in_single(scene, renderer.packing, width, height):
            tell(f"notice: single precision cannot show {stiff}")
    if options.verbose:
        place = f"region {options.region}, " if options.region else ""
        sampling = "" if image.reached else f"{samples} samples a pixel, "
        tell(
            f"{width}x{height}, {place}{sampling}{renderer.threads} threads, {renderer.precision} precision: "
            f"{(perf_counter() - start) * 1e3:.1f} ms"
        )
        tell(f"rays whose light is not finite: {not_finite}")
        clipping = clipped(scene, options, width, height)
        for note in renderer.notes:  # of the whole picture, since the light that is clipped was rendered
            tell(note)
        tell(clipping)
    if not options.region and (notice := notice_about(scene, image.array)):
        tell(f"notice: {notice}")
    return image


def state(renderer: Renderer, options: argparse.Namespace, height: int, seconds: float) -> State:
    """Return how far a picture is: by its rows, or by its time; nobody knows how long an error takes."""
    if options.samples != "auto":
        return State(options.output or "picture", rows_done(renderer, height))
    return State("sampling", seconds / options.time if options.time else None)


def rows_done(renderer: Renderer, height: int) -> float:
    """Return the share of the rows of a picture that threads have taken."""
    return renderer.rows_done(height)


def clipped(scene: Scene, options: argparse.Namespace, width: int, height: int) -> str:
    """Count the pixels that are brighter than the picture can show, by their light with one sample each."""
    import minirt
    from minirt.rendering.tone_mapping import clipped_pixels

    settings = {"threads": options.threads, "precision": options.precision, "depth": options.depth}
    light = minirt.render(scene, width, height, region=options.region, **settings).linear
    count, pixels = clipped_pixels(light, scene.camera.tone), light.size // 3
    share = f"{100 * count / pixels:.2g} %"
    return f"clipped pixels, brighter than the picture can show: {count} of {pixels} ({share}), by one sample each"


def write(image: Image, output: str, scene: Scene, options: argparse.Namespace) -> None:
    """Write a picture to a file, or to standard output as PNG when `output` is `-`; PNG carries scene and settings.

    The picture may be overwritten.
    """
    texts = texts_for(output, scene, options) if options.metadata else {}
    if output == "-":
        say_bytes(image.encode(bits=options.bits, quality=options.quality, texts=texts))
        return
    image.save(output, bits=options.bits, quality=options.quality, texts=texts)


def texts_for(output: str, scene: Scene, options: argparse.Namespace) -> dict[str, str]:
    """Return the texts that a picture of the scene carries."""
    import minirt
    from minirt.cli.options import settings_text
    from minirt.scene import dump, files

    width, height = options.size or minirt.size_of(scene)
    way = files.way_to_scene("" if output == "-" else output, scene.file)
    return files.picture_texts(dump(scene), settings_text(options, width, height), way)
