"""Target of a picture or film: its name, format and limits, checked before the work."""

from __future__ import annotations

import argparse
import os
from pathlib import Path
from typing import TYPE_CHECKING

from minirt.errors import RenderError

if TYPE_CHECKING:
    from minirt.scene import Scene

PLACE = "{name}"  # stands for the name of the scene's file, without its extension


def output_for(scene: str, output: str) -> str:
    """Return the output of a scene: `out/{name}.png` is `out/demo.png` for `scenes/demo.rt`."""
    return output.replace(PLACE, "stdin" if scene == "-" else Path(scene).stem)


def target_of(options: argparse.Namespace) -> str | None:
    """Return the file that the options ask for, or None."""
    return options.output if options.output and options.output != "-" else None


def is_film(options: argparse.Namespace) -> bool:
    """Whether the output is one file of several pictures."""
    from minirt.formats.table import FORMATS, format_of

    target = target_of(options)
    return bool((options.turntable or options.replay) and target and FORMATS[format_of(target)].is_film)


def needs_light(options: argparse.Namespace, output: str) -> bool:
    """Whether the file is made of linear light, and not of levels of 8 bits."""
    from minirt.formats.table import FORMATS, format_of

    name = "PNG" if output == "-" else format_of(output)
    return (options.bits or FORMATS[name].bits[0]) != 8


def check_format(options: argparse.Namespace) -> None:
    """Check that the format of the output fits the other options; RenderError otherwise."""
    from minirt.formats.table import FORMATS, check_bits, check_quality, format_of

    for output in filter(None, (options.output, options.fallback)):
        name = "PNG" if output == "-" else format_of(output)
        if not (options.turntable or options.replay or FORMATS[name].is_still):
            raise RenderError(f"{output}: a film needs --turntable or --replay, a picture is .png or .jpg")
        check_bits(name, options.bits)
        check_quality(name, options.quality)
        if options.replay and needs_light(options, output):
            raise RenderError(f"{output}: the frames of a replay have 8 bits a channel, try .png without --bits")


def check_region(options: argparse.Namespace, output: str, width: int, height: int) -> int:
    """Check that the region that the options ask for, or all of a picture of this size, can be written to a file;
    RenderError otherwise. Return its height."""
    from minirt.rendering.packing.camera import cut_for

    cut_for(options.region, width, height)
    *_, across, down = options.region or (width, height)
    check_target(options, output, across, down)
    return int(down)


def check_memory(options: argparse.Namespace, output: str, size: tuple[int, int]) -> None:
    """Check that there is memory to render and write a picture of this size, or its region; RenderError otherwise."""
    from minirt import LIGHT
    from minirt.formats.table import format_of, memory_of
    from minirt.helpers import system

    name = "PNG" if output == "-" else format_of(output)
    *_, width, height = options.region or size
    is_light_extra = (options.dither or options.verbose) and not needs_light(options, output)
    needed = memory_of(name, options.bits) + LIGHT * is_light_extra
    system.check_picture(height, width, needed)


def is_rendered_in_bands(scene: Scene, options: argparse.Namespace) -> bool:
    """Whether a picture does not fit into memory, but is written to a file that can be made of bands of rows."""
    from minirt import size_of
    from minirt.formats.table import format_of
    from minirt.helpers.system import TooLargeError

    if options.output == "-" or format_of(options.output) != "TIFF" or options.time:
        return False
    try:
        check_memory(options, options.output, options.size or size_of(scene))
    except TooLargeError:
        return True
    return False


def check_target(options: argparse.Namespace, output: str, width: int, height: int) -> None:
    """Check that a picture of this size can be written to a file; RenderError otherwise."""
    if output == "-":
        return
    from minirt.formats.table import check_size, format_of
    from minirt.helpers import file_io

    check_size(output, format_of(output), width, height)
    try:
        file_io.probe(output)
    except OSError as error:
        raise RenderError(f"{os.fspath(output)}: cannot write: {error.strerror or error}") from None
