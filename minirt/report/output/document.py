"""The report as a text to read."""

from __future__ import annotations

from collections.abc import Iterator
from math import isnan
from typing import Any

from minirt.report.measurements.findings import Findings, choices
from minirt.report.measurements.formula_errors import Row
from minirt.report.measurements.regimes import REGIMES
from minirt.report.measurements.settings import BOUNCES, KNOBS
from minirt.report.output.tables import Column, as_markdown

PICTURES = (
    Column("setting", "knob"),
    Column("samples", "samples", "d"),
    Column("RMSE", "rmse", ".5f"),
    Column("PSNR, dB", "psnr", ".1f"),
    Column("FLIP", "flip", ".4f"),
    Column("changed pixels", "changed", ".0f"),
    Column("rays not finite", "not_finite", ".0f"),
    Column("ms", "wall_ms", ".2f"),
    Column("processor ms", "cpu_ms", ".2f"),
    Column("sorting, ms", "sort_ms", ".2f"),
    Column("compiling or loading, s", "compile_s", ".2f"),
    Column("remark", "remark"),
)


def document(found: Findings, has_diagram: bool) -> str:
    """The report of a scene, in Markdown."""
    return "\n".join(lines(found, has_diagram)) + "\n"


def lines(found: Findings, has_diagram: bool) -> Iterator[str]:
    """Its lines."""
    about = found.subject
    yield f"# {about.scene}: error against run time\n"
    yield f"{about.width}x{about.height} pixels, {about.threads} threads, {about.processor}; seed {about.seed}."
    yield ", ".join(f"{name} {version}" for name, version in about.versions.items()) + ".\n"
    yield "## Pictures\n"
    yield (
        f"Compared with {found.reference_samples} samples a pixel in float64, at other places of the pixels; the RMSE "
        f"of that reference itself is about {found.reference_error:.1g}. `error-*.png` show where the errors are: "
        "black below 1e-4, white at 1. Times are the least of at least 7 runs."
    )
    if has_diagram:
        yield "\n![Error against run time](diagram.png)"
    yield "\n" + as_markdown(found.pictures, PICTURES)
    used = {row.knob for row in found.pictures}
    yield from ("", *(f"- {knob.name}: {knob.about}" for knob in (*KNOBS, *BOUNCES) if knob.name in used))
    yield "\n## What to take\n"
    yield from (f"- {each}" for each in advice(found))
    yield "\n## What the scene does without\n"
    yield from (f"- {note}" for note in found.notes)
    if found.same:
        counts = " and ".join(map(str, found.same))
        yield f"- trying every shape for every ray: the same pictures, bit for bit (samples: {counts})"
    yield "\n## Where the scene is stiff\n"
    yield from [f"- {each}" for each in found.stiff] or ["Nowhere."]
    yield from formulas(found.kernels)
    if found.not_measured:
        yield "\n## Not measured\n"
        yield from (f"- {each}" for each in found.not_measured)


def short(found: Findings) -> str:
    """What to know first."""
    return "\n".join([*advice(found), *(f"stiff: {each}" for each in found.stiff), *found.not_measured])


def advice(found: Findings) -> Iterator[str]:
    """What to take for each wish."""
    for choice in choices(found.pictures, found.reference_error):
        yield f"{choice['wanted']}: {chosen(choice['best'])}"


def chosen(row: Any) -> str:
    """A setting that was chosen, in words."""
    if row is None:
        return "none of these settings"
    samples = f"{row.samples} sample{'s' * (row.samples != 1)}"
    figures = f"{row.wall_ms:.3g} ms, RMSE {row.rmse:.2g}, {row.psnr:.1f} dB"
    return f"{row.knob}, {samples} ({figures}{'' if row.valid else ', disturbed'})"


def formulas(rows: list[Row]) -> Iterator[str]:
    """What is said about the formulas: a line for each regime of a kind, the formulas beside each other."""
    names = list(dict.fromkeys(row.formula for row in rows))
    groups: dict[tuple[str, str], dict[str, Row]] = {}
    for row in rows:
        groups.setdefault((row.kind, row.regime), {})[row.formula] = row
    yield "\n## Formulas\n"
    yield (
        "Relative error of the distance at which a ray meets a shape, against 60 digits: the largest (and the root "
        "mean square), false misses/false hits, and nanoseconds a ray of one thread, * where other programs disturbed "
        "it. Verdicts are false where a shape thicker and one thinner by 64 roundings both have the other one; a "
        "square and a disc are larger and smaller by 64 roundings by the ray's slope. "
        "The cost is the processor time of the first formula in that of the textbook's, the median of runs in turn. "
        "Packets of rays of which one starts closely above or below a sphere, on its scale, are worked out with twice "
        "the digits and take several times as long; other packets do not.\n"
    )
    yield "| shape | rays | " + " | ".join(names) + " | cost |\n|---|---|" + "---|" * (len(names) + 1)
    for (kind, regime), found in groups.items():
        cells = (figures(found[name]) if name in found else "-" for name in names)
        yield f"| {kind} | {regime} | " + " | ".join(cells) + f" | {cost(found[names[0]])} |"
    yield from ("", *(f"- {each.name}: {each.about}" for each in REGIMES))


def figures(row: Row) -> str:
    """What a formula did in a regime."""
    errors = f"{row.max_error:.0e} ({row.rms_error:.0e})" if row.hits else "no hit"
    return f"{errors}, {row.false_misses}/{row.false_hits}, {row.ns_ray:.2f} ns{'' if row.valid else ' *'}"


def cost(row: Row) -> str:
    """How many times as long as the textbook's a formula takes."""
    return "-" if isnan(row.times_textbook) else f"{row.times_textbook:.2f}"
