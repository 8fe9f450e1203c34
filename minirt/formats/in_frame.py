"""Pillow images in the memory of a frame buffer, without a copy: Pillow's own have 4 bytes a pixel.

`minirt.image.rgb_in_place` leaves a picture in the first three quarters of its frame buffer. Here its pixels move
apart, to 4 bytes each, which fills the frame buffer again.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from PIL.Image import Image as PillowImage

BLOCK = 2**16  # pixels that are moved at once: a quarter of the time of 2**18, which no cache holds
OPAQUE = np.uint32(0xFF000000)  # the fourth byte, as in Pillow's own images


def levels_in_frame(height: int, width: int) -> np.ndarray:
    """Return memory for a picture (height, width, 3), with as much behind as `in_frame` needs.

    The system gives memory when it is first written to, so what lies behind costs nothing until then.
    """
    return np.empty((height, width, 4), np.uint8).reshape(-1)[: 3 * height * width].reshape(height, width, 3)


def in_frame(array: np.ndarray) -> PillowImage | None:
    """Return the Pillow image of a picture (h, w, 3) uint8 in the memory of its frame buffer, which overwrites the
    picture; None where it does not begin a frame buffer."""
    from PIL import Image as pillow  # noqa: N813

    frame = frame_of(array)
    if frame is None:
        return None
    size = frame.shape[1], frame.shape[0]
    mapped = pillow.fromarrow(pillow.frombuffer("RGBX", size, frame, "raw", "RGBX", 0, 1), "RGB", size)
    spread(frame)
    return mapped


def frame_of(array: np.ndarray) -> np.ndarray | None:
    """Return the frame buffer (h, w, 4) uint8 that begins with a picture; None where there is none."""
    memory = array.base
    if not (isinstance(memory, np.ndarray) and array.dtype == memory.dtype == np.uint8 and array.size):
        return None
    if not (array.flags.c_contiguous and memory.flags.c_contiguous and memory.flags.writeable):
        return None
    height, width = array.shape[:2]
    needed = 4 * height * width
    if memory.ctypes.data != array.ctypes.data or memory.size < needed:
        return None
    return memory.reshape(-1)[:needed].reshape(height, width, 4)


def spread(frame: np.ndarray) -> None:
    """Move the RGB pixels in the first three quarters of a frame buffer (h, w, 4) to 4 bytes each.

    Block after block from the last, each copied first, because a block's new place overlaps its old one, but none
    before. Reading 4 bytes at each third byte takes a third of the time of reading channel after channel.
    """
    memory = frame.reshape(-1)
    count = len(memory) // 4
    copy = np.empty(3 * BLOCK + 1, np.uint8)  # the last pixel's 4 bytes end one behind its 3
    for start in reversed(range(0, count, BLOCK)):
        pixels = min(BLOCK, count - start)
        copy[: 3 * pixels] = memory[3 * start : 3 * (start + pixels)]
        words: np.ndarray = np.ndarray((pixels,), "<u4", copy.data, 0, (3,))
        np.bitwise_or(words, OPAQUE, out=memory[4 * start : 4 * (start + pixels)].view("<u4"))
