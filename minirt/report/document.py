"""Text, tables and pictures of the report of a scene, in their order, and the files that hold them."""

from __future__ import annotations

import os
from collections.abc import Iterator
from math import isnan
from pathlib import Path

from minirt.helpers import file_io
from minirt.rendering.image import Image
from minirt.report.diagram import NARROW, WIDE, draw, on_page
from minirt.report.findings import Findings
from minirt.report.metrics import Picture as Light
from minirt.report.metrics import error_image, to_8_bits
from minirt.report.page import Document, Picture, as_csv, as_json
from minirt.report.pictures import Row
from minirt.report.povray import ABOUT
from minirt.report.settings import KNOBS

CAPTION = (
    "Left and down is better. Each point of a line is a number of samples per pixel; for `auto` it is the error that "
    "was asked for. No other setting of miniRT is better in both error and time than the points on the grey band. Bars "
    "are 95 % confidence intervals. Recommended points have a ring, hollow ones uncertain times."
)
PAGE, TEXT, DIAGRAM = "report.html", "report.md", "diagram.svg"
TABLES = ("pictures", "orders", "ablation", "single", "certificates")  # fields of the findings


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
    pictures = []
    for row in (each for each in found.pictures if each.name in lights):
        file = f"error-{row.name}.png".replace(" ", "-")
        pictures.append(Picture(caption(row), file, error_image(lights[row.name], reference).encode()))
    if pictures:
        pictures.append(Picture("the reference", "reference.png", Image(to_8_bits(reference)).encode()))
    made = document(found, pictures)
    derived = {"orders": found.orders, "choices": found.choices}
    texts = {PAGE: made.as_page(), TEXT: made.as_markdown(), DIAGRAM: draw(found, WIDE)}
    texts["report.json"] = as_json(vars(found) | derived)
    texts |= {f"{table}.csv": as_csv(getattr(found, table)) for table in TABLES}
    return {name: each.encode() for name, each in texts.items()} | {each.file: each.data for each in pictures}


def caption(row: Row) -> str:
    """Return the caption of the error picture of a setting."""
    return f"{row.name}: RMSE {row.rmse:.2g}"


def document(found: Findings, pictures: list[Picture]) -> Document:
    """Return the report of a scene: the diagram first, then what follows from it, then pictures and tables."""
    about = found.subject
    page = Document(found.title)
    if found.interrupted:
        page.notice(found.interrupted)
    versions = ", ".join(f"{name} {version}" for name, version in about.versions.items())
    machine = f"{about.threads} threads, {about.processor}"
    page.text(f"{about.width}x{about.height} pixels, {machine}; seed {about.seed}. {versions}.")
    wide, narrow = (on_page(draw(found, size)) for size in (WIDE, NARROW))
    page.chart("Error against run time", DIAGRAM, CAPTION, wide, narrow)
    page.heading("Recommended settings")
    page.bullets(advice(found))
    add_pictures(page, found, pictures)
    add_parts(page, found)
    add_precision(page, found)
    if found.not_measured:
        page.heading("Not measured")
        page.bullets(found.not_measured)
    return page


def add_pictures(page: Document, found: Findings, pictures: list[Picture]) -> None:
    """Add what was measured of pictures: errors, settings and convergence."""
    best = found.recommended
    if pictures:
        page.heading("Where the errors are")
        page.text(
            "The pictures `error-*.png` show the error of each pixel: black up to 0.0001, blue at 0.001, red at 0.01, "
            "orange at 0.1, white at 1."
        )
        names = [caption(row) for row in sorted(best, key=lambda row: row.rmse)[:1]]
        page.pictures(pictures, next((i for i, each in enumerate(pictures) if each.name in names), len(pictures) - 1))
    page.section(
        "Pictures",
        f"The reference has {found.reference_samples} samples per pixel in float64, at other sample positions; its own "
        f"RMSE is about {found.reference_error:.1g}. Each time is the median of undisturbed runs. From and to are 95 % "
        "confidence intervals. Recommended settings stand out.",
        found.pictures,
        best,
    )
    used = {row.knob for row in found.pictures}
    abouts = {knob.name: knob.about for knob in KNOBS} | ABOUT
    page.bullets(f"{name}: {about}" for name, about in abouts.items() if name in used)
    page.section(
        "Orders of convergence",
        "RMSE falls as samples^-order, or as time^-order, by least squares; from and to are 95 % confidence intervals "
        "by Student's t. Points within twice the error of the reference are left out, and that error is taken off the "
        "rest; disturbed times are left out.",
        found.orders,
    )


def add_parts(page: Document, found: Findings) -> None:
    """Add the cost of parts, and which work is left out."""
    page.heading("Work that this scene leaves out")
    counts = " and ".join(map(str, found.same))
    same = f"testing every ray against every shape gives the same pictures, bit for bit (samples: {counts})"
    page.bullets([*found.notes, *[same] * bool(found.same)])
    page.section(
        "What parts cost and save",
        "Processor time of a frame with one sample per pixel, changed by one part: a list is left out, or something "
        "that no ray meets is added. It is the median of the ratios of frames in turn with the scene as it is; from "
        "and to are a 95 % confidence interval. Where code lies in memory changes a time by some per cent, too. "
        "`--ablation` adds the features and the kinds of shapes that the scene lacks, and leaves out those that it has "
        "and no pixel can show. A kernel without a part has saved its own compile time after so many seconds of "
        "rendering, where the interval tells that the part costs time.",
        found.ablation,
    )


def add_precision(page: Document, found: Findings) -> None:
    """Add what rounding does: in float32, in stiff parts of the scene, and at hits."""
    page.section(
        "Single precision, feature by feature",
        "Difference between pictures in float32 and in float64 with one sample per pixel: of the shapes alone, in "
        "their own colours, and with one feature of the scene at a time.",
        found.single,
    )
    page.heading("Stiff parts of the scene")
    page.bullets(map(str, found.stiff)) if found.stiff else page.text("None.")
    page.section(
        "Certificates of hits",
        "The backward error of a hit is its distance from the exact surface, in roundings (2^-53) of the numbers that "
        "it is computed from: of t, of the way from the origin of the ray to the shape, and of the shape's size. It is "
        "computed with twice the digits. The columns from 1/4 on are a histogram. The condition number tells how many "
        "times larger the relative error of t may be, as it is for grazing rays: t is exact within their product times "
        "2^-53. The last column is the largest distance of a normal from the exact unit normal.",
        found.certificates,
    )


def summary(found: Findings) -> str:
    """Return the recommended settings, the stiff shapes and what was not measured, a line each."""
    stiff = (f"stiff: {each}" for each in found.stiff)
    return "\n".join([*[found.interrupted] * bool(found.interrupted), *advice(found), *stiff, *found.not_measured])


def advice(found: Findings) -> Iterator[str]:
    """Yield the best setting for each target error and each target time, and how many cannot be recommended."""
    disturbed = 0
    for choice in found.choices:
        best, disturbed = choice["best"], choice["disturbed"]
        yield f"{choice['wanted']}: {described(best) if best else 'none of these settings'}"
    if disturbed:
        yield f"left out, as other programs disturbed their times: {disturbed}"


def described(row: Row) -> str:
    """Describe a recommended setting in words."""
    samples = f"{row.samples:.3g} sample{'s' * (row.samples != 1)}"
    asked = "" if isnan(row.asked) else f" asked for {row.asked:g},"
    return f"{row.knob},{asked} {samples} ({row.wall_ms:.3g} ms, RMSE {row.rmse:.2g}, {row.psnr:.1f} dB)"
