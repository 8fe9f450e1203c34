"""`python -m tests.bench`: benchmark miniRT against other renderers, in frames, from its start and over growing
scenes."""

from __future__ import annotations

import argparse
from collections.abc import Callable
from functools import lru_cache, partial
from importlib.util import find_spec
from itertools import cycle
from pathlib import Path
from typing import NamedTuple

import numpy as np

from minirt import load
from minirt.helpers.system import runs
from minirt.rendering import Renderer
from minirt.rendering.threads import usable_cores
from minirt.report.bench import moved
from minirt.report.findings import processor
from tests.bench import scenes, starts
from tests.bench.measure import Setting, System, available, table, take_turns
from tests.bench.peers.embree import Embree
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

    def new_renderer(self, path: Path) -> Renderer:
        """Make a renderer for a scene, with its kernel; a renderer keeps only the last packed scene."""
        renderer = Renderer(self.setting.threads, self.precision)
        renderer.prepare(read(path))
        return renderer

    def frame_times(self, path: Path, seconds: float) -> list[float]:
        scene, renderer = read(path), self.renderer(path)
        frames = cycle((scene, moved(scene)))
        pixels = np.empty((self.setting.height, self.setting.width, 4), np.uint8)
        renderer.render(next(frames), pixels)
        timed = runs(lambda: renderer.render(next(frames), pixels), LEAST_FRAMES, seconds)
        return [run.wall * 1e3 for run in timed]


Maker = Callable[[Setting], System]

OWN: list[Maker] = [partial(MiniRT, precision="double"), partial(MiniRT, precision="single"), Yardstick]
PEERS: list[Maker] = [Embree, Tachyon, PovRay]
WIDTH, HEIGHT = 1280, 720


class Plan(NamedTuple):
    """The extent of the benchmark."""

    rounds: int  # rounds of the comparison
    starts: int  # rounds of the starts
    grown_rounds: int  # rounds of the growth curve
    most: int  # spheres of the growth curve, at most
    seconds: float  # of a turn


FULL = Plan(rounds=5, starts=5, grown_rounds=3, most=1_000_000, seconds=0.6)
QUICK = Plan(rounds=2, starts=1, grown_rounds=1, most=10_000, seconds=0.2)


def arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="python -m tests.bench", description=__doc__.split(": ")[1])
    parser.add_argument("--quick", action="store_true", help="fewer rounds, and the growth up to 10,000 spheres")
    parser.add_argument("--threads", type=int, default=usable_cores(), help="of each system (default: %(default)s)")
    parser.add_argument("--out", type=Path, default=Path("out"), help="folder for the charts")
    return parser.parse_args()


def main() -> None:
    asked = arguments()
    plan = QUICK if asked.quick else FULL
    folder = asked.out / "bench"
    folder.mkdir(parents=True, exist_ok=True)
    setting = Setting(WIDTH, HEIGHT, asked.threads, folder)
    own, reasons = available(partial(make, setting) for make in OWN)
    peers, more_reasons = available(partial(make, setting) for make in PEERS)
    systems = own + peers

    print(f"{processor()}, {usable_cores()} processors; {asked.threads} threads each.")
    print(f"{WIDTH}x{HEIGHT} pixels, a ray for each and a shadow ray to each light. Median of {plan.rounds} rounds")
    print("in which the systems take turns; the second figure is a multiple of the first row.\n", flush=True)
    four = scenes.compared(folder)
    compared = take_turns(systems, four, plan.rounds, plan.seconds)
    print(table(compared), end="\n\n", flush=True)

    started, start_reasons = starts.measured(setting, four[:3], plan.starts)
    print(starts.report(started, plan.starts), end="\n\n", flush=True)

    grown = [scenes.grown(folder, count) for count in scenes.COUNTS if count <= plan.most]
    growth = take_turns(own, grown, plan.grown_rounds, plan.seconds)
    print(table(growth, "spheres in view"), end="\n\n")

    for system in systems:
        print(f"{system.name}: {system.how}")
    reasons += more_reasons + start_reasons
    for reason in reasons:
        print(f"not measured: {reason}")
    if find_spec("matplotlib") is None:
        print("no pictures: matplotlib is not installed (pip install -e '.[report]')")
        return
    from tests.bench import charts

    charts.dots(compared, asked.out / "bench.png", f"milliseconds per frame of {WIDTH} x {HEIGHT}, logarithmic axis")
    charts.dots(started, asked.out / "starts.png", "milliseconds from the start to the picture, logarithmic axis")
    charts.growth(growth, asked.out / "growth.png")
    print(f"{asked.out}: bench.png, starts.png, growth.png")


if __name__ == "__main__":
    main()
