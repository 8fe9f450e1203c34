"""Commands of the program, and their selection by options.

A command takes a scene and the options, and returns an exit status.
"""

from __future__ import annotations

import argparse
from collections.abc import Callable
from typing import TYPE_CHECKING

from minirt.cli.exit_status import OK
from minirt.cli.output import say
from minirt.cli.picture import render_to_file
from minirt.cli.turntable import render_turntable
from minirt.cli.window import replay, show
from minirt.helpers.progress import State, progress

if TYPE_CHECKING:
    from minirt.scene import Scene

Command = Callable[["Scene", argparse.Namespace], int]


def command_for(options: argparse.Namespace) -> Command:
    """Return the command that the options select; showing a window is the default."""
    commands: tuple[tuple[object, Command], ...] = (
        (options.check, check),
        (options.bench, bench),
        (options.report, report),
        (options.replay, replay),
        (options.cluster, render_by_workers),
        (options.turntable, render_turntable),
        (options.output, render_picture),
    )
    return next((command for selected, command in commands if selected), show)


def check(scene: Scene, options: argparse.Namespace) -> int:
    """Print that the scene was read without errors, and the number of its shapes and lights."""
    say(f"{options.scene[0]}: no errors, {len(scene.shapes)} shapes, {len(scene.lights)} lights")
    return OK


def render_picture(scene: Scene, options: argparse.Namespace) -> int:
    """Render a picture to a file, in bands where it does not fit into memory and the format allows it."""
    from minirt.cli.target import is_rendered_in_bands

    return (render_by_workers if is_rendered_in_bands(scene, options) else render_to_file)(scene, options)


def render_by_workers(scene: Scene, options: argparse.Namespace) -> int:
    """Render a picture or a turntable in parts, by other processes or machines if the options name some."""
    if options.turntable:
        from minirt.cli.cluster_frames import render_frames

        return render_frames(scene, options)
    from minirt.cli.cluster import render_bands

    return render_bands(scene, options)


def bench(scene: Scene, options: argparse.Namespace) -> int:
    """Measure the frame time and print it."""
    from minirt.bench import measure, report

    with progress(lambda: State("measuring")):
        measured = measure(options.scene[0], scene, options.size, options.threads, options.precision)
    say(report(measured, options.json))
    return OK


def report(scene: Scene, options: argparse.Namespace) -> int:
    """Measure error against run time and write the report into a folder."""
    import minirt
    from minirt.report import report as write_report

    size = options.size or minirt.size_of(scene)
    how = options.threads, options.quick, options.ablation
    say(write_report(scene, options.scene[0], options.report, size, *how))
    return OK
