"""Answers, tables and pictures of the page of a report, and the files that hold them."""

from __future__ import annotations

import os
from collections.abc import Iterator
from math import isnan
from pathlib import Path
from typing import Any

import numpy as np

from minirt.helpers import file_io
from minirt.rendering.image import Image
from minirt.report.diagram import NARROW, WIDE, draw, on_page
from minirt.report.findings import CLEAR, ERRORS, LEVEL, Findings, distinct
from minirt.report.metrics import Picture as Light
from minirt.report.metrics import error_image, to_8_bits, worst_region
from minirt.report.page import as_csv, as_json, bullets, figures, filled, table
from minirt.report.pictures import Row
from minirt.report.povray import ABOUT
from minirt.report.settings import AUTO, BRUTE_FORCE, KNOBS, UNIFORM

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


# Answers in sentences: the best setting, exactness, what is left out, and whether automatic sampling pays. Backticks in
# them surround code, two stars what is bold.

UNKNOWN = "unknown, as there are no undisturbed times to compare"


def answers(found: Findings) -> list[str]:
    """Return the answers, a sentence each."""
    return [
        f"**Best setting:** {best_setting(found)}.",
        f"**Exactness:** {exactness(found)}.",
        f"**Left out:** {left_out(found)}.",
        f"**Does `--samples auto` pay here?** {automatic(found)}.",
    ]


def best_setting(found: Findings) -> str:
    """Name the best setting for an error of one level of 255, and what the next smaller error costs."""
    place = ERRORS.index(LEVEL)
    best, equal = found.choices[place].best, found.choices[place].equal
    goal = f"an error of at most {LEVEL:g}, one of 255 levels"
    if not best:
        rows = sorted((row for row in found.pictures if row.options and row.valid), key=lambda row: row.rmse)
        return f"none is sure to have {goal}; {described(rows[0])} comes closest" if rows else UNKNOWN
    text = f"{described(best)} has {goal}" + (f", and so has {equal}" if equal else "")
    for most, choice in zip(ERRORS[place + 1 :], found.choices[place + 1 :], strict=False):
        if not choice.best:
            return f"{text}; none is sure to have at most {most:g}"
        if choice.best != best:
            times = f"{choice.wall_ms / best.wall_ms:.3g} times the time"
            return f"{text}; at most {most:g} costs {times}, with {described(choice.best)}"
    return f"{text}, and even of at most {ERRORS[-1]:g}"


def described(row: Row) -> str:
    """Describe a setting by its options, its time and its error."""
    return f"`{row.options}` ({row.wall_ms:.4g} ms a picture, RMSE {row.rmse:.2g})"


def exactness(found: Findings) -> str:
    """Name the largest backward error of a hit and the first stiff part, and count what single precision changes."""
    parts = ["nothing in this scene is stiff"]
    if found.stiff:
        first, *more = found.stiff
        parts = [f"{first.element} is stiff ({first.why})" + f", and {len(more)} more below" * bool(more)]
    if found.certificates:
        worst = max(found.certificates, key=lambda each: each.backward_largest)
        count, where = sum(each.hits for each in found.certificates), f"{worst.kind}, rays {worst.rays}"
        hits = f"the worst of {count:,} hits is {worst.backward_largest:.2g} roundings off its surface ({where})"
        parts.insert(0, hits)
    if not isnan(found.single):
        pixels = found.subject.width * found.subject.height
        parts.append(f"`--precision single` changes {found.single:,} of {pixels:,} pixels")
    return "; ".join(parts)


def left_out(found: Findings) -> str:
    """Tell what the kernel leaves out, and what is saved by not testing each ray against each shape."""
    text = f"the kernel of this scene lacks {found.absent}"
    added = [part for part in found.ablation if part.change == "added" and part.percent_low > 0]
    if added:
        dearest = max(added, key=lambda part: part.percent)
        text += f", of which {dearest.name} would cost most, {dearest.percent:.1f} % of a frame"
    first = {row.knob: row for row in found.pictures if row.valid and row.samples == 1}
    lean, brute = (first.get(knob.name, Row("", "")) for knob in (UNIFORM, BRUTE_FORCE))
    if not lean.wall_high_ms < brute.wall_low_ms:
        return text
    saved, same = 100 * (1 - lean.wall_ms / brute.wall_ms), ", the same bits" if found.same else ""
    times = f"{lean.wall_ms:.4g} ms instead of {brute.wall_ms:.4g} ms"
    return f"{text}; culling saves {saved:.0f} % of a frame ({times}{same})"


def automatic(found: Findings) -> str:
    """Tell whether automatic sampling is faster than uniform sampling with the same true error, on the diagram's line.

    The interval of the ratio of their times holds those of time and error.
    """
    known = [row for row in found.pictures if row.valid and row.rmse > CLEAR * found.reference_error]
    uniform = sorted((row.rmse, row.wall_ms) for row in known if row.knob == UNIFORM.name)
    rows = [row for row in known if row.knob == AUTO.name and uniform and row.rmse_low > uniform[0][0]]
    if not rows:
        return UNKNOWN
    times = np.array([(row.wall_low_ms, row.wall_ms, row.wall_high_ms) for row in rows])
    errors = np.array([(row.rmse_low, row.rmse, row.rmse_high) for row in rows])
    others = np.exp(np.interp(np.log(errors), *np.log(uniform).T))
    low, ratio, high = (times / others).T
    faster, slower = (
        ", ".join(f"{row.asked:g}" for row, so in zip(rows, each, strict=True) if so) for each in (high < 1, low > 1)
    )
    answer = "Yes" if faster else "No" if slower else "It makes no difference that can be measured"
    if faster and slower:
        answer = f"Yes for an error of {faster}, no for {slower}"
    extent = " to ".join(dict.fromkeys(f"{each:.2g}" for each in (ratio.min(), ratio.max())))
    last = f"{times[-1, 1]:.4g} ms instead of {others[-1, 1]:.4g} ms for RMSE {errors[-1, 1]:.2g}"
    return f"{answer}: it takes {extent} times as long as uniform sampling with the same true error ({last})"
