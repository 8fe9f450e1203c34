"""Text, tables and pictures of the report of a scene, in their order."""

from __future__ import annotations

from collections.abc import Iterator
from math import isnan

from minirt.report.measurements.findings import Findings, choices
from minirt.report.measurements.picture_errors import Row
from minirt.report.measurements.povray import ABOUT
from minirt.report.measurements.settings import BOUNCES, KNOBS
from minirt.report.output.blocks import (
    Block,
    Bullets,
    Column,
    Diagrams,
    Heading,
    Notice,
    Picture,
    Pictures,
    Text,
    table,
)
from minirt.report.output.certificate_section import certificate_section
from minirt.report.output.formula_section import formula_section
from minirt.report.output.sections import ablation_section, orders_section, single_section

PICTURES = (
    Column("setting", "knob"),
    Column("point", "label", ""),
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


def document(found: Findings, diagrams: Diagrams, pictures: list[Picture]) -> Iterator[Block]:
    """Yield the report of a scene: the diagram first, then what follows from it, then pictures and tables."""
    yield from opening(found)
    yield diagrams
    yield Heading("Recommended settings")
    yield Bullets(list(advice(found)))
    if pictures:
        yield from error_pictures(found, pictures)
    yield from settings_section(found)
    if found.orders:
        yield from orders_section(found)
    yield from left_out_section(found)
    if found.ablation:
        yield from ablation_section(found)
    if found.single:
        yield from single_section(found)
    yield Heading("Stiff parts of the scene")
    yield Bullets([str(each) for each in found.stiff]) if found.stiff else Text("None.")
    if found.kernels:
        yield from formula_section(found.kernels)
    if found.certificates:
        yield from certificate_section(found.certificates)
    if found.not_measured:
        yield Heading("Not measured")
        yield Bullets(found.not_measured)


def opening(found: Findings) -> Iterator[Block]:
    """Yield the title, and what was measured with what."""
    about = found.subject
    yield Heading(title(found), level=1)
    if found.interrupted:
        yield Notice(found.interrupted)
    versions = ", ".join(f"{name} {version}" for name, version in about.versions.items())
    machine = f"{about.threads} threads, {about.processor}"
    yield Text(f"{about.width}x{about.height} pixels, {machine}; seed {about.seed}. {versions}.")


def title(found: Findings) -> str:
    """Return the title of the report."""
    return f"{found.subject.scene}: error against run time"


def error_pictures(found: Findings, pictures: list[Picture]) -> Iterator[Block]:
    """Yield the error pictures, the first beside the most accurate recommended one."""
    yield Heading("Where the errors are")
    yield Text(
        "The pictures `error-*.png` show the error of each pixel: black up to 0.0001, blue at 0.001, red at 0.01, "
        "orange at 0.1, white at 1."
    )
    best = [
        picture_name(row) for row in recommended(found) if row.rmse == min(each.rmse for each in recommended(found))
    ]
    yield Pictures(pictures, next((i for i, each in enumerate(pictures) if each.name in best), len(pictures) - 1))


def picture_name(row: Row) -> str:
    """Return the caption of the error picture of a setting."""
    return f"{row.name}: RMSE {row.rmse:.2g}"


def settings_section(found: Findings) -> Iterator[Block]:
    """Yield the table of settings."""
    yield Heading("Pictures")
    yield Text(
        f"The reference has {found.reference_samples} samples per pixel in float64, at other sample positions; its own "
        f"RMSE is about {found.reference_error:.1g}. Each time is the median of undisturbed runs. From and to are 95 % "
        "confidence intervals. Recommended settings stand out."
    )
    yield table(found.pictures, PICTURES, recommended(found))
    used = {row.knob for row in found.pictures}
    abouts = {knob.name: knob.about for knob in (*KNOBS, *BOUNCES)} | ABOUT
    yield Bullets([f"{name}: {about}" for name, about in abouts.items() if name in used])


def left_out_section(found: Findings) -> Iterator[Block]:
    """Yield what the renderer leaves out."""
    yield Heading("Work that this scene leaves out")
    counts = " and ".join(map(str, found.same))
    same = f"testing every ray against every shape gives the same pictures, bit for bit (samples: {counts})"
    yield Bullets([*found.notes, *[same] * bool(found.same)])


def recommended(found: Findings) -> list[Row]:
    """Return the rows that are the best for some wanted error or time."""
    best = (choice["best"] for choice in choices(found.pictures, found.reference_error))
    return list(dict.fromkeys(row for row in best if row is not None))


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
