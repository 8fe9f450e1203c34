"""Writer of Radiance pictures (`.hdr`): red, green and blue with a common exponent, 8 bits each, runs compressed.

After Ward, Real Pixels (Graphics Gems II, 1991). A colour's largest channel keeps an error of at most 1/256 of itself.
`minirt.materials.radiance` reads such files.
"""

from __future__ import annotations

import numpy as np

SHORTEST, LONGEST = 8, 2**15 - 1  # pixels of a scanline that can have runs
LINES = 16  # scanlines that are converted at once
MIN_RUN, MAX_RUN, MAX_LITERAL = 4, 127, 128
BRIGHTEST = 2.0**127 * (255 / 256)


def encode(light: np.ndarray) -> bytes:
    """Return the file of light, (h, w, 3)."""
    height, width = light.shape[:2]
    header = f"#?RADIANCE\nSOFTWARE=miniRT\nFORMAT=32-bit_rle_rgbe\n\n-Y {height} +X {width}\n".encode()
    pixels = (line for top in range(0, height, LINES) for line in rgbe(light[top : top + LINES]))
    if not SHORTEST <= width <= LONGEST:
        return header + b"".join(line.tobytes() for line in pixels)
    start = bytes([2, 2, width >> 8, width & 255])
    lines = (start + b"".join(runs(line[:, channel]) for channel in range(4)) for line in pixels)
    return header + b"".join(lines)


def rgbe(light: np.ndarray) -> np.ndarray:
    """Return light as mantissas of red, green and blue, in 256ths of 2^(exponent - 128), and the exponent."""
    light = np.clip(light, 0.0, BRIGHTEST)
    _, exponent = np.frexp(light.max(axis=-1))
    mantissa = np.rint(np.ldexp(light, 8 - exponent[..., None]))
    pixels = np.empty((*light.shape[:2], 4), np.uint8)
    pixels[..., :3] = np.minimum(mantissa, 255)
    pixels[..., 3] = exponent + 128
    pixels[(exponent < -127) | (light.max(axis=-1) == 0)] = 0
    return pixels


def runs(line: np.ndarray) -> bytes:
    """Return the bytes of a channel of a scanline: a count above 128 repeats a byte, another copies some bytes."""
    edges = np.flatnonzero(np.diff(line)) + 1
    starts, ends = np.append(0, edges), np.append(edges, len(line))
    long = ends - starts >= MIN_RUN
    out, done, data = bytearray(), 0, line.tobytes()
    for start, end in zip(starts[long].tolist(), ends[long].tolist(), strict=True):
        copy(out, data[done:start])
        for at in range(start, end, MAX_RUN):
            out += bytes([128 + min(MAX_RUN, end - at), data[start]])
        done = end
    copy(out, data[done:])
    return bytes(out)


def copy(out: bytearray, data: bytes) -> None:
    """Append bytes as they are, with the counts that announce them."""
    for at in range(0, len(data), MAX_LITERAL):
        part = data[at : at + MAX_LITERAL]
        out.append(len(part))
        out += part
