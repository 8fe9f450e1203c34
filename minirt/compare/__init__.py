"""Compare a picture of another ray tracer with the reference, and name what it does in another way."""

from __future__ import annotations

import os
import sys
from pathlib import Path
from types import ModuleType
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from minirt.compare import answer, lighting, pictures
from minirt.compare.answer import Cause, Rest
from minirt.compare.judge import Judge, at_edges, needed, shapes_alone
from minirt.compare.search import Case, search
from minirt.compare.table import OURS, Guess
from minirt.rendering.settings import render
from minirt.scene import Scene, check_scene

KNOWN, LIKELY = 0.8, 0.96  # shares of the inner pixels; what explains less is not told, or told with "perhaps"


class Comparison(NamedTuple):
    """Answer about a picture. `str()` of it is the answer in words, `.json()` the same for programs."""

    equal: bool  # within a level, or within four but at edges
    explained: float  # share of the inner pixels that are equal, or are so under the causes
    sure: bool  # that they are equal, or that the causes are right; the likeliest ones are told otherwise
    causes: tuple[Cause, ...]  # what the other program does in another way: name, value, sentence
    rest: tuple[Rest, ...]  # where other pixels lie: shape, part, share of all pixels, one pixel
    notices: tuple[str, ...]  # about the picture, such as a border that is cut off
    scene: Scene
    picture: NDArray[np.uint8]  # (h, w, 3) theirs, without a border
    guess: Guess  # all parameters of the table of hypotheses

    def json(self) -> dict[str, Any]:
        """Return the answer as what `json.dumps` takes: equal, explained, causes, rest and notices."""
        return {
            "equal": self.equal,
            "explained": round(self.explained, 4),
            "sure": self.sure,
            "causes": [each._asdict() for each in self.causes],
            "rest": [each._asdict() | {"share": round(each.share, 4)} for each in self.rest],
            "notices": list(self.notices),
        }

    def __str__(self) -> str:
        lines = [*self.notices, self.verdict()]
        if self.equal:
            return "\n".join(lines)
        lines += [f"- {each.name}: {each.sentence}" for each in self.causes]
        if self.rest:
            what = "What is left" if self.sure else "What still differs"
            lines.append(f"{what}:" if self.causes else "Where they differ:")
        for each in self.rest:
            where = each.shape if each.part == "surface" else f"{each.part} of {each.shape}"
            lines.append(f"- {each.share:.1%} of all pixels: {where}, such as pixel {each.pixel[0]},{each.pixel[1]}")
        return "\n".join(lines)

    def verdict(self) -> str:
        """Return the first sentence of the answer."""
        if self.equal:
            return "The pictures are equal, but at edges." if self.rest else "The pictures are equal."
        if self.explained < KNOWN:
            share = f"{self.explained:.0%} of the inner pixels are explained"
            if self.causes:
                return f"The pictures differ. The light is not known ({share}); most likely these place the shapes:"
            return f"The pictures differ, and it is not known why: {share}."
        what = "this explains" if len(self.causes) == 1 else "these explain together"
        if not self.sure:
            what = f"{'most likely' if self.explained >= LIKELY else 'perhaps'} {what}"
        if not self.causes:
            return f"The pictures differ in parts: {self.explained:.1%} of the inner pixels are equal."
        return f"The pictures differ; {what} {self.explained:.1%} of the inner pixels:"

    def panels(self) -> NDArray[np.uint8]:
        """Four pictures beside each other: theirs, the reference, the reference under the causes, the difference."""
        return pictures.panels(self.scene, self.picture, self.guess)


def compare(scene: Scene, picture: str | os.PathLike[str]) -> Comparison:
    """Compare a picture file of another program with the picture of a scene, and tell what differs and why.

        print(minirt.compare(minirt.load("scene.rt"), "mine.ppm"))

    The picture may have any size from 16x16 pixels on. FileError if it cannot be read.
    """
    check_scene(scene, "compare")
    theirs, notices, is_lossy, side = pictures.read(Path(picture))
    height, width, _ = theirs.shape
    reference = render(scene, width, height).array
    if pictures.are_equal(theirs, reference, is_lossy):
        return Comparison(True, 1.0, True, (), (), notices, scene, theirs, OURS)
    if int(np.ptp(theirs, axis=(0, 1)).max()) <= pictures.EDGE:
        notices += ("The picture has one colour alone.",)
        return Comparison(False, 0.0, False, (), (), notices, scene, theirs, OURS)
    # Errors, in shares of light, up to which a pixel is equal, and up to which it is nearly so.
    exact, tolerance = (lighting.LEVEL * (levels + 0.5) for levels in pictures.tolerances(is_lossy))
    case = Case(scene, theirs / 255)
    is_alike = pictures.are_alike(theirs, reference, is_lossy)
    judge = at_edges(needed(case, OURS if is_alike else search(case), tolerance))
    if not judge.judged.all():
        what = "textures, bumps, mirrors or glass"
        notices += (f"{1 - judge.judged.mean():.1%} of the pixels show {what}: their light is not judged.",)
    explained = 1 - judge.left(judge.fit, tolerance) if judge.sees_enough() else 0.0
    is_known = explained >= KNOWN
    guess = judge.guess if is_known else shapes_alone(judge)
    if not is_known:
        judge = Judge(case, guess, tolerance)
    found = answer.causes(judge, guess) + (answer.factors(judge) if is_known else [])
    if side > 1:  # a preview may send the ray of a block through any of its pixels
        found = [each for each in found if each.name != "pixel"]
    if is_alike and not found:  # pixels at edges may differ
        return Comparison(True, 1.0, True, (), answer.rest(judge, tolerance), notices, scene, theirs, OURS)
    is_told = is_known and bool(found)
    is_sure = is_told and judge.is_right(exact)
    rest = answer.rest(judge, exact, always=True) if is_told and not is_sure else answer.rest(judge, tolerance)
    return Comparison(False, explained, is_sure, tuple(found), rest, notices, scene, theirs, guess)


class CallableModule(ModuleType):
    """This package as the function of the same name: `minirt.compare(scene, picture)`, whatever was imported before."""

    def __call__(self, scene: Scene, picture: str | os.PathLike[str]) -> Comparison:
        """Compare, as the function `compare` does."""
        return compare(scene, picture)


sys.modules[__name__].__class__ = CallableModule
