"""Answers of a report in sentences: the best setting, exactness, what is left out, and whether automatic sampling pays.

Backticks in them surround code, two stars what is bold.
"""

from __future__ import annotations

from math import isnan

import numpy as np

from minirt.report.findings import CLEAR, ERRORS, LEVEL, Findings
from minirt.report.pictures import Row
from minirt.report.settings import AUTO, BRUTE_FORCE, UNIFORM

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
