"""Pictures that are compared: how they are read, whether they are equal, and the four panels of the answer."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from PIL import Image, ImageFilter

from minirt.compare import lighting
from minirt.compare.geometry import see
from minirt.compare.search import LARGE, Case
from minirt.compare.table import Guess
from minirt.errors import FileError
from minirt.materials.pictures import picture
from minirt.rendering.settings import render
from minirt.scene import Scene

Levels = NDArray[np.uint8]  # (h, w, 3)
LOSSY = {".jpg", ".jpeg", ".jpe", ".jfif", ".webp"}
EXACT, CLOSE = 1, 4  # levels
EXACT_LOSSY, CLOSE_LOSSY = 8, 12
EDGE = 8  # levels between neighbours
STRAY = 1e-4  # share of pixels that may be off beside edges
BLOCK = 16  # pixels, of JPEG with half of the colours
SMALLEST = 16  # pixels of a side
LARGEST_BLOCK = 16  # pixels
BAND = 250_000  # pixels that are drawn at once
GAP = 4  # pixels between panels
BRIGHTER = 4  # times the difference, in its panel


def read(path: Path) -> tuple[Levels, tuple[str, ...], bool, int]:
    """Return a picture without its border and with single pixels in place of blocks, what is to be told about that,
    whether its format is lossy, and the side of the blocks in pixels, 1 without any. FileError where it cannot be read
    or is too small."""
    levels, notices = picture(path), []
    left, above, right, below = border(levels)
    has_border = left and above and right and below
    if has_border:
        height, width, _ = levels.shape
        levels = levels[above : height - below, left : width - right]
        sides = f"{left}, {above}, {right} and {below} pixels at the left, top, right and bottom"
        notices.append(f"A border of one colour ({sides}) is cut off: {size_text(levels)} pixels are compared.")
    side = block(levels)
    if side > 1:
        levels = levels[::side, ::side]
        notices.append(f"Blocks of {side}x{side} pixels have one colour: {size_text(levels)} of them are compared.")
    if min(levels.shape[:2]) < SMALLEST:
        raise FileError(path, f"has {size_text(levels)} pixels, too few to compare: {SMALLEST}x{SMALLEST} at least")
    return np.ascontiguousarray(levels), tuple(notices), path.suffix.lower() in LOSSY, side


def size_text(levels: Levels) -> str:
    """Return the size of a picture: `640x480`."""
    height, width, _ = levels.shape
    return f"{width}x{height}"


def block(levels: Levels) -> int:
    """Return the side of the blocks of one colour of which a picture consists; 1 if it has none."""
    height, width, _ = levels.shape
    across, down = ((levels[:, 1:] != levels[:, :-1]).any(axis=(0, 2)), (levels[1:] != levels[:-1]).any(axis=(1, 2)))
    columns, rows = np.flatnonzero(across) + 1, np.flatnonzero(down) + 1
    side = int(np.gcd.reduce([*columns, *rows, width, height]))
    return side if side <= LARGEST_BLOCK and len(columns) and len(rows) else 1


def border(levels: Levels) -> tuple[int, int, int, int]:
    """Return the width of a frame that has the colour of the corner, at the left, top, right and bottom; 0 where the
    corner is black, as the background of a scene."""
    corner = levels[0, 0]
    other = (levels != corner).any(axis=-1)
    rows, columns = np.flatnonzero(other.any(axis=1)), np.flatnonzero(other.any(axis=0))
    if not len(rows) or not corner.any():
        return 0, 0, 0, 0
    height, width = other.shape
    return int(columns[0]), int(rows[0]), int(width - 1 - columns[-1]), int(height - 1 - rows[-1])


def distance(one: Levels, other: Levels) -> NDArray[np.int_]:
    """Return the difference of the worst channel of each pixel, in levels."""
    result: NDArray[np.int_] = np.abs(one.astype(int) - other).max(axis=-1)
    return result


def tolerances(is_lossy: bool) -> tuple[int, int]:
    """Return by how many levels pixels of a format differ that are equal, and those that are nearly so."""
    return (EXACT_LOSSY, CLOSE_LOSSY) if is_lossy else (EXACT, CLOSE)


def are_equal(one: Levels, other: Levels, is_lossy: bool) -> bool:
    """Whether all pixels are equal within a level."""
    return bool(distance(one, other).max() <= tolerances(is_lossy)[0])


def are_alike(one: Levels, other: Levels, is_lossy: bool) -> bool:
    """Whether pixels differ by a few levels at most, but at edges."""
    near = edges(other)
    if is_lossy:  # whose blocks spread an edge
        near = np.kron(blocks_with(near), np.ones((BLOCK, BLOCK), bool))[: near.shape[0], : near.shape[1]]
    off = distance(one, other) > tolerances(is_lossy)[1]
    return bool((off & ~near).mean() < STRAY)


def blocks_with(mask: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Whether any pixel of each block of a lossy picture is in a mask; the last blocks may be cut."""
    rows = np.logical_or.reduceat(mask, np.arange(0, mask.shape[0], BLOCK), axis=0)
    found: NDArray[np.bool_] = np.logical_or.reduceat(rows, np.arange(0, mask.shape[1], BLOCK), axis=1)
    return found


def edges(levels: Levels) -> NDArray[np.bool_]:
    """Whether pixels are near an edge: their neighbourhoods have different colours."""
    around = (Image.fromarray(levels).filter(extreme(3)) for extreme in (ImageFilter.MaxFilter, ImageFilter.MinFilter))
    result: NDArray[np.bool_] = np.subtract(*map(np.asarray, around)).max(axis=-1) > EDGE
    return result


def explained(scene: Scene, theirs: Levels, guess: Guess) -> Levels:
    """Return the reference under a guess that is fitted to `theirs`; black where the light of shapes is not known."""
    height, width, _ = theirs.shape
    case = Case(scene, theirs / 255)
    fit = case.fit(guess, LARGE)
    under = np.zeros_like(theirs)
    rows = max(BAND // width, 1)
    for start in range(0, height, rows):
        y, x = np.mgrid[start : min(start + rows, height), 0:width].reshape(2, -1).astype(float)
        seen = see(scene, (width, height), x, y, guess)
        terms = lighting.columns(scene, seen, guess, fit.factors)
        shown = lighting.drawn(terms, seen, guess, fit.factors, fit.sky)
        shown = shown[:, ::-1] if guess["colours"] == "swapped" else shown
        shown[~case.judged[seen.owner]] = 0
        under[start : start + rows] = np.rint(255 * shown).reshape(-1, width, 3)
    return under


def panels(scene: Scene, theirs: Levels, guess: Guess) -> Levels:
    """Put theirs, the reference, the reference under a guess and the difference from theirs beside each other."""
    height, width, _ = theirs.shape
    under = explained(scene, theirs, guess)
    difference = np.minimum(BRIGHTER * np.abs(under.astype(int) - theirs), 255).astype(np.uint8)
    gap = np.full((height, GAP, 3), 255, np.uint8)
    return np.hstack([theirs, gap, render(scene, width, height).array, gap, under, gap, difference])
