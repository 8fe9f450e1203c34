"""Program of the helper process: decode the pictures that come by standard input, one after the other."""

from __future__ import annotations

import os
import sys
from contextlib import suppress
from importlib import import_module

from minirt.jail import decoder, stand_ins
from minirt.jail.confinement import confine
from minirt.jail.decoder import Decoded, DecodingError
from minirt.jail.messages import REQUEST, pack_answer

# Modules that Pillow imports only when a file needs them, or that know one format.
DECODERS = ("Png", "Jpeg", "Mpo", "Gif", "Bmp", "Tiff", "Ppm", "Tga", "WebP")
MODULES = ("copy", "PIL.ImagePalette", *(f"PIL.{each}ImagePlugin" for each in DECODERS))


def main() -> None:
    """Answer requests until standard input ends."""
    try:
        load_decoders()
    except Exception:  # a version of Pillow needs the real modules
        stand_ins.remove()
        for name in [each for each in sys.modules if each.split(".")[0] == "PIL"]:
            del sys.modules[name]
        load_decoders()
    stand_ins.remove()
    words = collect_standard_error()
    confine()
    while request := sys.stdin.buffer.read(REQUEST.size):
        answer_to(sys.stdin.buffer.read(*REQUEST.unpack(request)), words)


def load_decoders() -> None:
    """Import the modules of Pillow that formats need: there are no files later."""
    for module in MODULES:
        with suppress(ImportError):  # another version of Pillow may lack one
            import_module(module)


def answer_to(data: bytes, words: int) -> None:
    """Write the pixels of a file to standard output, or the reason why it has none."""
    answer: Decoded | DecodingError
    try:
        answer = decoder.decode(data)
    except DecodingError as error:
        answer = error
    for part in pack_answer(answer, silent=not said_anything(words)):
        sys.stdout.buffer.write(part)
    sys.stdout.buffer.flush()


def collect_standard_error() -> int:
    """Send standard error, where decoders in C complain, into a pipe that nobody waits for; return its end to read."""
    words, standard_error = os.pipe()
    for end in (words, standard_error):
        os.set_blocking(end, False)
    os.dup2(standard_error, sys.stderr.fileno())
    return words


def said_anything(words: int) -> bool:
    """Whether decoders have written to standard error since the last call."""
    try:
        return bool(os.read(words, 2**20))
    except BlockingIOError:
        return False
