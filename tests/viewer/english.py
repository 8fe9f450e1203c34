"""The texts of the window in English, as the sources have them, and the list of those that a catalogue lacks."""

from __future__ import annotations

import ast
from collections.abc import Iterator

from minirt.element import Record, fields_of
from minirt.materials import Compound
from minirt.scene.registry import ELEMENTS
from minirt.viewer import language
from minirt.viewer.app.menu import MENU
from minirt.viewer.bindings import BINDINGS, FINE_NOTE
from minirt.viewer.display import tool_row
from minirt.viewer.display.screen import TIPS
from minirt.viewer.editing.values import part_names
from tests.paths import ROOT

try:
    from minirt.viewer.panel.elements import TOOLS
    from minirt.viewer.panel.groups import GROUPS
except ImportError:  # no slimgui, so there is no panel
    TOOLS, GROUPS = {}, ()

# Functions whose texts the window shows.
SAYS = {
    "with_message",
    "say",
    "FieldError",
    "error",
    "FileError",
    "LookupError",
    "translated",
    "option",
    "whole",
    "hint",
}
PARTS = ("viewer", "fields", "materials", "scene")
CATALOGUES = ROOT / "minirt/viewer/locale"
MISSING = "\n# No translation yet, so these stay English; python -m tests.make_tables lists them here.\n"


def templates(node: ast.expr) -> list[str]:
    """Return the texts that an expression can be, with {} in place of what it inserts; none if it is no text."""
    match node:
        case ast.Constant(str() as text):
            return [text]
        case ast.JoinedStr(parts):
            return ["".join(each.value if isinstance(each, ast.Constant) else "{}" for each in parts)]  # type: ignore[misc]
        case ast.IfExp(_, yes, no):
            return templates(yes) + templates(no)
        case ast.BinOp(left, ast.Add(), right):
            return [before + after for before in templates(left) for after in templates(right)]
    return []


def messages(source: str) -> Iterator[str]:
    """Yield the texts that a module gives to a function of SAYS."""
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.Call):
            name = node.func.attr if isinstance(node.func, ast.Attribute) else getattr(node.func, "id", "")
            for argument in node.args if name in SAYS else []:
                yield from (text for text in templates(argument) if any(map(str.isalpha, text.replace("{}", ""))))


def names() -> Iterator[str]:
    """Yield the names of all elements, values and parts of values."""
    kinds: list[type[Record]] = [*ELEMENTS.values()]
    for kind in kinds:
        yield getattr(kind, "title", "")
        for field in fields_of(kind):
            yield from (field.title, field.doc, *part_names(field))
            kinds += [field.record] if isinstance(field, Compound) and field.record not in kinds else []


def english() -> set[str]:
    """All texts of the window that the sources tell of."""
    files = (file for part in PARTS for file in (ROOT / "minirt" / part).rglob("*.py"))
    texts = {text for file in files for text in messages(file.read_text(encoding="utf-8"))}
    texts |= {each.help for each in BINDINGS} | {each.group for each in BINDINGS} | {FINE_NOTE[1]}
    texts |= {*MENU.values()} | {each.name for each in tool_row.TOOLS}
    texts |= {group for line in TIPS.split("\n") for group in line.split(language.GAP)}
    texts |= {*GROUPS, *TOOLS.values()}
    return texts | {name for name in names() if len(name) > 1}


def with_missing(catalogue: str) -> str:
    """The text of a catalogue with what it does not translate listed at its end, with empty translations."""
    translations, _, _ = catalogue.partition(MISSING)
    missing = sorted(english() - set(language.read_po(translations)))
    entries = [f"\nmsgid {quoted(text)}\nmsgstr {quoted('')}\n" for text in missing]
    return "".join([translations, MISSING, *entries]) if entries else translations


def quoted(text: str) -> str:
    """A text as catalogues have it."""
    return '"' + text.replace("\\", r"\\").replace('"', r"\"").replace("\n", r"\n") + '"'
