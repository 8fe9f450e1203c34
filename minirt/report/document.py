"""Pictures and tables of the page of a report, and the files that hold them."""

from __future__ import annotations

import os
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

from minirt.helpers import file_io
from minirt.rendering.image import Image
from minirt.report.against import changes
from minirt.report.answers import answers
from minirt.report.crops import SIDE, squares_of
from minirt.report.diagram import NARROW, WIDE, draw, on_page
from minirt.report.findings import Findings, distinct
from minirt.report.metrics import Picture as Light
from minirt.report.metrics import error_image, to_8_bits
from minirt.report.page import as_csv, as_json, filled
from minirt.report.pictures import Row
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
    diagram = draw(found, WIDE)
    told = values(found, lights, reference) | {"wide": on_page(diagram), "narrow": on_page(draw(found, NARROW))}
    texts = {PAGE: filled("page.html", told), "report.md": filled("page.txt", told), "diagram.svg": diagram}
    texts["report.json"] = as_json(vars(found) | {"orders": found.orders, "choices": found.choices, "other": None})
    texts |= {f"{name}.csv": as_csv(getattr(found, name)) for name in TABLES}
    maps = {map_name(row): error_image(lights[row.name], reference) for row in found.pictures if row.name in lights}
    pictures = maps | {"reference.png": Image(to_8_bits(reference))}
    encoded = {name: each.encode() for name, each in pictures.items()}
    return {name: each.encode() for name, each in texts.items()} | encoded


def map_name(row: Row) -> str:
    """Return the name of the file with the errors of each pixel of a setting."""
    return f"error-{row.name}.png".replace(" ", "-")


def values(found: Findings, lights: dict[str, Light], reference: Light) -> dict[str, Any]:
    """Return what the page of a report tells, by the names in its templates."""
    equal = [row for row in found.of_equal_time if row.name in lights]
    return {
        "found": found,
        "answers": answers(found),
        "share": found.subject.pixels / (found.subject.width * found.subject.height),
        "side": SIDE,
        "changes": list(changes(found, found.other)) if found.other else [],
        "pictures": list(compared(equal, lights, reference)) if equal else [],
        "crops": worst_crops(equal, lights, reference) if equal else [],
        "settings": [row for row in found.pictures if row in {*distinct(found.pictures), *found.recommended}],
        "knobs": [knob for knob in KNOBS if knob.name in {row.knob for row in found.pictures}],
        "certificates": [row for row in found.certificates if row.backward_largest > TOLD],
        "tables": TABLES,
        "maps": {row.name: map_name(row) for row in found.pictures if row.name in lights},
    }


def compared(rows: list[Row], lights: dict[str, Light], reference: Light) -> Iterator[dict[str, bytes]]:
    """Yield the reference, and for each row its picture and the errors of that, by their names."""
    yield {"the reference": Image(to_8_bits(reference)).encode()}
    for row in rows:
        light, name = lights[row.name], f"{row.name}: {row.ms:.4g} ms, RMSE {row.rmse:.2g}"
        errors = error_image(light, reference).encode()
        yield {name: Image(to_8_bits(light)).encode(), f"errors of {row.name}": errors}


def worst_crops(rows: list[Row], lights: dict[str, Light], reference: Light) -> list[dict[str, bytes]]:
    """Return the squares of pictures in which these are furthest from the reference, as `compared` does."""
    side = min(SIDE, reference.shape[0]), min(SIDE, reference.shape[1])
    squares = {row.name: squares_of(lights[row.name], side) for row in rows}
    right = squares_of(reference, side)
    errors = [((each - right) ** 2).sum(axis=(1, 2, 3)) for each in squares.values()]
    worst = int(np.sum([each / (each.sum() or 1.0) for each in errors], axis=0).argmax())  # none outweighs the others
    return list(compared(rows, {name: each[worst] for name, each in squares.items()}, right[worst]))


def summary(found: Findings) -> str:
    """Return the answers and what was not measured, a line each."""
    told = (f"{question} {answer}".replace("`", "") for question, answer in answers(found))
    return "\n".join(filter(None, (found.interrupted, *told)))
