"""Text, tables and pictures of the report of a scene, in their order, and the files that hold them."""

from __future__ import annotations

import os
from collections.abc import Iterator
from math import isnan
from pathlib import Path

from minirt.errors import RenderError
from minirt.helpers import file_io
from minirt.rendering.image import Image
from minirt.report.findings import Findings, as_csv, as_json, choices, recommended, title
from minirt.report.metrics import Picture as Light
from minirt.report.metrics import error_image, to_8_bits
from minirt.report.page import NARROW, WIDE, Column, Document, Picture, draw, on_page
from minirt.report.pictures import Row
from minirt.report.povray import ABOUT
from minirt.report.settings import BOUNCES, KNOBS

CAPTION = (
    "Left and down is better. Each point of a line is a number of samples per pixel; for `auto` it is the error that "
    "was asked for. No other setting of miniRT is better in both error and time than the points on the grey band. Bars "
    "are 95 % confidence intervals. Recommended points have a ring, hollow ones uncertain times."
)
PAGE, TEXT, DIAGRAM = "report.html", "report.md", "diagram.svg"
PICTURES = (
    Column("setting", "knob"),
    Column("point", "label"),
    Column("samples", "samples", ".3g"),
    Column("RMSE", "rmse", ".5f"),
    Column("from", "rmse_low", ".5f"),
    Column("to", "rmse_high", ".5f"),
    Column("in 8 bits", "rmse_8_bits", ".5f"),
    Column("own estimate", "estimated", ".5f"),
    Column("PSNR, dB", "psnr", ".1f"),
    Column("FLIP", "flip", ".4f"),
    Column("changed pixels", "changed", ".0f"),
    Column("rays not finite", "not_finite", ".0f"),
    Column("ms", "wall_ms", ".2f"),
    Column("from", "wall_low_ms", ".2f"),
    Column("to", "wall_high_ms", ".2f"),
    Column("processor ms", "cpu_ms", ".2f"),
    Column("sorting, ms", "sort_ms", ".2f"),
    Column("compiling or loading, s", "compile_s", ".2f"),
    Column("remark", "remark"),
)
ORDERS = (
    Column("setting", "knob"),
    Column("points", "points", "d"),
    Column("order by samples", "by_samples", ".2f"),
    Column("from", "by_samples_low", ".2f"),
    Column("to", "by_samples_high", ".2f"),
    Column("order by time", "by_time", ".2f"),
    Column("from", "by_time_low", ".2f"),
    Column("to", "by_time_high", ".2f"),
    Column("RMSE at 1 sample", "constant", ".3g"),
)
ABLATION = (
    Column("part", "name"),
    Column("change", "change"),
    Column("frame, ms", "frame_ms", ".2f"),
    Column("frame, %", "percent", "+.1f"),
    Column("from", "percent_low", "+.1f"),
    Column("to", "percent_high", "+.1f"),
    Column("compiling, s", "compile_s", ".1f"),
    Column("compiling, %", "compile_percent", "+.0f"),
    Column("pays after, s", "pays_after_s", ".0f"),
    Column("same picture", "same"),
    Column("remark", "remark"),
)
SINGLE = (
    Column("feature", "feature"),
    Column("RMSE", "rmse", ".1e"),
    Column("largest difference", "largest", ".1e"),
    Column("changed pixels", "changed", ".0f"),
    Column("remark", "remark"),
)
CERTIFICATES = (
    Column("shape", "kind"),
    Column("rays", "rays"),
    Column("hits", "hits", "d"),
    Column("backward error, median", "backward_median", ".2f"),
    Column("largest", "backward_largest", ".2f"),
    Column("up to 1/4", "up_to_quarter", ".1%"),
    Column("1/2", "up_to_half", ".1%"),
    Column("1", "up_to_1", ".1%"),
    Column("2", "up_to_2", ".1%"),
    Column("4", "up_to_4", ".1%"),
    Column("more", "above_4", ".1%"),
    Column("condition, median", "condition_median", ".1f"),
    Column("99 %", "condition_99", ".2g"),
    Column("largest", "condition_largest", ".2g"),
    Column("normal off by", "normal_largest", ".1g"),
)


def write_files(folder: str | os.PathLike[str], found: Findings, lights: dict[str, Light], reference: Light) -> None:
    """Write all files into a folder, each as a whole or not at all: RenderError.

    `lights` are the pictures of the settings by the settings' names.
    """
    for name, data in report_files(found, lights, reference).items():
        path = Path(folder) / name
        try:
            file_io.write(path, data)
        except OSError as error:
            raise RenderError(f"{path}: cannot write: {error.strerror or error}") from None


def report_files(found: Findings, lights: dict[str, Light], reference: Light) -> dict[str, bytes]:
    """Build all files: their contents by their names."""
    pictures = [
        Picture(
            caption(row), f"error-{row.name}.png".replace(" ", "-"), error_image(lights[row.name], reference).encode()
        )
        for row in found.pictures
        if row.name in lights
    ]
    if pictures:
        pictures.append(Picture("the reference", "reference.png", Image(to_8_bits(reference)).encode()))
    made = document(found, pictures)
    texts = {
        PAGE: made.as_page(),
        TEXT: made.as_markdown(),
        DIAGRAM: draw(found, WIDE),
        "report.json": as_json(found),
        "pictures.csv": as_csv(found.pictures),
        "orders.csv": as_csv(found.orders),
        "ablation.csv": as_csv(found.ablation),
        "single.csv": as_csv(found.single),
        "certificates.csv": as_csv(found.certificates),
    }
    return {name: each.encode() for name, each in texts.items()} | {each.file: each.data for each in pictures}


def caption(row: Row) -> str:
    """Return the caption of the error picture of a setting."""
    return f"{row.name}: RMSE {row.rmse:.2g}"


def document(found: Findings, pictures: list[Picture]) -> Document:
    """Return the report of a scene: the diagram first, then what follows from it, then pictures and tables."""
    about = found.subject
    page = Document(title(found))
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
    add_precision(page, found)
    if found.not_measured:
        page.heading("Not measured")
        page.bullets(found.not_measured)
    return page


def add_pictures(page: Document, found: Findings, pictures: list[Picture]) -> None:
    """Add what was measured of pictures: errors, settings, convergence and the cost of parts."""
    best = recommended(found)
    if pictures:
        page.heading("Where the errors are")
        page.text(
            "The pictures `error-*.png` show the error of each pixel: black up to 0.0001, blue at 0.001, red at 0.01, "
            "orange at 0.1, white at 1."
        )
        names = [caption(row) for row in sorted(best, key=lambda row: row.rmse)[:1]]
        page.pictures(pictures, next((i for i, each in enumerate(pictures) if each.name in names), len(pictures) - 1))
    page.heading("Pictures")
    page.text(
        f"The reference has {found.reference_samples} samples per pixel in float64, at other sample positions; its own "
        f"RMSE is about {found.reference_error:.1g}. Each time is the median of undisturbed runs. From and to are 95 % "
        "confidence intervals. Recommended settings stand out."
    )
    page.table(found.pictures, PICTURES, best)
    used = {row.knob for row in found.pictures}
    abouts = {knob.name: knob.about for knob in (*KNOBS, *BOUNCES)} | ABOUT
    page.bullets(f"{name}: {about}" for name, about in abouts.items() if name in used)
    if found.orders:
        page.heading("Orders of convergence")
        page.text(
            "RMSE falls as samples^-order, or as time^-order, by least squares; from and to are 95 % confidence "
            "intervals by Student's t. Points within twice the error of the reference are left out, and that error is "
            "taken off the rest; disturbed times are left out."
        )
        page.table(found.orders, ORDERS)
    page.heading("Work that this scene leaves out")
    counts = " and ".join(map(str, found.same))
    same = f"testing every ray against every shape gives the same pictures, bit for bit (samples: {counts})"
    page.bullets([*found.notes, *[same] * bool(found.same)])
    if found.ablation:
        page.heading("What parts cost and save")
        page.text(
            "Processor time of a frame with one sample per pixel, changed by one part: a list is left out, or "
            "something that no ray meets is added. It is the median of the ratios of frames in turn with the scene as "
            "it is; from and to are a 95 % confidence interval. Where code lies in memory changes a time by some per "
            "cent, too. "
            "`--ablation` adds the features and the kinds of shapes that the scene lacks, and leaves out those that it "
            "has and no pixel can show. A kernel without a part has saved its own compile time after so many seconds "
            "of rendering, where the interval tells that the part costs time."
        )
        page.table(found.ablation, ABLATION)


def add_precision(page: Document, found: Findings) -> None:
    """Add what rounding does: in float32, in stiff parts of the scene, and at hits."""
    if found.single:
        page.heading("Single precision, feature by feature")
        page.text(
            "Difference between pictures in float32 and in float64 with one sample per pixel: of the shapes alone, in "
            "their own colours, and with one feature of the scene at a time."
        )
        page.table(found.single, SINGLE)
    page.heading("Stiff parts of the scene")
    page.bullets(map(str, found.stiff)) if found.stiff else page.text("None.")
    if found.certificates:
        page.heading("Certificates of hits")
        page.text(
            "The backward error of a hit is its distance from the exact surface, in roundings (2^-53) of the numbers "
            "that it is computed from: of t, of the way from the origin of the ray to the shape, and of the shape's "
            "size. It is computed with twice the digits. The columns from 1/4 on are a histogram. The condition number "
            "tells how many times larger the relative error of t may be, as it is for grazing rays: t is exact within "
            "their product times 2^-53. The last column is the largest distance of a normal from the exact unit normal."
        )
        page.table(found.certificates, CERTIFICATES)


def summary(found: Findings) -> str:
    """Return the recommended settings, the stiff shapes and what was not measured, a line each."""
    stiff = (f"stiff: {each}" for each in found.stiff)
    return "\n".join([*[found.interrupted] * bool(found.interrupted), *advice(found), *stiff, *found.not_measured])


def advice(found: Findings) -> Iterator[str]:
    """Yield the best setting for each target error and each target time, and how many cannot be recommended."""
    disturbed = 0
    for choice in choices(found.pictures, found.reference_error):
        best, disturbed = choice["best"], choice["disturbed"]
        yield f"{choice['wanted']}: {described(best) if best else 'none of these settings'}"
    if disturbed:
        yield f"left out, as other programs disturbed their times: {disturbed}"


def described(row: Row) -> str:
    """Describe a recommended setting in words."""
    samples = f"{row.samples:.3g} sample{'s' * (row.samples != 1)}"
    asked = "" if isnan(row.asked) else f" asked for {row.asked:g},"
    return f"{row.knob},{asked} {samples} ({row.wall_ms:.3g} ms, RMSE {row.rmse:.2g}, {row.psnr:.1f} dB)"
