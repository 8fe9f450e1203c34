"""Answers of a report: what to type, exactness, what is left out, whether automatic sampling pays, what changed.

`answers.txt` has the sentences, in which backticks surround code.
"""

from __future__ import annotations

import re
import shlex
from itertools import dropwhile
from math import isfinite, nan
from typing import Any

import numpy as np

from minirt.report.against import changes, differences
from minirt.report.findings import CLEAR, ERRORS, LEVEL, Findings
from minirt.report.page import filled
from minirt.report.settings import AUTO, UNIFORM
from minirt.report.variants import CULLING

SPACES = re.compile(r"\s+(?=[,;.]\s|[,;.]$)")  # before a sign that ends a phrase


def answers(found: Findings) -> list[tuple[str, str]]:
    """Return questions and their answers."""
    best, *finer = found.choices[ERRORS.index(LEVEL) :]
    added = [part for part in found.ablation if part.change == "added" and part.percent_low > 0]
    told: dict[str, Any] = {
        "found": found,
        "scene": shlex.quote(found.subject.scene),
        "best": best,
        "next": next(dropwhile(lambda choice: choice.best == best.best, finer), None),
        "last": f"{ERRORS[-1]:g}",
        "worst": max(found.certificates, key=lambda each: each.backward_largest, default=None),
        "hits": sum(each.hits for each in found.certificates),
        "dearest": max(added, key=lambda part: part.percent, default=None),
        "scene_ms": found.ablation[0].frame_ms if found.ablation else nan,
        "brute": next((part for part in found.ablation if part.name == CULLING), None),
        "automatic": automatic(found),
    }
    if found.other:
        told |= {"changes": list(changes(found, found.other)), **differences(found, found.other)}
    lines = filled("answers.txt", told).split("\n.\n")
    pairs = (SPACES.sub("", " ".join(f"{line}.".split())).split(" | ") for line in lines if line.strip())
    return [(question, answer) for question, answer in pairs]


def automatic(found: Findings) -> str:
    """Tell whether automatic sampling is faster than uniform sampling with the same true error, on the diagram's line.

    The interval of the ratio of their times follows from the intervals of time and of error.
    """
    timed = [row for row in found.pictures if isfinite(row.ms)]
    known = [row for row in timed if row.rmse > CLEAR * found.reference_error]
    uniform = sorted((row.rmse, row.ms) for row in known if row.knob == UNIFORM.name)
    least_error = uniform[0][0] if uniform else nan
    rows = [row for row in known if row.knob == AUTO.name and row.rmse_low > least_error]
    if not rows:
        names = {row.knob for row in timed}
        if not {UNIFORM.name, AUTO.name} <= names:
            return "It was not measured"
        if uniform:
            return "Yes: it has smaller errors than any uniform number of samples that was measured"
        return "No: one sample per pixel has no error that the reference could tell"
    times = np.array([(row.ms_low, row.ms, row.ms_high) for row in rows])
    errors = np.array([(row.rmse_low, row.rmse, row.rmse_high) for row in rows])
    others = np.exp(np.interp(np.log(errors), *np.log(uniform).T))  # times of uniform sampling for these errors
    low, ratio, high = (times / others).T
    told = [
        f"{word} for an error of {', '.join(f'{row.asked:g}' for row, is_so in zip(rows, which, strict=True) if is_so)}"
        for word, which in (("yes", high < 1), ("no", low > 1))
        if which.any()
    ]
    answer = ", ".join(told) or "it makes no difference that can be measured"
    extent = " to ".join(dict.fromkeys(f"{each:.2g}" for each in (ratio.min(), ratio.max())))
    last = f"{times[-1, 1]:.4g} ms instead of {others[-1, 1]:.4g} ms for RMSE {errors[-1, 1]:.2g}"
    same = "uniform sampling with the same true error"
    return f"{answer[0].upper()}{answer[1:]}: it takes {extent} times as long as {same} ({last})"
