"""Rendering a turntable: pictures from all around the scene."""

from __future__ import annotations

import argparse
from typing import TYPE_CHECKING

from minirt.cli.arguments import SAMPLES
from minirt.cli.exit_status import OK
from minirt.gc_pause import gc_paused

if TYPE_CHECKING:
    from minirt.scene import Scene


def render_turntable(scene: Scene, options: argparse.Namespace) -> int:
    """Render the scene from all around it and write the movie; show the progress on a terminal."""
    import minirt
    from minirt.movie import with_progress
    from minirt.viewer.app.animation import turntable

    width, height = options.size or minirt.size_of(scene)
    pictures = (
        minirt.render(
            view,
            width,
            height,
            samples=options.samples or SAMPLES,
            threads=options.threads,
            precision=options.precision,
            depth=options.depth,
            dither=options.dither,
        )
        for view in with_progress(turntable(scene, options.turntable), options.turntable, "picture")
    )
    with gc_paused():
        minirt.save_movie(pictures, options.output)
    return OK
