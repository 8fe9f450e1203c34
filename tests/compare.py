"""Compare a picture with a reference picture of the same scene."""

from __future__ import annotations

import tempfile
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from minirt.rendering.image import Image

Bytes = NDArray[np.uint8]  # (h, w, 3)


def edges(picture: Bytes, step: int = 8) -> NDArray[np.bool_]:
    """Return a mask of the pixels that differ from a neighbour by more than `step`: outlines and edges of shadows."""
    padded = np.pad(picture.astype(int), ((1, 1), (1, 1), (0, 0)), mode="edge")
    height, width, _ = picture.shape
    around = [padded[i : i + height, j : j + width] for i in range(3) for j in range(3)]
    return np.abs(np.array(around) - picture).max(axis=(0, 3)) > step


def off(picture: Bytes, reference: Bytes) -> NDArray[np.bool_]:
    """Return a mask of the pixels that differ by more than 1 of 255."""
    return np.abs(picture.astype(int) - reference).max(axis=-1) > 1


def assert_alike(name: str, picture: Bytes, reference: Bytes, share: float = 1e-3) -> None:
    """Check that at most `share` of the pixels is off, and only at edges; a failure leaves its pictures in a folder."""
    wrong = off(picture, reference)
    if wrong.mean() < share and not (wrong & ~edges(reference)).any():
        return
    folder = Path(tempfile.mkdtemp(prefix="minirt-golden-"))
    difference = np.clip(np.abs(picture.astype(int) - reference) * 16, 0, 255).astype(np.uint8)
    for part, pixels in (("picture", picture), ("reference", reference), ("difference", difference)):
        Image(np.ascontiguousarray(pixels)).save(folder / f"{name}-{part}.png")
    inside = int((wrong & ~edges(reference)).sum())
    raise AssertionError(f"{name}: {wrong.sum()} pixels are off, {inside} of them at no edge; see {folder}")
