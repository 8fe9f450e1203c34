"""Clearer messages for wrong arguments: one line, with the option or value that may be meant."""

from __future__ import annotations

import argparse
import re
from collections.abc import Iterable

UNKNOWN = re.compile(r"unrecognized arguments: (-\S*)")
CHOICE = re.compile(r"argument (?P<option>.*?): invalid choice: '?(?P<value>.*?)'? \(choose from (?P<choices>.*)\)")
NEAR = 0.6  # similarity from which on a word is suggested, from 0 to 1


def clearer(parser: argparse.ArgumentParser, message: str) -> str:
    """Return the message of argparse about wrong arguments, in one line and with a suggestion."""
    if unknown := UNKNOWN.match(message):
        word = unknown[1].partition("=")[0]
        options = [option for action in parser._actions for option in action.option_strings]
        return f"unknown option {word}{suggestion(word, options) or '; miniRT --help lists all'}"
    if choice := CHOICE.fullmatch(message):
        choices = re.sub(r"'", "", choice["choices"])
        hint = suggestion(choice["value"], choices.split(", "))
        return f"argument {choice['option']}: must be {in_words(choices)}, got '{choice['value'][:40]}'{hint}"
    return message.removeprefix("unrecognized arguments: ")


def suggestion(word: str, known: Iterable[str]) -> str:
    """Return `, did you mean --size?`, or '' without a word that is near."""
    from difflib import get_close_matches

    near = get_close_matches(word[:40], list(known), 1, NEAR)
    return f", did you mean {near[0]}?" if near else ""


def in_words(choices: str) -> str:
    """Return `plain, srgb or filmic` for `plain, srgb, filmic`."""
    first, _, last = choices.rpartition(", ")
    return f"{first} or {last}" if first else last
