"""Compare a picture with a reference picture of the same scene."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

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
    """Check that at most `share` of the pixels is off, and only at edges."""
    wrong = off(picture, reference)
    inside = int((wrong & ~edges(reference)).sum())
    assert not inside, f"{name}: {wrong.sum()} pixels are off, {inside} of them at no edge"
    assert wrong.mean() < share, f"{name}: {wrong.sum()} pixels are off"
