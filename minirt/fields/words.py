"""Field of one word among several."""

from __future__ import annotations

from minirt.errors import FieldError, quoted
from minirt.fields.field import Field
from minirt.records import record


@record(kw_only=True)
class Choice(Field):
    """One of some words; a key press takes the next one, and the first one after the last."""

    words: tuple[str, ...]
    placeholder: str = "word"

    def parse(self, text: str) -> str:
        return text

    def check(self, value: str) -> str:
        if value not in self.words:
            raise FieldError(f"must be {', '.join(self.words[:-1])} or {self.words[-1]}, got {quoted(str(value))}")
        return value

    def nudge(self, value: str, steps: float) -> str:
        if not steps:
            return value
        return self.words[(self.words.index(value) + (1 if steps > 0 else -1)) % len(self.words)]
