"""Answers of a report in sentences: the best setting, exactness, what is left out, and whether automatic sampling pays.

Backticks in them surround code, two stars what is bold.
"""

from __future__ import annotations

from math import isnan, nan

import numpy as np

from minirt.report.findings import CLEAR, ERRORS, LEVEL, Findings
from minirt.report.pictures import Row
from minirt.report.settings import AUTO, BRUTE_FORCE, UNIFORM

UNKNOWN = "unknown, as the times were disturbed, or too long to be taken more than once"


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
    choice, *finer = found.choices[ERRORS.index(LEVEL) : len(ERRORS)]
    rows = sorted((row for row in found.pictures if row.options and row.valid), key=lambda row: row.rmse)
    if not choice.best:
        return f"none has an {choice.goal} for sure; the closest is {described(rows[0])}" if rows else UNKNOWN
    text = f"for an {choice.goal}, one of 255 levels, {described(choice.best)}"
    if choice.equal:
        text += f", from which {choice.equal} cannot be told"
    for other in finer:
        if not other.best:
            return f"{text}; no setting has an {other.goal} for sure"
        if other.best != choice.best:
            times = f"{other.wall_ms / choice.wall_ms:.2g} times"
            return f"{text}; an {other.goal} costs {times} that: {described(other.best)}"
    return f"{text}; it has an {finer[-1].goal}, too"


def described(row: Row) -> str:
    """Describe a setting by its options, its time and its error."""
    return f"`{row.options}`, {row.wall_ms:.3g} ms a picture (RMSE {row.rmse:.2g})"


def exactness(found: Findings) -> str:
    """Name the largest backward error of a hit and the first stiff part, and count what single precision changes."""
    parts = []
    if found.certificates:
        worst = max(found.certificates, key=lambda each: each.backward_largest)
        count = sum(each.hits for each in found.certificates)
        where = f"{worst.kind}, rays {worst.rays}"
        parts.append(f"the worst of {count:,} hits is {worst.backward_largest:.2g} roundings off its surface ({where})")
    more = f", and {len(found.stiff) - 1} more below" if len(found.stiff) > 1 else ""
    parts.append(f"stiff is {found.stiff[0]}{more}" if found.stiff else "nothing in this scene is stiff")
    if not isnan(found.single):
        parts.append(
            f"`--precision single` changes {found.single:,} of {found.subject.width * found.subject.height:,} pixels"
        )
    return "; ".join(parts)


def left_out(found: Findings) -> str:
    """Tell what the kernel leaves out, and what is saved by not testing each ray against each shape."""
    text = f"the kernel of this scene lacks {found.absent}"
    first = {row.knob: row.wall_ms for row in found.pictures if row.valid and row.samples == 1}
    lean, brute = (first.get(knob.name, nan) for knob in (UNIFORM, BRUTE_FORCE))
    if isnan(lean + brute):
        return text
    same = ", the same bits" if found.same else ""
    return f"{text}; culling saves {1 - lean / brute:.0%} of a frame ({lean:.3g} ms instead of {brute:.3g} ms{same})"


def automatic(found: Findings) -> str:
    """Tell whether automatic sampling is faster than uniform sampling with the same true error.

    Uniform sampling with any error lies on the lines of the diagram. The interval of a ratio of times holds those of
    both times and of the error.
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
        ", ".join(f"{row.asked:g}" for row, so in zip(rows, found, strict=True) if so) for found in (high < 1, low > 1)
    )
    answer = "Yes" if faster else "No" if slower else "It makes no difference that can be measured"
    if faster and slower:
        answer = f"Yes for an error of {faster}, no for {slower}"
    extent = " to ".join(dict.fromkeys(f"{each:.2g}" for each in (ratio.min(), ratio.max())))
    last = f"{times[-1, 1]:.3g} ms instead of {others[-1, 1]:.3g} ms for RMSE {errors[-1, 1]:.2g}"
    return f"{answer}: it takes {extent} times as long as uniform sampling with the same true error ({last})"
