"""Commands of the program, and their selection by options.

A command takes a scene and the options, and returns an exit status.
"""

from __future__ import annotations

import argparse
import os
import sys
from collections.abc import Callable
from typing import Any

from minirt.cli.arguments import FAILED, OK, SAMPLES, WINDOW_SAMPLES, say, tell
from minirt.errors import MlxError, RenderError, SceneError, counted
from minirt.helpers import file_io, system
from minirt.helpers.progress import WorkState, progress
from minirt.helpers.signals import ended_by_signals, leave_at_once
from minirt.scene import Scene, size_of

MAX_RECORDING = 16 * 2**20  # bytes of a file of recorded keys

Command = Callable[["Scene", argparse.Namespace], int]


def command_for(options: argparse.Namespace) -> Command:
    """Return the command that the options select; showing a window is the default."""
    commands = {"check": check, "bench": bench, "report": report, "explain": explain, "compare": compare}
    commands |= {"replay": replay, "buffers": write_buffer, "output": render}
    return next((command for name, command in commands.items() if getattr(options, name)), show)


def check(scene: Scene, options: argparse.Namespace) -> int:
    """Print that the scene was read without errors, and the number of its shapes and lights."""
    shapes, lights = counted(len(scene.shapes), "shape"), counted(len(scene.lights), "light")
    say(f"{options.scene[0]}: no errors, {shapes}, {lights}")
    from minirt.rendering.notices import notices_about

    for notice in notices_about(scene, None, options.size or size_of(scene)):
        say(f"notice: {notice}")
    return OK


def check_as_json(options: argparse.Namespace) -> int:
    """Print the errors of a scene file or, if it has none, its notices as a list in JSON, for editors.

    Return FAILED if there are errors.
    """
    import json

    from minirt.cli.files import read_scene

    try:
        told = [("notice", each) for each in read_scene(options).notices]
    except SceneError as error:
        told = [("error", each) for each in error.problems]
    problems = []
    for severity, each in told:
        place = {name: getattr(each, name) for name in ("file", "line", "column", "length")}
        problems.append({**place, "severity": severity, "message": each.message, "hint": each.hint})
    say(json.dumps(problems))
    return FAILED if any(severity == "error" for severity, _ in told) else OK


def render(scene: Scene, options: argparse.Namespace) -> int:
    """Render a picture or a turntable to the output."""
    from minirt.cli.render import render_output

    return render_output(scene, options)


def bench(scene: Scene, options: argparse.Namespace) -> int:
    """Measure the frame time and print it."""
    import json

    from minirt.report.bench import measure

    with progress(lambda: WorkState("measuring")):
        measured = measure(options.scene[0], scene, options.size, options.threads, options.precision or "double")
    say(json.dumps(measured) if options.json else ", ".join(f"{name} {value}" for name, value in measured.items()))
    return OK


def report(scene: Scene, options: argparse.Namespace) -> int:
    """Measure error against run time and write the report into a folder."""
    from minirt.report.measure import report as write_report

    size = options.size or size_of(scene)
    how = options.threads, options.quick, options.ablation, options.against, tell
    say(write_report(scene, options.scene[0], options.report, size, *how))
    return OK


def explain(scene: Scene, options: argparse.Namespace) -> int:
    """Print why a pixel has its colour: as a tree, in a terminal with the colours of light, or as JSON."""
    import json

    from minirt.rendering.queries.explain import explain as explanation_of
    from minirt.rendering.queries.explanation import TreeText

    explanation = explanation_of(scene, *(options.size or size_of(scene)), *options.explain, depth=options.depth)
    has_colours = sys.stdout.isatty() and "NO_COLOR" not in os.environ
    if options.json:
        say(json.dumps(explanation.as_dict()))
    else:
        say(f"{TreeText(explanation, has_colours)}\n", is_own=True)  # so that its control characters for colours stay
    return OK


def write_buffer(scene: Scene, options: argparse.Namespace) -> int:
    """Write the normals, depths, ids, uv or points of what each pixel shows: as numbers where the format of the output
    holds them, else as colours. RenderError for .hdr, which holds numbers but none below 0."""
    from minirt.cli.files import check_output, format_name, write
    from minirt.formats.table import FLOAT, FORMATS
    from minirt.rendering.buffers import MEMORY, geometry

    (width, height), name = options.size or size_of(scene), format_name(options.output)
    if name == "HDR":
        raise RenderError(f"{options.output}: Radiance holds no numbers below 0, try .exr")
    check_output(options.output, width, height)
    system.check_picture(height, width, MEMORY)
    with progress(lambda: WorkState("tracing")):
        seen = geometry(scene, width, height, options.threads, has_uv=options.buffers == "uv")
        picture = seen.picture(options.buffers)
    write(picture.encode(name, bits=FLOAT if FLOAT in FORMATS[name].bits else None), options.output)
    return OK


def compare(scene: Scene, options: argparse.Namespace) -> int:
    """Compare another program's picture with the scene's, print what differs, and write it as a picture if asked."""
    import json

    from minirt.cli.files import check_output, format_name, write
    from minirt.compare import compare as compare_with
    from minirt.rendering.image import Image

    with progress(lambda: WorkState(f"comparing {options.compare}")):
        found = compare_with(scene, options.compare)
    tell_answer = tell if options.output == "-" else say  # standard output is the picture's
    tell_answer(json.dumps(found.json()) if options.json else str(found))
    if options.output:
        panels = found.panels()
        check_output(options.output, panels.shape[1], panels.shape[0])
        write(Image(panels).encode(format_name(options.output)), options.output)
    return OK


def show(scene: Scene, options: argparse.Namespace, saved: Scene | None = None) -> int:
    """Show the scene in a window until it is closed; without a display, render to the fallback file if there is one.

    `saved` is the scene as the file has it; None where that is `scene`. MlxError without a display and a fallback.
    """
    from minirt.rendering.renderer import renderer

    chosen = renderer(options.threads, options.precision or "double", options.depth, options.dither)
    chosen.moves_in_single = options.precision is None
    try:
        with ended_by_signals(leave_at_once):  # until the window is open, and once it is closed
            from minirt.viewer.app import desktop

            return desktop.run(
                scene,
                path=options.scene[0],
                size=options.size,
                keys=options.keys,
                lenient=options.lenient,
                samples=options.samples or WINDOW_SAMPLES,
                watch=options.watch,
                text_scale=options.text_scale,
                saved=saved,
                renderer=chosen,
            )
    except MlxError as error:
        if not options.fallback:
            error.add_note("-o FILE renders a picture without one")
            raise
        from minirt.cli.render import render_output

        say(f"{error}\nNo window: rendering to {options.fallback} instead.")
        changed = {"output": options.fallback, "samples": options.samples or WINDOW_SAMPLES}
        changed["command"] = [*options.command, "-o", options.fallback]
        render_output(scene, argparse.Namespace(**vars(options) | changed))
        say(f"The picture is in {os.path.abspath(options.fallback)}")  # noqa: PTH100
        return OK


def replay(scene: Scene, options: argparse.Namespace) -> int:
    """Play recorded keys without a window; write the last frame, or all frames as a film, to the output if given."""
    from minirt.cli.files import check_output, is_film, write
    from minirt.cli.render import encoding
    from minirt.movie import Film
    from minirt.rendering.image import Image
    from minirt.rendering.renderer import renderer
    from minirt.viewer.app.replay import FPS, record
    from minirt.viewer.app.replay import replay as play

    width, height = options.size or size_of(scene)
    if options.output:
        check_output(options.output, width, height)
    text = file_io.read_given(options.replay, MAX_RECORDING).decode(errors="replace")
    lines = text.replace("\r\n", "\n").split("\n")
    settings: dict[str, Any] = {
        "file": options.replay,
        "renderer": renderer(options.threads, options.precision or "double", options.depth, options.dither),
        "size": (width, height),
        "path": options.scene[0],
        "keys": "qwerty" if options.keys == "auto" else options.keys,  # the same on every machine
        "lenient": options.lenient,
        "samples": options.samples or SAMPLES,
    }
    with progress(lambda: WorkState(f"playing {options.replay}")):
        if is_film(options):
            film = Film(options.output, FPS, options.quality)
            record(scene, lines, film.add, **settings)
            film.save()
            return OK
        pixels = play(scene, lines, **settings)
    if options.output:  # the picture carries no scene, since keys have edited the one of the file
        without_scene = argparse.Namespace(**vars(options) | {"metadata": False})
        write(Image.from_bgra(pixels).encode(**encoding(scene, options.output, without_scene)), options.output)
    return OK
