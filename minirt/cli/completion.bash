_miniRT() {
    local word="${COMP_WORDS[COMP_CWORD]}" before="${COMP_WORDS[COMP_CWORD-1]}"
    case "$before" in
CASES
    esac
    if [[ "$word" == -* ]]; then
        COMPREPLY=($(compgen -W OPTIONS -- "$word"))
    else
        COMPREPLY=($(compgen -f -X '!*.@(rt|png)' -- "$word") $(compgen -d -- "$word"))
    fi
}
shopt -s extglob 2>/dev/null
complete -o filenames -F _miniRT miniRT
