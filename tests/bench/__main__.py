"""`python -m tests.bench [--quick]`: measure frames, starts, and growing scenes beside others, and sampling."""

from __future__ import annotations

from argparse import ArgumentParser
from functools import lru_cache, partial
from importlib.util import find_spec
from itertools import cycle
from pathlib import Path

import numpy as np

from minirt import load
from minirt.element import fields_of
from minirt.errors import RenderError
from minirt.fields import Point
from minirt.kernel.machine_code.fingerprint import processor
from minirt.rendering.renderer import Renderer
from minirt.rendering.threads import usable_cores
from minirt.report.bench import STEP, moved, runs
from minirt.scene import Scene
from tests.bench import sampling, scenes, starts
from tests.bench.measure import MissingError, Setting, System, available, table, take_turns
from tests.bench.peers import povray
from tests.bench.peers.embree import Embree
from tests.bench.peers.mitsuba import Mitsuba
from tests.bench.peers.programs import PovRay, Tachyon
from tests.bench.yardstick import Yardstick

LEAST_FRAMES = 3
RECENT = 4  # packed scenes that are kept

read = lru_cache(RECENT)(load)


class MiniRT(System):
    """miniRT in a precision, "double" or "single"."""

    how = "Renderer.render while the camera moves: with what each tile shows; the lists of lamps are kept"

    def __init__(self, setting: Setting, precision: str) -> None:
        super().__init__(setting)
        self.name = f"miniRT {precision}"
        self.precision = precision
        self.renderer = lru_cache(RECENT)(self.new_renderer)

    def changed(self, scene: Scene) -> Scene:
        """Return the scene of every second frame."""
        return moved(scene)

    def new_renderer(self, path: Path) -> Renderer:
        """Make a renderer for a scene, with its kernel; a renderer keeps only the last packed scene."""
        renderer = Renderer(self.setting.threads, self.precision)
        renderer.prepare(read(path))
        return renderer

    def frame_times(self, path: Path, seconds: float) -> list[float]:
        scene, renderer = read(path), self.renderer(path)
        frames = cycle((scene, self.changed(scene)))
        pixels = np.empty((self.setting.height, self.setting.width, 4), np.uint8)
        renderer.render(next(frames), pixels)
        timed = runs(lambda: renderer.render(next(frames), pixels), LEAST_FRAMES, seconds)
        return [run.wall * 1e3 for run in timed]


class MovedShape(MiniRT):
    """miniRT while the last shape of a scene moves, in place of the camera."""

    how = "Renderer.render while the last shape moves, the mesh of a scene that has one"

    def __init__(self, setting: Setting, precision: str) -> None:
        super().__init__(setting, precision)
        self.name += " (shape)"

    def changed(self, scene: Scene) -> Scene:
        shape = scene.shapes[-1]
        place = next(each.name for each in fields_of(type(shape)) if isinstance(each, Point))
        x, y, z = getattr(shape, place)
        return scene.replace(shape, **{place: (x + STEP, y, z)})


def available_errors(paths: list[Path], setting: Setting) -> tuple[list[str], list[str]]:
    """Return tables of errors and times beside POV-Ray's, and why there are none."""
    try:
        return [povray.errors(path, setting) for path in paths], []
    except (MissingError, RenderError) as reason:
        return [], [f"errors: {reason}"]


YARDSTICKS = [partial(Yardstick, precision="double"), partial(Yardstick, precision="single")]
OWN = [partial(MiniRT, precision="double"), partial(MiniRT, precision="single"), *YARDSTICKS]
MOVED = [partial(MovedShape, precision="double"), partial(MovedShape, precision="single")]
PEERS = [Embree, Mitsuba, Tachyon, PovRay]
WIDTH, HEIGHT = 1280, 720
OUT = Path("out")


def main(quick: bool) -> None:
    """Measure all, print the tables, and draw the charts; `quick` has fewer rounds, and fewer spheres of the growth."""
    rounds, start_rounds, grown_rounds, most, seconds = (2, 1, 1, 10_000, 0.2) if quick else (5, 5, 3, 1_000_000, 0.6)
    folder = OUT / "bench"
    folder.mkdir(parents=True, exist_ok=True)
    setting = Setting(WIDTH, HEIGHT, usable_cores(), folder)
    own, reasons = available(partial(make, setting) for make in OWN)
    peers, more_reasons = available(partial(make, setting) for make in PEERS)
    systems = own + peers
    with_moved = own[:2] + [make(setting) for make in MOVED] + own[2:] + peers

    print(f"{processor()}, {usable_cores()} threads each.")
    print(f"{WIDTH}x{HEIGHT} pixels, a ray for each and a shadow ray to each light. Median of {rounds} rounds")
    print("in which the systems take turns; the second figure is a multiple of the first row.\n", flush=True)
    compared_scenes = scenes.compared(folder)
    compared = take_turns(systems, compared_scenes, rounds, seconds)
    print(table(compared), end="\n\n", flush=True)

    harder = take_turns(with_moved, scenes.harder(folder), rounds, seconds)
    print(table(harder), end="\n\n", flush=True)

    started, start_reasons = starts.measured(setting, compared_scenes[:3], start_rounds)
    print(f"Whole programs, until their picture of {starts.WIDTH}x{starts.HEIGHT} pixels is in a file or in a window.")
    print(f"Median of {start_rounds} starts; a cold one finds an empty cache of kernels.\n")
    print(table(started, "ms to a picture"), end="\n\n", flush=True)

    grown = [scenes.grown(folder, count) for count in scenes.COUNTS if count <= most]
    growth = take_turns(own, grown, grown_rounds, seconds)
    print(table(growth, "spheres in view"), end="\n\n")

    antialiased, error_reasons = available_errors(compared_scenes[:2], setting)
    for each in antialiased:
        print(each, end="\n\n", flush=True)

    print(sampling.summary(sampling.cells(9 if quick else 100)), end="\n\n", flush=True)

    for system in with_moved:
        print(f"{system.name}: {system.how}")
    reasons += more_reasons + start_reasons + error_reasons
    for reason in reasons:
        print(f"not measured: {reason}")
    if find_spec("matplotlib") is None:
        print("no pictures: matplotlib is not installed (pip install -e '.[report]')")
        return
    from tests.bench import charts

    charts.dots(compared, OUT / "bench.png", f"milliseconds per frame of {WIDTH} x {HEIGHT}, logarithmic axis")
    charts.dots(harder, OUT / "harder.png", f"milliseconds per frame of {WIDTH} x {HEIGHT}, logarithmic axis")
    charts.dots(started, OUT / "starts.png", "milliseconds from the start to the picture, logarithmic axis")
    charts.growth(growth, OUT / "growth.png")
    print(f"{OUT}: bench.png, harder.png, starts.png, growth.png")


if __name__ == "__main__":
    parser = ArgumentParser("python -m tests.bench")
    parser.add_argument("--quick", action="store_true", help="fewer rounds, and fewer spheres of the growth")
    main(parser.parse_args().quick)
