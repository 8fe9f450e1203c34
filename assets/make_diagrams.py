"""Measure the diagrams of error against run time of the pages: python assets/make_diagrams.py

It takes minutes, and wants a machine that does nothing else.
"""

from __future__ import annotations

import sys
from pathlib import Path
from tempfile import TemporaryDirectory

import minirt
from minirt.report.measure import report

ROOT = Path(__file__).parent.parent
SHOWN = {"demo": "demo", "eval-shadows-many": "shadows"}  # scene -> name of the diagram
WIDTH, HEIGHT = 640, 360


def draw(scene: str, name: str) -> None:
    """Measure a scene and keep the diagram."""
    path = Path("scenes", f"{scene}.rt")
    with TemporaryDirectory() as folder:
        print(report(minirt.load(ROOT / path), path.as_posix(), folder, (WIDTH, HEIGHT), 1, quick=False))
        (ROOT / "assets" / f"report-{name}.svg").write_bytes(Path(folder, "diagram.svg").read_bytes())


if __name__ == "__main__":
    for scene in sys.argv[1:] or SHOWN:
        draw(scene, SHOWN[scene])
