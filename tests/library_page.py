"""The reference of the library for minirt/LIBRARY.md, made of the docstrings of its public names."""

from __future__ import annotations

import inspect
import re
from collections.abc import Iterator
from functools import cached_property
from typing import Any

import minirt

RESULTS = ("Image", "Outcome", "Hits", "Buffers", "Comparison", "Scene")
FIELD = re.compile(r"^    (\w+): .*?  # (.*)$", re.MULTILINE)  # of a class, with its comment
MEMBERS = (property, cached_property, classmethod)


def library_reference() -> str:
    """Return the public functions with their docstrings, the results with their members, and all other names."""
    public = {name: named(name) for name in minirt.public_names()}
    functions = {name: value for name, value in public.items() if inspect.isfunction(value)}
    classes = {name: value for name, value in public.items() if inspect.isclass(value) and name not in RESULTS}
    errors = {name: value for name, value in classes.items() if issubclass(value, BaseException)}
    others = {name: value for name, value in classes.items() if name not in errors}
    return "\n".join(
        [
            *("## Functions\n", *map(function_entry, functions, functions.values())),
            *("## Results\n", *(result_entry(name, public[name]) for name in RESULTS)),
            *("## Errors\n", *table("error", errors)),
            *("## Elements, materials and further classes\n", *table("class", others)),
        ]
    )


def named(name: str) -> Any:
    """Return what a public name stands for; a package that is called as a function is that function."""
    value = getattr(minirt, name)
    return getattr(value, name) if inspect.ismodule(value) else value


def function_entry(name: str, function: Any) -> str:
    """Return the heading, the signature without types, and the docstring of a function."""
    return f"### {name}\n\n`minirt.{name}{signature(function)}`\n\n{inspect.getdoc(function)}\n"


def signature(function: Any) -> str:
    """Return a signature without types; a default that has no short form is three dots."""
    found = inspect.signature(function)
    plain = [each.replace(annotation=each.empty) for each in found.parameters.values()]
    short = [each.replace(default=...) if inspect.isfunction(each.default) else each for each in plain]
    return str(found.replace(parameters=short, return_annotation=found.empty)).replace("Ellipsis", "...")


def result_entry(name: str, kind: Any) -> str:
    """Return the heading, the docstring and the members of a class whose objects functions return."""
    rows = [f"| `{member}` | {about} |" for member, about in members(kind)]
    return "\n".join([f"### {name}\n\n{inspect.getdoc(kind)}\n", "| member | |", "|---|---|", *rows, ""])


def members(kind: Any) -> Iterator[tuple[str, str]]:
    """Yield the fields of a class with their comments, and its properties and methods with their first paragraphs."""
    ours = [each for each in reversed(kind.__mro__) if each.__module__.startswith("minirt.")]
    yield from (field for each in ours for field in FIELD.findall(inspect.getsource(each)))
    for each in ours:
        for name, member in vars(each).items():
            is_method = inspect.isfunction(member)
            about = first_paragraph(getattr(member, "__func__", member))
            if not name.startswith("_") and about and (is_method or isinstance(member, MEMBERS)):
                yield name + "()" * (is_method or isinstance(member, classmethod)), about


def table(title: str, classes: dict[str, Any]) -> list[str]:
    """Return a table of classes with the first paragraphs of their docstrings."""
    rows = [f"| `{name}` | {first_paragraph(kind)} |" for name, kind in classes.items()]
    return [f"| {title} | |", "|---|---|", *rows, ""]


def first_paragraph(thing: Any) -> str:
    """Return the first paragraph of a docstring in one line."""
    return " ".join((inspect.getdoc(thing) or "").split("\n\n")[0].split()).replace("|", "\\|")
