"""The program: arguments in, exit status out. The only place that prints errors.

0  all went well        1  an error in a scene or in rendering
2  wrong arguments      130  interrupted by Ctrl+C
"""

from __future__ import annotations

import argparse
import os
import sys
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, TextIO

from minirt.arguments import SAMPLES, USAGE, WINDOW_SAMPLES, Arguments, arguments
from minirt.errors import MiniRTError, MlxError, ReplayError
from minirt.gc_pause import gc_paused

if TYPE_CHECKING:
    from minirt.image import Image
    from minirt.scene import Scene

OK, FAILED, INTERRUPTED = 0, 1, 130


def main(argv: Sequence[str] | None = None) -> int:
    """Run the program and return its exit status."""
    try:
        return run(arguments(), argv)
    except MiniRTError as error:
        print("Error", error, sep="\n", file=sys.stderr)
        return FAILED
    except BrokenPipeError:  # whoever read our output has seen enough
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return FAILED
    except KeyboardInterrupt:
        return INTERRUPTED


def run(parser: Arguments, argv: Sequence[str] | None) -> int:
    """Do what the arguments ask for."""
    asked = parser.parse_args(argv)
    if asked.version or asked.list_keys:
        print(version() if asked.version else keys())
        return OK
    if len(asked.scene) != 1:
        parser.fail(f"expected one scene file, got {len(asked.scene)}: {' '.join(asked.scene)}".rstrip(": "), FAILED)
    if asked.output and asked.output != "-":
        from minirt.image import format_of

        format_of(asked.output)  # before the work, not after it
    if asked.turntable and asked.output in (None, "-"):
        parser.error("--turntable needs the name of a file: -o spin.gif")
    if (asked.error or asked.time) and asked.samples != "auto":
        parser.fail("--error and --time need --samples auto", USAGE)
    if asked.samples == "auto" and (asked.replay or asked.turntable or not asked.output):
        parser.fail("--samples auto makes one picture: it needs -o, and no --replay or --turntable", USAGE)
    modes = (
        (asked.check, check),
        (asked.bench, bench),
        (asked.report, report),
        (asked.replay, replay),
        (asked.turntable, turntable),
        (asked.output, headless),
    )
    mode = next((mode for wanted, mode in modes if wanted), window)
    # A picture may go to standard output; behind a window it is free, and a session without errors leaves none.
    scene = read(asked.scene[0], asked, sys.stdout if mode is window else sys.stderr)
    return mode(scene, asked)


def version() -> str:
    """The program's name and version."""
    from minirt import __version__

    return f"miniRT {__version__}"


def keys() -> str:
    """The keys of the window."""
    from minirt.viewer import keys_text

    return keys_text()


def read(path: str, asked: argparse.Namespace, told: TextIO) -> Scene:
    """The scene in a file; what was tolerated is told there."""
    from minirt.scene import load

    scene, notices = load(path, asked.lenient, asked.left_handed)
    for notice in notices:
        print(f"notice: {notice}", file=told, flush=True)
    return scene


def check(scene: Scene, asked: argparse.Namespace) -> int:
    """Say that the scene could be read."""
    print(f"{asked.scene[0]}: no errors, {len(scene.shapes)} shapes, {len(scene.lights)} lights")
    return OK


def bench(scene: Scene, asked: argparse.Namespace) -> int:
    """Print how long a frame takes."""
    from minirt.bench import measure, report

    measured = measure(asked.scene[0], scene, asked.size, asked.threads, asked.precision)
    print(report(measured, asked.json))
    return OK


def report(scene: Scene, asked: argparse.Namespace) -> int:
    """Write how error and run time go together into a folder."""
    import minirt
    from minirt.report import report as measure

    size = asked.size or minirt.size_of(scene)
    print(measure(scene, asked.scene[0], asked.report, size, asked.threads, asked.quick))
    return OK


def headless(scene: Scene, asked: argparse.Namespace) -> int:
    """Render to the output."""
    with gc_paused():
        write(picture(scene, asked), asked.output)
    return OK


def picture(scene: Scene, asked: argparse.Namespace) -> Image:
    """The picture that the arguments ask for."""
    from time import perf_counter

    import minirt

    width, height = asked.size or minirt.size_of(scene)
    start = perf_counter()
    renderer = minirt.renderer(asked.threads, asked.precision, asked.depth)
    if asked.verbose:
        renderer.prepare(scene)
        print(f"kernel ready after {perf_counter() - start:.2f} s", file=sys.stderr)
        start = perf_counter()
    samples = asked.samples or SAMPLES
    image = minirt.render(
        scene,
        width,
        height,
        samples=samples,
        error=asked.error,
        time=asked.time,
        threads=asked.threads,
        precision=asked.precision,
        depth=asked.depth,
    )
    if image.reached:
        print(image.reached, file=sys.stderr)
    if asked.precision == "single":
        from minirt.report.measurements.stiffness import lost_in_single

        for stiff in lost_in_single(scene, renderer.packing, width, height):
            print(f"notice: single precision cannot show {stiff}", file=sys.stderr)
    if asked.verbose:
        each = "" if image.reached else f"{samples} samples a pixel, "
        print(
            f"{width}x{height}, {each}{renderer.threads} threads, {renderer.precision} precision: "
            f"{(perf_counter() - start) * 1e3:.1f} ms",
            f"rays whose light is not finite: {renderer.not_finite}",
            *renderer.packing.notes,
            sep="\n",
            file=sys.stderr,
        )
    return image


def turntable(scene: Scene, asked: argparse.Namespace) -> int:
    """Write pictures of the scene from all around it."""
    import minirt
    from minirt.movie import with_progress
    from minirt.viewer.app.animation import turntable as views

    width, height = asked.size or minirt.size_of(scene)
    made = (
        minirt.render(
            seen,
            width,
            height,
            samples=asked.samples or SAMPLES,
            threads=asked.threads,
            precision=asked.precision,
            depth=asked.depth,
        )
        for seen in with_progress(views(scene, asked.turntable), asked.turntable, "picture")
    )
    with gc_paused():
        minirt.save_movie(made, asked.output)
    return OK


def write(image: Image, output: str) -> None:
    """Put a picture into a file or onto standard output."""
    if output == "-":
        sys.stdout.buffer.write(image.encode())
        sys.stdout.buffer.flush()
        return
    image.save(output)


def replay(scene: Scene, asked: argparse.Namespace) -> int:
    """Play recorded keys; the last frame goes to the output, if there is one."""
    import minirt
    from minirt.viewer.app.animation import FPS, animation
    from minirt.viewer.app.replay import replay as play

    try:
        with open(asked.replay, encoding="utf-8") as file:  # noqa: PTH123
            lines = file.read().split("\n")
    except (OSError, UnicodeDecodeError) as error:
        raise ReplayError(f"{asked.replay}: cannot be read: {getattr(error, 'strerror', None) or error}") from None
    how: dict[str, Any] = {
        "file": asked.replay,
        "renderer": minirt.renderer(asked.threads, asked.precision, asked.depth),
        "size": asked.size or minirt.size_of(scene),
        "path": asked.scene[0],
        "keys": "qwerty" if asked.keys == "auto" else asked.keys,  # not the user's: a replay is the same everywhere
        "lenient": asked.lenient,
        "samples": asked.samples or SAMPLES,
    }
    if asked.output and asked.output.lower().endswith(".gif"):
        minirt.save_movie(animation(scene, lines, **how), asked.output, FPS)
        return OK
    pixels = play(scene, lines, **how)
    if asked.output:
        write(minirt.Image.from_bgra(pixels), asked.output)
    return OK


def window(scene: Scene, asked: argparse.Namespace) -> int:
    """Show the scene in a window until it is closed."""
    import minirt
    from minirt import viewer

    try:
        return viewer.run(
            scene,
            path=asked.scene[0],
            size=asked.size,
            keys=asked.keys,
            lenient=asked.lenient,
            samples=asked.samples or WINDOW_SAMPLES,
            watch=asked.watch,
            renderer=minirt.renderer(asked.threads, asked.precision, asked.depth),
        )
    except MlxError as error:
        if not asked.fallback:
            raise
        print(f"{error}\nNo window: rendering to {asked.fallback} instead.")
        write(picture(scene, asked), asked.fallback)
        print(f"The picture is in {os.path.abspath(asked.fallback)}")  # noqa: PTH100
        return OK
