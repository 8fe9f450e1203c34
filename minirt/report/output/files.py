"""All files of the report of a scene."""

from __future__ import annotations

import os
from pathlib import Path

from minirt.errors import RenderError
from minirt.helpers import file_io
from minirt.image import Image
from minirt.report.measurements.findings import Findings, choices
from minirt.report.measurements.formula_errors import Row as FormulaRow
from minirt.report.measurements.metrics import Picture as Light
from minirt.report.measurements.metrics import to_8_bits
from minirt.report.output.blocks import Diagrams, Heading, Notice, Picture
from minirt.report.output.diagram import draw, standalone
from minirt.report.output.document import document, picture_name, recommended, title
from minirt.report.output.error_image import error_image
from minirt.report.output.formula_section import formula_section
from minirt.report.output.markdown import markdown
from minirt.report.output.page import page
from minirt.report.output.panel import NARROW, WIDE, diagram_of
from minirt.report.output.tables import as_csv, as_json

Files = dict[str, bytes]  # file name -> content

CAPTION = (
    "Left and down is better. Each point of a line is a number of samples per pixel; for `auto` it is the error that "
    "was asked for. No other setting of miniRT is better in both error and time than the points on the grey band. Bars "
    "are 95 % confidence intervals."
)
PAGE, TEXT, DIAGRAM, FORMULAS = "report.html", "report.md", "diagram.svg", "kernels.html"


def report_files(found: Findings, lights: dict[str, Light], reference: Light) -> Files:
    """Build all files; `lights` are the pictures of the settings by the settings' names."""
    best = recommended(found)
    shown = diagram_of(title(found), found.pictures, found.reference_error, found.eight_bits, best)
    diagrams = Diagrams("Error against run time", CAPTION, DIAGRAM, draw(shown, WIDE), draw(shown, NARROW))
    errors = {
        row.name: Picture(
            picture_name(row),
            f"error-{row.name.replace(' ', '-')}.png",
            error_image(lights[row.name], reference).encode(),
        )
        for row in found.pictures
        if row.name in lights
    }
    pictures = list(errors.values())
    if pictures:
        pictures.append(Picture("the reference", "reference.png", Image(to_8_bits(reference)).encode()))
    blocks = list(document(found, diagrams, pictures))
    made = {
        PAGE: page(title(found), blocks),
        TEXT: markdown(blocks),
        DIAGRAM: standalone(diagrams.wide),
        "report.json": as_json(found._asdict() | {"choices": choices(found.pictures, found.reference_error)}),
        "pictures.csv": as_csv(found.pictures),
        "orders.csv": as_csv(found.orders),
        "ablation.csv": as_csv(found.ablation),
        "single.csv": as_csv(found.single),
        "kernels.csv": as_csv(found.kernels),
        "certificates.csv": as_csv(found.certificates),
    }
    return {name: each.encode() for name, each in made.items()} | {each.file: each.data for each in pictures}


def formula_files(rows: list[FormulaRow], interrupted: str = "") -> Files:
    """Build the files of the report of all formulas."""
    notice = [Notice(interrupted)] * bool(interrupted)
    blocks = [Heading("Formulas of all shapes", level=1), *notice, *formula_section(rows)]
    made = {
        FORMULAS: page("Formulas of all shapes", blocks),
        "kernels.md": markdown(blocks),
        "kernels.csv": as_csv(rows),
        "kernels.json": as_json(rows),
    }
    return {name: each.encode() for name, each in made.items()}


def write_files(folder: str | os.PathLike[str], made: Files) -> None:
    """Write files into a folder, each as a whole or not at all. RenderError."""
    for name, data in made.items():
        path = Path(folder) / name
        try:
            file_io.write(path, data)
        except OSError as error:
            raise RenderError(f"{path}: cannot write: {error.strerror or error}") from None
