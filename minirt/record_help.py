"""Help on records: signature and documentation, made from the declared fields when somebody asks for them."""

from __future__ import annotations

import re
import sys
from dataclasses import MISSING, fields, is_dataclass
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from inspect import Signature

MODULE = re.compile(r"\bminirt(\.[a-z_]+)*\.")  # before the name of a class
STUBS = ("A line `",)  # beginnings of the texts of classes whose module is their manual page


class FieldSignature:
    """Descriptor of `__signature__`, by which `help` and notebooks show the fields of a record."""

    def __get__(self, instance: object, kind: type[Any]) -> Signature:
        from inspect import Parameter, Signature

        if not is_dataclass(kind):
            raise AttributeError("__signature__")  # of a base class of records
        parameters = [
            Parameter(
                each.name,
                Parameter.KEYWORD_ONLY if each.kw_only else Parameter.POSITIONAL_OR_KEYWORD,
                default=Parameter.empty if each.default is MISSING else each.default,
                annotation=each.type,
            )
            for each in sorted(fields(kind), key=lambda each: bool(each.kw_only))
        ]
        return Signature(parameters)


class FieldDocumentation:
    """Descriptor of `__doc__`, which `help` shows: the text of a class, and the declared fields of a record.

    Classes whose own text refers to their line of a scene file or their value show the manual page of their module.
    """

    def __init__(self, text: str) -> None:
        self.text = text

    def __get__(self, instance: object, kind: type[Any]) -> str:
        from inspect import cleandoc

        declared = [each for each in fields(kind) if "field" in each.metadata] if is_dataclass(kind) else []
        if not declared:
            return self.text
        text = sys.modules[kind.__module__].__doc__ if self.text.startswith(STUBS) else self.text
        lines = [cleandoc(text or ""), "", "Fields; a value out of range is a ValueError:", ""]
        for each in sorted(declared, key=lambda each: bool(each.kw_only)):
            kind_of_value = MODULE.sub("", str(getattr(each.type, "__name__", each.type)))
            lines += [f"- `{each.name}: {kind_of_value}`: {facts(each)}"]
        return "\n".join(lines)


def facts(attribute: Any) -> str:
    """Return the meaning, unit, range and default of a declared field."""
    field, default = attribute.metadata["field"], attribute.default
    optional = "" if default is MISSING else "absent by default" if default is None else f"default {default!r}"
    return "; ".join(part for part in (field.doc, field.unit, field.range, optional) if part)
