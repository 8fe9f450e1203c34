"""Completion of arguments in shells: `eval "$(miniRT --completion bash)"`.

The scripts are made from the parser, so that they know every option and its choices.
"""

from __future__ import annotations

import argparse
import shlex

BASH = """_miniRT() {{
    local word="${{COMP_WORDS[COMP_CWORD]}}" before="${{COMP_WORDS[COMP_CWORD-1]}}"
    case "$before" in
{cases}
    esac
    if [[ "$word" == -* ]]; then
        COMPREPLY=($(compgen -W {options} -- "$word"))
    else
        COMPREPLY=($(compgen -f -X '!*.@(rt|png)' -- "$word") $(compgen -d -- "$word"))
    fi
}}
shopt -s extglob 2>/dev/null
complete -o filenames -F _miniRT miniRT
"""
ZSH = "autoload -Uz bashcompinit && bashcompinit && setopt KSH_GLOB\n"
ANY_VALUE = "return"  # leaves a value to the user
FILES = {"output", "fallback", "replay", "report", "config"}  # options whose value is a path


def completion(parser: argparse.ArgumentParser, shell: str) -> str:
    """Return the script for bash, zsh or fish."""
    actions = [action for action in parser._actions if action.option_strings]
    if shell == "fish":
        return "\n".join(fish_line(action) for action in actions) + "\n" + FISH_SCENES
    script = BASH.format(
        cases="\n".join(bash_case(action) for action in actions if action.nargs != 0),
        options=shlex.quote(" ".join(option for action in actions for option in action.option_strings)),
    )
    return (ZSH if shell == "zsh" else "") + script.rstrip("\n")


def bash_case(action: argparse.Action) -> str:
    """Return the case of an option that takes a value."""
    options = "|".join(action.option_strings)
    if action.choices:
        words = shlex.quote(" ".join(map(str, action.choices)))
        return f'        {options}) COMPREPLY=($(compgen -W {words} -- "$word")); return ;;'
    if action.dest in FILES:
        return f'        {options}) COMPREPLY=($(compgen -f -- "$word")); return ;;'
    return f"        {options}) {ANY_VALUE} ;;"


FISH_SCENES = "complete -c miniRT -k -xa '(__fish_complete_suffix .rt .png)'"


def fish_line(action: argparse.Action) -> str:
    """Return the line for an option."""
    names = [f"-s {name[1:]}" if len(name) == 2 else f"-l {name[2:]}" for name in action.option_strings]
    value = "" if action.nargs == 0 else "-r" if action.dest in FILES else "-x"
    if action.choices:
        value += " -a " + shlex.quote(" ".join(map(str, action.choices)))
    about = (action.help or "").replace("%%", "%").partition(";")[0]
    return " ".join(["complete -c miniRT", *names, value, "-d", "'" + about.replace("'", "\\'") + "'"])
