"""The report as Markdown."""

from __future__ import annotations

from collections.abc import Iterator
from math import isnan
from typing import Any

from minirt.report.measurements.findings import Findings, choices
from minirt.report.measurements.formula_errors import Row
from minirt.report.measurements.povray import ABOUT
from minirt.report.measurements.regimes import REGIMES
from minirt.report.measurements.settings import BOUNCES, KNOBS
from minirt.report.output.sections import ablation_section, orders_section, single_section
from minirt.report.output.tables import Column, as_markdown

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


def document(found: Findings, has_diagram: bool) -> str:
    """Return the report of a scene in Markdown."""
    return "\n".join(report_lines(found, has_diagram)) + "\n"


def report_lines(found: Findings, has_diagram: bool) -> Iterator[str]:
    """Yield the lines of the report."""
    about = found.subject
    yield f"# {about.scene}: error against run time\n"
    yield f"{about.width}x{about.height} pixels, {about.threads} threads, {about.processor}; seed {about.seed}."
    yield ", ".join(f"{name} {version}" for name, version in about.versions.items()) + ".\n"
    yield "## Pictures\n"
    yield (
        f"The reference has {found.reference_samples} samples per pixel in float64, at other sample positions; its own "
        f"RMSE is about {found.reference_error:.1g}. The pictures `error-*.png` show the errors: black below 1e-4, "
        "white at 1. Each time is the median of undisturbed runs. From and to are 95 % confidence intervals."
    )
    if has_diagram:
        yield "\n![Error against run time](diagram.png)"
    yield "\n" + as_markdown(found.pictures, PICTURES)
    used = {row.knob for row in found.pictures}
    abouts = {knob.name: knob.about for knob in (*KNOBS, *BOUNCES)} | ABOUT
    yield from ("", *(f"- {name}: {about}" for name, about in abouts.items() if name in used))
    yield from orders_section(found)
    yield "\n## Recommended settings\n"
    yield from (f"- {each}" for each in advice(found))
    yield "\n## Work that this scene leaves out\n"
    yield from (f"- {note}" for note in found.notes)
    if found.same:
        counts = " and ".join(map(str, found.same))
        yield f"- testing every ray against every shape gives the same pictures, bit for bit (samples: {counts})"
    yield from ablation_section(found)
    yield from single_section(found)
    yield "\n## Stiff parts of the scene\n"
    yield from [f"- {each}" for each in found.stiff] or ["None."]
    yield from formula_section(found.kernels)
    if found.not_measured:
        yield "\n## Not measured\n"
        yield from (f"- {each}" for each in found.not_measured)


def summary(found: Findings) -> str:
    """Return the recommended settings, the stiff shapes and what was not measured, a line each."""
    return "\n".join([*advice(found), *(f"stiff: {each}" for each in found.stiff), *found.not_measured])


def advice(found: Findings) -> Iterator[str]:
    """Yield the best setting for each target error and each target time."""
    for choice in choices(found.pictures, found.reference_error):
        left_out = f" ({choice['disturbed']} more were disturbed by other programs)" if choice["disturbed"] else ""
        yield f"{choice['wanted']}: {described(choice['best'])}{left_out}"


def described(row: Any) -> str:
    """Describe a recommended setting in words."""
    if row is None:
        return "none of these settings"
    samples = f"{row.samples:.3g} sample{'s' * (row.samples != 1)}"
    asked = "" if isnan(row.asked) else f" asked for {row.asked:g},"
    return f"{row.knob},{asked} {samples} ({row.wall_ms:.3g} ms, RMSE {row.rmse:.2g}, {row.psnr:.1f} dB)"


def formula_section(rows: list[Row]) -> Iterator[str]:
    """Yield the table of formulas: a line for each shape type and regime, a column for each formula."""
    names = list(dict.fromkeys(row.formula for row in rows))
    groups: dict[tuple[str, str], dict[str, Row]] = {}
    for row in rows:
        groups.setdefault((row.kind, row.regime), {})[row.formula] = row
    yield "\n## Formulas\n"
    yield (
        "Each cell gives the relative error of the hit distance against 60-digit arithmetic, as maximum (and root mean "
        "square); false misses/false hits; and nanoseconds per ray on one thread, with * if other programs disturbed "
        "the measurement. A hit or miss counts as false if a shape thicker and a shape thinner by 64 unit roundoffs "
        "both give the opposite; for a square and a disc the 64 roundoffs are divided by the slope of the ray. "
        "The cost is the processor time of the first formula divided by that of the textbook formula, the median of "
        "alternating runs. A packet in which a ray starts just above or below a sphere, relative to its size, is "
        "computed with twice the digits and takes several times as long; other packets are not affected.\n"
    )
    yield "| shape | rays | " + " | ".join(names) + " | cost |\n|---|---|" + "---|" * (len(names) + 1)
    for (kind, regime), found in groups.items():
        cells = (figures_text(found[name]) if name in found else "-" for name in names)
        yield f"| {kind} | {regime} | " + " | ".join(cells) + f" | {cost_text(found[names[0]])} |"
    yield from ("", *(f"- {each.name}: {each.about}" for each in REGIMES))


def figures_text(row: Row) -> str:
    """Format the errors and the time of a formula in a regime."""
    errors = f"{row.max_error:.0e} ({row.rms_error:.0e})" if row.hits else "no hit"
    return f"{errors}, {row.false_misses}/{row.false_hits}, {row.ns_ray:.2f} ns{'' if row.valid else ' *'}"


def cost_text(row: Row) -> str:
    """Format the cost of a formula relative to the textbook's."""
    return "-" if isnan(row.times_textbook) else f"{row.times_textbook:.2f}"
