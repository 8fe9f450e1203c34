"""Values, tables and pictures of the page of a report, and the files that hold them."""

from __future__ import annotations

import os
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

from minirt.helpers import file_io
from minirt.rendering.image import Image
from minirt.report.answers import answers
from minirt.report.diagram import NARROW, WIDE, draw, on_page
from minirt.report.findings import Findings, distinct
from minirt.report.metrics import Picture as Light
from minirt.report.metrics import error_image, to_8_bits, worst_region
from minirt.report.page import as_csv, as_json, bullets, figures, filled, table
from minirt.report.pictures import Row
from minirt.report.povray import ABOUT
from minirt.report.settings import KNOBS

PAGE = "report.html"
TABLES = ("pictures", "orders", "ablation", "certificates")  # fields of the findings
TOLD = 2.0  # roundings: a kind of shape whose hits have no larger backward errors has no row on the page


def write_files(folder: str | os.PathLike[str], found: Findings, lights: dict[str, Light], reference: Light) -> None:
    """Write all files into a folder, each as a whole or not at all: RenderError.

    `lights` are the pictures of the settings by the settings' names.
    """
    for name, data in report_files(found, lights, reference).items():
        path = Path(folder) / name
        with file_io.told_errors(path):
            file_io.write(path, data)


def report_files(found: Findings, lights: dict[str, Light], reference: Light) -> dict[str, bytes]:
    """Build all files: their contents by their names."""
    markdown, page = filled(found.title, values(found, lights, reference))
    texts = {PAGE: page, "report.md": markdown, "diagram.svg": draw(found, WIDE)}
    texts["report.json"] = as_json(vars(found) | {"orders": found.orders, "choices": found.choices})
    texts |= {f"{name}.csv": as_csv(getattr(found, name)) for name in TABLES}
    maps = {map_name(row): error_image(lights[row.name], reference) for row in found.pictures if row.name in lights}
    pictures = maps | {"reference.png": Image(to_8_bits(reference))}
    encoded = {name: each.encode() for name, each in pictures.items()}
    return {name: each.encode() for name, each in texts.items()} | encoded


def map_name(row: Row) -> str:
    """Return the name of the file with the errors of each pixel of a setting."""
    return f"error-{row.name}.png".replace(" ", "-")


def values(found: Findings, lights: dict[str, Light], reference: Light) -> dict[str, Any]:
    """Return what the page of a report tells, by the names in its template."""
    used, shown = {row.knob for row in found.pictures}, {*distinct(found.pictures), *found.recommended}
    wide, narrow = (on_page(draw(found, size)) for size in (WIDE, NARROW))
    knobs = {knob.name: knob.about for knob in KNOBS} | ABOUT
    equal = [row for row in found.of_equal_time if row.name in lights]
    return {
        "found": found,
        "answers": bullets(answers(found)),
        "interrupted": found.interrupted,
        "diagram": f'<div class="wide">{wide}</div><div class="narrow">{narrow}</div>',
        "choices": table(found.choices),
        "pictures": figures("pictures", compared(equal, lights, reference)),
        "crops": crops(equal, lights, reference) if equal else "",
        "settings": table([row for row in found.pictures if row in shown], found.recommended),
        "knobs": "; ".join(f"{name}: {knobs[name]}" for name in knobs if name in used),
        "orders": table(found.orders),
        "ablation": table(found.ablation),
        "stiff": bullets(found.stiff),
        "certificates": table([row for row in found.certificates if row.backward_largest > TOLD]),
        "not_measured": bullets(found.not_measured),
        "maps": ", ".join(f"[{row.name}]({map_name(row)})" for row in found.pictures if row.name in lights),
        "notes": "; ".join(found.notes),
        "versions": ", ".join(f"{name} {version}" for name, version in found.subject.versions.items()),
    }


def compared(rows: list[Row], lights: dict[str, Light], reference: Light) -> Iterator[dict[str, bytes]]:
    """Yield the reference, and for each row its picture and the errors of that, by their names."""
    yield {"the reference": Image(to_8_bits(reference)).encode()}
    for row in rows:
        light, name = lights[row.name], f"{row.name}: {row.wall_ms:.4g} ms, RMSE {row.rmse:.2g}"
        errors = error_image(light, reference).encode()
        yield {name: Image(to_8_bits(light)).encode(), f"errors of {row.name}": errors}


def crops(rows: list[Row], lights: dict[str, Light], reference: Light) -> str:
    """Return crops of pictures, where these are furthest from the reference."""
    squares = (((lights[row.name] - reference) ** 2).sum(axis=-1) for row in rows)
    region = worst_region(np.sum([each / (each.sum() or 1.0) for each in squares], axis=0))  # none outweighs the others
    return figures("crops", compared(rows, {row.name: lights[row.name][region] for row in rows}, reference[region]))


def summary(found: Findings) -> str:
    """Return the answers and what was not measured, a line each."""
    told = (answer.replace("`", "").replace("**", "") for answer in answers(found))
    return "\n".join([*[found.interrupted] * bool(found.interrupted), *told, *found.not_measured])
