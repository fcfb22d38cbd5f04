# Completion of lineshaft's command line in bash: subcommands and their options, block types, files,
# and the signals and parameters of the program or trace that the line names.
#   . tools/install/completion.bash        in ~/.bashrc, or copy the file to /etc/bash_completion.d/lineshaft

# Subcommands, as `lineshaft --help` lists them.
_lineshaft_commands() {
    "$1" --help 2>/dev/null | sed -n '/^Subcommands:/,/^$/s/^  \([a-z]\+\) .*/\1/p'
}

# Options of a subcommand, as its help lists them.
_lineshaft_options() {
    "$1" "$2" --help 2>/dev/null | sed -n 's/^  *\(-.,\)\?\(--[a-z-]\+\).*/\2/p'
}

# The first word after the subcommand that ends with $1.
_lineshaft_named() {
    local word
    for word in "${COMP_WORDS[@]:2}"; do
        [[ $word == *"$1" ]] && { echo "${word/#\~\//$HOME/}"; return; }
    done
}

_lineshaft_signals() {
    local program trace
    program=$(_lineshaft_named .yaml)
    trace=$(_lineshaft_named .csv)
    if [ -n "$program" ]; then
        "$1" show --signals "$program" 2>/dev/null | cut -d' ' -f1
    elif [ -n "$trace" ]; then
        head -n 1 -- "$trace" 2>/dev/null | tr ',;' '\n\n' | sed 's/ \[.*//; /^\(time\|scan\)$/d'
    fi
}

_lineshaft_parameters() {
    local program
    program=$(_lineshaft_named .yaml)
    [ -z "$program" ] || sed -n '/^parameters:/,/^[a-z]/s/^  \([A-Za-z_0-9]\+\):.*/\1=/p' "$program" 2>/dev/null
}

# Words from the standard input that continue $1.
_lineshaft_words() {
    mapfile -t COMPREPLY < <(compgen -W "$(cat)" -- "$1")
}

# Folders, and files that end with one of the extensions.
_lineshaft_files() {
    local current=$1 extension
    shift
    compopt -o filenames 2>/dev/null
    mapfile -t COMPREPLY < <(
        compgen -d -- "$current"
        for extension in "$@"; do compgen -f -X "!*.$extension" -- "$current"; done | sort -u
    )
}

# What stands after the last comma of a list of signals.
_lineshaft_list() {
    local before=""
    [[ $2 == *,* ]] && before=${2%,*},
    compopt -o nospace 2>/dev/null
    mapfile -t COMPREPLY < <(compgen -P "$before" -W "$(_lineshaft_signals "$1")" -- "${2##*,}")
}

_lineshaft() {
    local lineshaft=$1 current=$2 before=$3 command=${COMP_WORDS[1]:-}
    COMPREPLY=()
    if [ "$COMP_CWORD" -eq 1 ]; then
        _lineshaft_words "$current" < <(_lineshaft_commands "$lineshaft"; echo --help --version)
        return
    fi
    case $before in
        --signals) [ "$command" != show ] && { _lineshaft_list "$lineshaft" "$current"; return; } ;;
        --path | --command | --actual) _lineshaft_list "$lineshaft" "$current"; return ;;
        --set) compopt -o nospace 2>/dev/null; _lineshaft_words "$current" < <(_lineshaft_parameters); return ;;
        --include-dir | --source) _lineshaft_files "$current" st scl; return ;;
        --coverage) _lineshaft_files "$current" info; return ;;
        --trace | --pulses) _lineshaft_files "$current" csv; return ;;
        --junit) _lineshaft_files "$current" xml; return ;;
        -o | --output) _lineshaft_files "$current" html svg png csv json; return ;;
    esac
    if [[ $current == -* ]]; then
        _lineshaft_words "$current" < <(_lineshaft_options "$lineshaft" "$command")
        return
    fi
    case $command in
        blocks) _lineshaft_words "$current" < <("$lineshaft" blocks 2>/dev/null | cut -d' ' -f1) ;;
        form) _lineshaft_words "$current" < <("$lineshaft" form 2>/dev/null | grep -o "^[a-z_]*") ;;
        plot | plan | diff | verify | contour) _lineshaft_files "$current" csv ;;
        report) _lineshaft_files "$current" csv json ;;
        test) _lineshaft_files "$current" yaml yml st scl ;;
        *) _lineshaft_files "$current" yaml yml ;;
    esac
}

complete -F _lineshaft lineshaft
