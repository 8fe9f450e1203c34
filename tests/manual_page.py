"""Manual page of the program, `man miniRT`, made from the parser of its arguments."""

from __future__ import annotations

import argparse

from minirt.cli.arguments import argument_parser
from tests.paths import ROOT

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
    return f".TP\n{names}{escaped(value)}\n{escaped(about[:1].upper() + about[1:].rstrip('.'))}.\n"


def escaped(text: str) -> str:
    """Return a text in which nothing is a macro of roff."""
    return text.replace("\\", r"\e").replace("-", r"\-").replace("'", r"\(aq")
