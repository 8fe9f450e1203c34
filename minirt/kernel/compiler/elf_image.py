"""Turns object code into an image: bytes to copy into memory, and a list of the addresses in them to relocate.

The format is ELF for x86-64 (System V ABI, AMD64 supplement). Code of a kernel refers to nothing but its own constants,
so there is no need for a linker; code that refers to anything else is refused.
"""

from __future__ import annotations

import struct
from typing import Any, NamedTuple

SECTION_TABLE = struct.Struct("<Q")  # at 0x28 in the header of the file: offset of the table of sections
SECTION_COUNT = struct.Struct("<HH")  # at 0x3A: bytes of an entry of this table, number of entries
SYMBOL = struct.Struct("<IBBHQQ")  # name, type, visibility, section, offset in it, size
RELOCATION = struct.Struct("<QQq")  # offset of an address, symbol << 32 | type, what is added to the symbol's address
CONTENTS, SYMBOLS, RELOCATIONS = 1, 2, 4  # types of sections
IN_MEMORY = 2  # flag of sections
ABSOLUTE = 1  # R_X86_64_64: an address of 64 bits


class Section(NamedTuple):
    """An entry of the table of sections."""

    name: int
    kind: int
    flags: int
    address: int
    offset: int
    size: int
    link: int
    info: int
    alignment: int
    entry_size: int


SECTION = struct.Struct("<IIQQQQIIQQ")


def image_of(code: bytes, entry: str) -> tuple[dict[str, Any], bytes]:
    """Return the image of object code, and the offsets of its entry point and of its relocations.

    Each relocation is an offset in the image, and the offset whose address belongs there. ValueError where the code
    refers to something outside of itself.
    """
    sections = read_sections(code)
    image, places = bytearray(), dict[int, int]()
    for number, section in enumerate(sections):
        if section.flags & IN_MEMORY and section.size:
            if section.kind != CONTENTS:
                raise ValueError(f"a section of type {section.kind}")
            image += bytes(-len(image) % section.alignment)
            places[number] = len(image)
            image += contents(code, section)
    symbols = read_symbols(code, sections)
    relocations = [
        (places[section.info] + offset, place_of(symbols[symbol >> 32], places) + addend)
        for section in sections
        if section.kind == RELOCATIONS and section.info in places
        for offset, symbol, addend in RELOCATION.iter_unpack(contents(code, section))
        if is_absolute(symbol & 0xFFFFFFFF)
    ]
    (start,) = (place_of(each, places) for each in symbols if name_of(code, sections, each) == entry)
    return {"entry": start, "relocations": relocations}, bytes(image)


def read_sections(code: bytes) -> list[Section]:
    """Return the table of sections of an ELF file of 64 bits."""
    if code[:5] != b"\x7fELF\x02":
        raise ValueError("no ELF file of 64 bits")
    (table,) = SECTION_TABLE.unpack_from(code, 0x28)
    size, count = SECTION_COUNT.unpack_from(code, 0x3A)
    return [Section(*SECTION.unpack_from(code, table + size * i)) for i in range(count)]


def contents(code: bytes, section: Section) -> bytes:
    """Return the bytes of a section."""
    return code[section.offset : section.offset + section.size]


def read_symbols(code: bytes, sections: list[Section]) -> list[tuple[int, ...]]:
    """Return the entries of the table of symbols."""
    (table,) = (each for each in sections if each.kind == SYMBOLS)
    return list(SYMBOL.iter_unpack(contents(code, table)))


def place_of(symbol: tuple[int, ...], places: dict[int, int]) -> int:
    """Return the offset of a symbol in the image; ValueError where it is not in it."""
    _, _, _, section, offset, _ = symbol
    if section not in places:
        raise ValueError("a reference to something outside of the code")
    return places[section] + offset


def is_absolute(kind: int) -> bool:
    """Whether a relocation is of the one type that is known; ValueError for others."""
    if kind != ABSOLUTE:
        raise ValueError(f"a relocation of type {kind}")
    return True


def name_of(code: bytes, sections: list[Section], symbol: tuple[int, ...]) -> str:
    """Return the name of a symbol."""
    (table,) = (each for each in sections if each.kind == SYMBOLS)
    start = sections[table.link].offset + symbol[0]
    return code[start : code.index(b"\0", start)].decode()
