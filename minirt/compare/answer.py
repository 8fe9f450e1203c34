"""The answer: whether pictures are equal, else causes, what they explain together, and where the rest lies."""

from __future__ import annotations

from math import atan, degrees
from typing import Any, NamedTuple

import numpy as np

from minirt.compare import lighting
from minirt.compare.cameras import is_aimed
from minirt.compare.changed_shapes import changed_scene
from minirt.compare.geometry import frame, on_cap, slopes
from minirt.compare.judge import LEAST_GAIN, Judge
from minirt.compare.sky import background
from minirt.compare.table import FREE, TABLE, Guess
from minirt.rendering.notes import shape_name

LEAST_REST = 0.001  # share of pixels of a part that is worth a line
MOST_REST = 6  # parts


class Cause(NamedTuple):
    """Difference of the other program from this one, and the sentence that says what to change."""

    name: str
    value: Any
    sentence: str


class Rest(NamedTuple):
    """Part of the picture whose pixels are not explained."""

    shape: str
    part: str  # surface, cap, shadow or edge
    share: float  # of all pixels
    pixel: tuple[int, int]  # column and row of one of them


def causes(judge: Judge, guess: Guess) -> list[Cause]:
    """Return what a guess says, as sentences."""
    fit, scene = judge.fit, judge.case.scene
    found = []
    for row in TABLE:
        (name, value), *_ = row.changes.items()
        if guess[name] != value:
            continue
        sentence, told = row.sentence, row.value
        if name == "specular":
            sentence = FREE["share"].format(sentence=sentence, value=round(float(fit.factors[lighting.SPECULAR]), 2))
        if name == "background":
            colour, here = ([round(each * 255) for each in sky[0]] for sky in (fit.sky, background(scene)))
            told = colour if told == "own" else told
            sentence = sentence.format(colour=",".join(map(str, colour)), ours=",".join(map(str, here)))
        found.append(Cause(row.name, told, sentence))
    if guess["scale"] != 1.0:
        across = round(2 * degrees(atan(slopes(scene.camera, judge.case.width / judge.case.height, guess)[0])), 1)
        found.append(Cause("fov", across, FREE["scale"].format(value=across, ours=scene.camera.fov)))
    if guess["roll"]:
        angle = round(guess["roll"], 1)
        found.append(Cause("roll", angle, FREE["roll"].format(value=angle)))
    if is_aimed(guess):
        way, here = (
            [round(float(x), 3) for x in each] for each in (frame(scene.camera, guess)[2], scene.camera.direction)
        )
        spelled, ours = (",".join(map(str, each)) for each in (way, here))
        found.append(Cause("direction", way, FREE["direction"].format(value=spelled, ours=ours)))
    return found


def factors(judge: Judge) -> list[Cause]:
    """Return the factors of ambient light and of lamps that are not those of the scene, and that count."""
    guess, fit = judge.guess, judge.fit
    diffuse = [round(float(each), 2) for each in fit.diffuse]
    if max(diffuse, default=1.0) - min(diffuse, default=1.0) < lighting.SLACK:
        diffuse = diffuse[:1]
    told = {"ambient": [round(float(fit.factors[lighting.AMBIENT]), 2)], "diffuse": diffuse}
    if lighting.has_highlights(judge.case.scene) and not guess["specular"]:
        told["specular"] = [round(float(fit.factors[lighting.SPECULAR]), 2)]
    if guess["fading"]:
        del told["diffuse"]  # whose unit is a free choice of the other program
    found = []
    for name, values in told.items():
        if any(map(lighting.differs, values)) and judge.gain(judge.fitted(guess, name)) > LEAST_GAIN:
            value = values[0] if len(values) == 1 else values
            spelled = ", ".join(map(str, values))
            found.append(Cause(name, value, FREE[name].format(value=spelled)))
    return found


def rest(judge: Judge, tolerance: float, always: bool = False) -> tuple[Rest, ...]:
    """Return where the pixels lie that a guess does not explain to a tolerance, the largest part first; the largest one
    `always`, however small it is."""
    seen, scene = judge.seen, changed_scene(judge.case.scene, judge.guess)
    wrong = judge.judged & (judge.fit.error > tolerance)
    _, cosine = lighting.cosines(seen, judge.guess)
    shadow = (cosine > 0).any(axis=0) & ~((cosine > 0) & seen.open_to).any(axis=0)
    masks = {"edge": ~judge.inner, "cap": on_cap(scene, seen.owner, seen.normal), "shadow": shadow}
    masks["surface"] = np.ones(len(wrong), bool)
    found = []
    for part, mask in masks.items():
        for owner in np.unique(seen.owner[wrong & mask]):
            here = np.flatnonzero(wrong & mask & (seen.owner == owner))
            x, y = judge.x[here], judge.y[here]
            middle = np.argmin(np.hypot(x - np.median(x), y - np.median(y)))
            place = int(x[middle]), int(y[middle])
            name = shape_name(judge.case.scene, int(owner)) if owner >= 0 else "background"
            found.append(Rest(name, part, len(here) / len(wrong), place))
        wrong &= ~mask
    large = [each.share >= LEAST_REST for each in found].count(True)
    return tuple(sorted(found, key=lambda each: -each.share)[: min(max(large, always), MOST_REST)])
