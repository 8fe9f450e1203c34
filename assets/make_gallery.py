"""Render the pictures of scenes/README.md, and write the table of its gallery.

    python assets/make_gallery.py [SCENE ...]

Without names of scenes it also renders the example of the page and its chart of u and v. A time is the processor time
of one thread, without reading the scene and compiling.
"""

from __future__ import annotations

import sys
import time
from pathlib import Path

import minirt

ROOT = Path(__file__).parent.parent
PAGE = ROOT / "scenes" / "README.md"
SHOWN = [
    "opening",
    "figure-iv1-planet",
    *sorted(path.stem for path in (ROOT / "scenes").glob("gallery-*.rt")),
    "material-glass-window",
]
WIDTH, HEIGHT, SAMPLES = 1280, 720, 64


def row(name: str) -> str:
    """Render a scene; return its row of the table."""
    scene = minirt.load(ROOT / "scenes" / f"{name}.rt")
    minirt.render(scene, WIDTH, HEIGHT, threads=1)  # compiled
    start = time.process_time()
    picture = minirt.render(scene, WIDTH, HEIGHT, samples=SAMPLES, threads=1)
    seconds = time.process_time() - start
    file = f"{name.split('-', 1)[-1]}.jpg"
    picture.save(ROOT / "assets" / f"gallery-{file}")
    caption = (scene.file.read_text().splitlines()[0] if scene.file else "").removeprefix("# ")
    return f"| ![{name}](../assets/gallery-{file}) | {caption}<br>`{name}.rt`, {seconds:.1f} s |"


def write(name: str, text: str) -> None:
    """Write the row of a scene in the place of its former one, or as the last."""
    table = PAGE.read_text(encoding="utf-8")
    start = table.index("| | |\n", table.index("## Gallery"))  # the last part of the page
    rows = table[start:].rstrip().splitlines()
    former = [i for i, each in enumerate(rows) if f"`{name}.rt`" in each]
    rows[former[0] if former else len(rows) : former[0] + 1 if former else len(rows)] = [text]
    PAGE.write_text(table[:start] + "\n".join(rows) + "\n", encoding="utf-8")


def illustrate() -> None:
    """Render the first example of the page, and the chart of u and v."""
    example = PAGE.read_text(encoding="utf-8").partition("```\n")[2].partition("```")[0]
    minirt.render(minirt.loads(example), 480, 270, samples=SAMPLES).save(ROOT / "assets" / "first.png")
    minirt.render(minirt.example("uv"), 960, 420, samples=SAMPLES).save(ROOT / "assets" / "uv.jpg")


if __name__ == "__main__":
    if not sys.argv[1:]:
        illustrate()
    for name in sys.argv[1:] or SHOWN:
        text = row(name)
        print(text, flush=True)
        write(name, text)
