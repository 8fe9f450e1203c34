"""Writer of portable float maps (`.pfm`): float32, the lower line first (Debevec)."""

from __future__ import annotations

import numpy as np

LITTLE_ENDIAN = "-1.0"  # the sign tells the order of bytes


def encode(light: np.ndarray) -> bytes:
    """Return the file of light, (h, w, 3)."""
    height, width = light.shape[:2]
    return f"PF\n{width} {height}\n{LITTLE_ENDIAN}\n".encode() + light[::-1].astype("<f4").tobytes()
