"""Writers of light: OpenEXR, Radiance and portable float maps.

OpenEXR pictures (`.exr`) have red, green and blue as float32, scanlines compressed by ZIP, 16 at a time, after the file
layout of openexr.com (version 2, one part): a header of attributes, a table of offsets, blocks of lines.
"""

from __future__ import annotations

import re
import struct
import zlib

import numpy as np

MAGIC, VERSION = 20000630, 2
ZIP, BLOCK_LINES = 3, 16  # number of the compression, and scanlines of a block
FLOAT32 = 2  # type of a channel: float32
LEVEL = 4  # of compression: as OpenEXR itself


def encode_exr(light: np.ndarray) -> bytes:
    """Return the file of light, (h, w, 3) in the order red, green, blue."""
    height, width = light.shape[:2]
    blocks = [exr_block(top, light[top : top + BLOCK_LINES]) for top in range(0, height, BLOCK_LINES)]
    header = exr_header(width, height)
    first = len(header) + 8 * len(blocks)
    offsets = first + np.cumsum([0, *map(len, blocks)])[:-1]
    return b"".join([header, offsets.astype("<u8").tobytes(), *blocks])


def exr_header(width: int, height: int) -> bytes:
    """Return the header of an EXR file of so many pixels, from the magic number to the end of the attributes."""
    channel = struct.pack("<iB3xii", FLOAT32, 0, 1, 1)  # the type, "not linear to perception", a sample for each pixel
    channels = b"".join(name + b"\0" + channel for name in (b"B", b"G", b"R")) + b"\0"
    window = struct.pack("<4i", 0, 0, width - 1, height - 1)
    attributes = (
        ("channels", "chlist", channels),
        ("compression", "compression", bytes([ZIP])),
        ("dataWindow", "box2i", window),
        ("displayWindow", "box2i", window),
        ("lineOrder", "lineOrder", b"\0"),  # the upper line first
        ("pixelAspectRatio", "float", struct.pack("<f", 1)),
        ("screenWindowCenter", "v2f", struct.pack("<2f", 0, 0)),
        ("screenWindowWidth", "float", struct.pack("<f", 1)),
    )
    parts = [f"{name}\0{kind}\0".encode() + struct.pack("<i", len(data)) + data for name, kind, data in attributes]
    return struct.pack("<2i", MAGIC, VERSION) + b"".join(parts) + b"\0"


def exr_block(top: int, light: np.ndarray) -> bytes:
    """Return a block of scanlines (n, w, 3), the first of which is line `top`: each as all of its blue, green, red.

    Bytes are sorted into those of even and odd places, then each is replaced by its difference to the one before.
    """
    raw = light[..., ::-1].astype("<f4").transpose(0, 2, 1).tobytes()
    data = np.frombuffer(raw, np.uint8)
    data = np.concatenate([data[0::2], data[1::2]])
    data[1:] -= data[:-1] - np.uint8(128)  # numpy computes the right side first
    packed = zlib.compress(data.tobytes(), LEVEL)
    if len(packed) >= len(raw):  # a reader takes a block of full length as it is
        packed = raw
    return struct.pack("<2i", top, len(packed)) + packed


# Radiance (`.hdr`): red, green and blue with a common exponent, 8 bits each, runs compressed. After Ward, Real Pixels
# (Graphics Gems II, 1991). A colour's largest channel keeps an error of at most 1/256 of itself.

SHORTEST, LONGEST = 8, 2**15 - 1  # pixels of a scanline that can have runs
SCANLINES = 16  # scanlines that are converted at once
RUN = re.compile(rb"(.)\1{3,126}|(?:(?!(.)\2{3}).){1,128}", re.DOTALL)  # equal bytes, or others up to such a run
BRIGHTEST = 2.0**127 * (255 / 256)


def encode_hdr(light: np.ndarray) -> bytes:
    """Return the file of light, (h, w, 3)."""
    height, width = light.shape[:2]
    header = f"#?RADIANCE\nSOFTWARE=miniRT\nFORMAT=32-bit_rle_rgbe\n\n-Y {height} +X {width}\n".encode()
    pixels = (line for top in range(0, height, SCANLINES) for line in rgbe(light[top : top + SCANLINES]))
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

    def with_count(run: re.Match[bytes]) -> bytes:
        return bytes([128 + len(run[0])]) + run[1] if run[1] else bytes([len(run[0])]) + run[0]

    return RUN.sub(with_count, line.tobytes())


def encode_pfm(light: np.ndarray) -> bytes:
    """Return the portable float map (`.pfm`) of light, (h, w, 3): float32, the lower line first (Debevec)."""
    height, width = light.shape[:2]
    little_endian = "-1.0"  # the sign tells the order of bytes
    return f"PF\n{width} {height}\n{little_endian}\n".encode() + light[::-1].astype("<f4").tobytes()


ENCODERS = {"EXR": encode_exr, "HDR": encode_hdr, "PFM": encode_pfm}
