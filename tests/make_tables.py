"""Write the generated parts of the documentation anew: python -m tests.make_tables

A table stands between `<!-- table: NAME -->` and `<!-- end -->` of a page. The text for package indexes stands in
pyproject.toml; the manual page and the stubs for type checkers are files of their own. The catalogues of translations
end with a list of what they lack.
"""

from __future__ import annotations

import argparse
import re
from collections.abc import Callable
from functools import partial
from pathlib import Path

from minirt.cli.arguments import argument_parser
from minirt.element import Element, fields_of
from minirt.fields import Field
from minirt.materials import Compound
from minirt.scene.registry import ELEMENTS
from minirt.shapes.shape import Shape
from minirt.viewer.bindings import BINDINGS, FINE_NOTE
from tests.library_page import library_reference
from tests.pages import PAGES, block, name, read
from tests.paths import ROOT
from tests.test_imports import MAY
from tests.typed.stubs import stubs
from tests.viewer.english import CATALOGUES, with_missing

# Left out of the diagram, as small.
HELPERS = {"errors", "records", "helpers", "formats", "image", "movie", "__main__"}
PLACE = re.compile(r"(<!-- table: (\w+) -->\n).*?(<!-- end -->)", re.DOTALL)
INDEX_TEXT = re.compile(r"^(text = '''\n).*?^(''')$", re.MULTILINE | re.DOTALL)


def reachable(part: str) -> set[str]:
    """All parts that a part may import, itself or by way of others."""
    return MAY[part].union(*map(reachable, MAY[part]))


def diagram() -> str:
    """Imports of the parts as a Mermaid diagram, without arrows that follow from others."""
    lines = ["```mermaid", "graph TD"]
    for part in MAY:
        below = reachable(part) - HELPERS
        implied = set().union(*map(reachable, below))
        if part not in HELPERS:
            lines += [f"    {node(part)} --> {node(other)}" for other in MAY if other in below - implied]
    return "\n".join([*lines, "```"])


def node(part: str) -> str:
    """A part in the diagram."""
    return "library[__init__]" if part == "__init__" else part


# The tables of the page about the scene format, from the fields of the elements.

SUBJECT = [kind for kind in ELEMENTS.values() if kind.code in ("A", "C", "L", "sp", "pl", "cy")]
FURTHER = [kind for kind in ELEMENTS.values() if kind not in SUBJECT]
# Ranges that the page states before the tables: of positions, lengths, components, colours, shares and turns.
USUAL = {f"[{ends}]" for ends in ("-1e+15, 1e+15", "1e-50, 1e+15", "0, 1e+15", "-1, 1", "0, 255", "0, 1", "-360, 360")}


def element_table(kinds: list[type[Element]]) -> str:
    """Return a Markdown table of elements and their fields, without attributes."""
    return "\n".join(["| line | element | fields |", "|---|---|---|", *map(element_row, kinds)])


def element_row(kind: type[Element]) -> str:
    """Return the table row of an element; one with the fields of another says so."""
    own = [field for field in fields_of(kind) if not field.keyed]
    line = " ".join([kind.code, *(field.notation if field.required else f"[{field.notation}]" for field in own)])
    same = next((f"those of `{base.code}`" for base in SUBJECT if issubclass(kind, base) and kind is not base), "")
    entries = same or "; ".join(filter(None, map(field_entry, own)))
    return f"| `{line}` | {name_and_count(kind)} | {entries} |"


def name_and_count(kind: type[Element]) -> str:
    """Return an element's name with how many a scene may have, or with the aliases of its identifier."""
    if kind.once:
        return f"{kind.title}, {'exactly one' if kind.required else 'at most one'}"
    return f"{kind.title} (also {', '.join(f'`{alias}`' for alias in kind.aliases)})" if kind.aliases else kind.title


def attribute_table() -> str:
    """Return the Markdown table of all attributes: those of shapes, then those of cameras and lights."""
    rows: dict[tuple[str, str], dict[str, None]] = {}
    for kind in sorted(ELEMENTS.values(), key=lambda kind: not issubclass(kind, Shape)):
        for field in fields_of(kind):
            if field.keyed:
                owners = rows.setdefault((field.notation, attribute_meaning(field)), {})
                owners[field.sort or f"`{kind.code}`"] = None
    lines, above = ["| attribute | of | meaning |", "|---|---|---|"], [""]
    for (notation, text), owners in rows.items():
        entries = text.split("; ")
        shown = [*entries[:-2], "the rest as above"] if entries[-2:] == above[-2:] else entries
        lines.append(f"| `{notation}` | {' '.join(owners)} | {'; '.join(shown)} |")
        above = entries
    return "\n".join(lines)


def attribute_meaning(field: Field) -> str:
    """Return the meaning of an attribute and of the parts of its value, and what its key alone stands for."""
    parts = fields_of(field.record) if isinstance(field, Compound) else ()
    fields = (each for kind in ELEMENTS.values() for each in fields_of(kind) if each.name == field.name)
    alone = ", ".join(dict.fromkeys(f"`{each.keyword}:{each.bare}`" for each in fields if each.bare))
    return "; ".join([meaning(field), *map(field_entry, parts), *([f"alone: {alone}"] if alone else [])])


def field_entry(field: Field) -> str:
    """Return a field's name and meaning; nothing where the name says all."""
    name, text = field.placeholder or field.notation, meaning(field)
    return f"`{name}` {text.removeprefix(f'{name} ')}" if text else ""


def meaning(field: Field) -> str:
    """Return a field's meaning, its range where that is unusual, and its default."""
    doc = "" if field.doc in (field.notation, "colour") else field.doc
    low, _, high = field.range.strip("[]").partition(", ")
    limits = f"from {low} to {high}" if high and field.range not in USUAL else ""
    has_default = field.default is not None and field.default is not False
    default = f"default {field.format(field.default)}" if has_default else ""
    return ", ".join(filter(None, (doc, limits, field.unit.partition(", ")[2], default)))


def keys_markdown() -> str:
    """Return the table of keys, in Markdown."""
    lines = ["| action | keys | AZERTY |", "|---|---|---|"]
    for binding in BINDINGS:
        azerty = f"`{binding.azerty}`" if binding.azerty else ""
        lines.append(f"| {binding.help} | {' '.join(f'`{key}`' for key in binding.keys)} | {azerty} |")
    lines.append(f"| {FINE_NOTE[1]} | `{FINE_NOTE[0]}` | |")
    return "\n".join(lines) + "\n"


TABLES: dict[str, Callable[[], str]] = {
    "keys": keys_markdown,
    "subject": partial(element_table, SUBJECT),
    "further": partial(element_table, FURTHER),
    "attributes": attribute_table,
    "diagram": diagram,
    "library": library_reference,
}


def renewed(page: str) -> str:
    """The text of a page with its tables as the program generates them."""
    return PLACE.sub(lambda place: f"{place[1]}\n{TABLES[place[2]]().strip()}\n\n{place[3]}", page)


def index_text() -> str:
    """README.md as package indexes show it: the introduction and the Python example, without links and pictures.

    The project has no public address to which links and pictures could lead.
    """
    introduction = read("README.md").partition("## Install")[0].strip().split("\n\n")
    shown = [each for each in introduction if "](" not in each and not each.startswith("(")]
    return "\n\n".join([*shown, "## In Python", f"```python\n{block('README.md', 'python', 'minirt.load')}```\n"])


# The manual page, `man miniRT`, made from the parser of the program's arguments.

PAGE = ROOT / "minirt" / "cli" / "miniRT.1"
HEAD = r""".\" Written by python -m tests.make_tables
.TH MINIRT 1
.SH NAME
miniRT \- interactive ray tracer for .rt scene files
.SH SYNOPSIS
.B miniRT
.RI [ options ]
.I SCENE.rt
\&...
.SH DESCRIPTION
Without
.B \-o
the scene is shown in a window, where keys and mouse edit it; the key H shows all keys. With
.B \-o
it is rendered to a file. A scene may also be a PNG picture that carries its scene, or \- for standard input.
"""
TAIL = r""".SH EXIT STATUS
0 for success, 1 for an error in a scene, in rendering or in writing, 2 for wrong arguments, 130 after Ctrl+C,
128 + n after the signal n.
.SH FILES
.TP
.I ~/.config/minirt/config.toml
Defaults of options by their long names, in TOML, such as
.BR "samples = 4" .
.SH EXAMPLES
.TP
.B miniRT scene.rt
Show a scene in a window.
.TP
.B miniRT scene.rt \-o out.png \-\-size 1920x1080 \-\-samples auto
Render a picture with as many samples as it needs.
.TP
.B miniRT scenes/*.rt \-o out/{name}.jpg
Render several scenes.
.TP
.B miniRT scene.rt \-\-turntable 100 \-o spin.mp4
Render a film.
"""


def manual_page() -> str:
    """Return the source of the manual page, in the macros of man."""
    parser = argument_parser()
    parts = [HEAD]
    for group in parser._action_groups:
        actions = [action for action in group._group_actions if action.option_strings]
        if actions:
            parts += [f".SH {(group.title or '').upper()}\n", *map(entry, actions)]
    return "".join(parts) + TAIL


def entry(action: argparse.Action) -> str:
    """Return the entry of an option: its names, its value and its help."""
    value = ""
    if action.nargs != 0:
        value = f" {action.metavar or '{' + ','.join(map(str, action.choices or ())) + '}'}"
    names = ", ".join(rf"\fB{escaped(name)}\fR" for name in action.option_strings)
    about = (action.help or "").replace("%%", "%")
    about = about[:1].upper() + about[1:] + ("" if about.endswith(".") else ".")
    return f".TP\n{names}{escaped(value)}\n{escaped(about)}\n"


def escaped(text: str) -> str:
    """Return a text in which nothing is a macro of roff."""
    return text.replace("\\", r"\e").replace("-", r"\-").replace("'", r"\(aq")


def write(path: Path, text: str) -> None:
    """Write a file if its text has changed, and print its name."""
    if not path.exists() or path.read_text(encoding="utf-8") != text:
        path.write_text(text, encoding="utf-8")
        print(path.relative_to(ROOT))


def main() -> None:
    """Write every file whose generated parts have changed."""
    for page in PAGES:
        write(page, renewed(read(name(page))))
    write(
        ROOT / "pyproject.toml",
        INDEX_TEXT.sub(lambda place: f"{place[1]}{index_text()}{place[2]}", read("pyproject.toml")),
    )
    write(PAGE, manual_page())
    for path, text in stubs().items():
        write(path, text)
    for path in CATALOGUES.glob("*.po"):
        write(path, with_missing(path.read_text(encoding="utf-8")))


if __name__ == "__main__":
    main()
