"""Commands about pixels: why one has its colour, and what all of them show."""

from __future__ import annotations

import argparse
import json
import os
import sys

from minirt.cli.arguments import OK, say
from minirt.cli.files import check_output, format_name, write
from minirt.formats.table import FLOAT, FORMATS
from minirt.helpers import system
from minirt.helpers.progress import State, progress
from minirt.rendering.buffers import buffers
from minirt.rendering.queries.explain import explain
from minirt.rendering.queries.tree_text import TreeText
from minirt.scene import Scene, size_of

MEMORY = 500  # bytes a pixel of all buffers while they are made


def explain_pixel(scene: Scene, options: argparse.Namespace) -> int:
    """Print the tree of rays of a pixel, in a terminal with the colours of light; or as JSON."""
    explanation = explain(scene, *(options.size or size_of(scene)), *options.explain, depth=options.depth)
    has_colours = sys.stdout.isatty() and "NO_COLOR" not in os.environ
    say(json.dumps(explanation.as_dict()) if options.json else f"{TreeText(explanation, has_colours)}")
    return OK


def write_buffer(scene: Scene, options: argparse.Namespace) -> int:
    """Write one of the buffers of a picture: its numbers to files of floating-point numbers and TIFF, else colours."""
    width, height = options.size or size_of(scene)
    check_output(options.output, width, height)
    system.check_picture(height, width, MEMORY)
    name = format_name(options.output)
    with progress(lambda: State("tracing")):
        picture = buffers(scene, width, height, threads=options.threads).picture(options.buffers)
    write(picture.encode(name, bits=FLOAT if FLOAT in FORMATS[name].bits else None), options.output)
    return OK
