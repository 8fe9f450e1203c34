"""The answer: whether pictures are equal, else causes, what they explain together, and where the rest lies."""

from __future__ import annotations

from math import atan, degrees
from typing import Any, NamedTuple

import numpy as np

from minirt.compare import lighting
from minirt.compare.cameras import is_aimed
from minirt.compare.changed_shapes import changed_scene
from minirt.compare.geometry import cosines, frame, on_cap, slopes
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
    """Return the causes that a guess names: each row of the table that it follows, then the field of view, the roll and
    the direction of the camera where they are numbers of its own."""
    fit, scene = judge.fit, judge.case.scene
    found = []
    for row in TABLE:
        (name, value), *_ = row.changes.items()  # the first change tells the row from others
        if guess[name] != value:
            continue
        sentence, told = row.sentence, row.value
        if name == "specular":
            sentence = FREE["share"].format(sentence=sentence, value=round(float(fit.factors[lighting.SPECULAR]), 2))
        if name == "background":
            colour, here = ([round(each * 255) for each in sky[0]] for sky in (fit.sky, background(scene)))
            told = colour if told == "own" else told  # a gradient is told by its name
            sentence = sentence.format(colour=",".join(map(str, colour)), ours=",".join(map(str, here)))
        found.append(Cause(row.name, told, sentence))
    if guess["scale"] != 1.0:
        across, _ = slopes(scene.camera, judge.case.width / judge.case.height, guess)
        fov = round(2 * degrees(atan(across)), 1)
        found.append(Cause("fov", fov, FREE["scale"].format(value=fov, ours=scene.camera.fov)))
    if guess["roll"]:
        angle = round(guess["roll"], 1)
        found.append(Cause("roll", angle, FREE["roll"].format(value=angle)))
    if is_aimed(guess):
        _, _, forward = frame(scene.camera, guess)
        way, here = ([round(float(x), 3) for x in each] for each in (forward, scene.camera.direction))
        spelled, ours = (",".join(map(str, each)) for each in (way, here))
        found.append(Cause("direction", way, FREE["direction"].format(value=spelled, ours=ours)))
    return found


def factors(judge: Judge) -> list[Cause]:
    """Return the factors of ambient light, lamps and highlights that are not 1, and without which the guess explains
    clearly fewer pixels."""
    guess, fit = judge.guess, judge.fit
    diffuse = [round(float(each), 2) for each in fit.diffuse]
    if max(diffuse, default=1.0) - min(diffuse, default=1.0) < lighting.SLACK:
        diffuse = diffuse[:1]  # one for all lamps
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
    """Return where the pixels lie that a guess does not explain to a tolerance, the largest part first.

    Parts of less than LEAST_REST are left out; `always` keeps the largest part, however small it is.
    """
    seen, scene = judge.seen, changed_scene(judge.case.scene, judge.guess)
    wrong = judge.judged & (judge.fit.error > tolerance)
    _, cosine = cosines(seen, judge.guess)
    is_lit = ((cosine > 0) & seen.open_to).any(axis=0)
    shadow = (cosine > 0).any(axis=0) & ~is_lit
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
        wrong &= ~mask  # a pixel counts in the first of its parts
    count = [each.share >= LEAST_REST for each in found].count(True)
    if always:
        count = max(count, 1)
    return tuple(sorted(found, key=lambda each: -each.share)[: min(count, MOST_REST)])
