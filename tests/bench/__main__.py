"""`python -m tests.bench`: benchmark miniRT against other renderers, in frames, from its start and over growing
scenes."""

from __future__ import annotations

import argparse
import json
from collections.abc import Callable
from functools import partial
from importlib.util import find_spec
from pathlib import Path
from typing import NamedTuple

from minirt.rendering.threads import usable_cores
from minirt.report.findings import processor
from tests.bench import scenes, starts
from tests.bench.measure import Setting, System, available, records, table, take_turns
from tests.bench.ours import MiniRT
from tests.bench.peers.embree import Embree
from tests.bench.peers.programs import PovRay, Tachyon
from tests.bench.yardstick import Yardstick

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
    parser.add_argument("--out", type=Path, default=Path("out"), help="folder for bench.json and the pictures")
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
    found = {
        "processor": processor(),
        "processors": usable_cores(),
        "size": [WIDTH, HEIGHT],
        "how": {system.name: system.how for system in systems},
        "not measured": reasons,
    }
    found |= {"compared": records(compared), "starts": records(started), "growth": records(growth)}
    (asked.out / "bench.json").write_text(json.dumps(found, indent=1) + "\n")
    if find_spec("matplotlib") is None:
        print("no pictures: matplotlib is not installed (pip install -e '.[report]')")
        return
    from tests.bench import charts

    charts.dots(compared, asked.out / "bench.png", f"milliseconds per frame of {WIDTH} x {HEIGHT}, logarithmic axis")
    charts.dots(started, asked.out / "starts.png", "milliseconds from the start to the picture, logarithmic axis")
    charts.growth(growth, asked.out / "growth.png")
    print(f"{asked.out}: bench.json, bench.png, starts.png, growth.png")


if __name__ == "__main__":
    main()
