# Completion in fish: subcommands and options from lineshaft's own help, block types and forms by name.
function __lineshaft_subcommand
    set -l words (commandline -opc)
    test (count $words) -gt 1; and echo $words[2]
end
function __lineshaft_options
    lineshaft (__lineshaft_subcommand) --help 2>/dev/null | string match -rg '^  (?:-.,)?(--[a-z-]+)'
end
complete -c lineshaft -n 'test -z (__lineshaft_subcommand)' -f -a '(lineshaft --help | string match -rg "^  ([a-z]+) ")'
complete -c lineshaft -n 'test -n "(__lineshaft_subcommand)"' -a '(__lineshaft_options)'
complete -c lineshaft -n 'test (__lineshaft_subcommand) = blocks' -f -a '(lineshaft blocks | string match -rg "^(\S+)")'
complete -c lineshaft -n 'test (__lineshaft_subcommand) = form' -f -a '(lineshaft form | string match -rg "^([a-z_]+)")'
