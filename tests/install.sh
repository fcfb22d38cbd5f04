#!/usr/bin/env bash
# What is installed runs alone and finds its controllers: install.sh BUILD
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cmake --install "$1" --prefix "$folder/usr" >/dev/null
cd "$folder"
PATH=$folder/usr/bin:$PATH
lineshaft --version | grep "^lineshaft [0-9.]* (.*)$" >/dev/null
lineshaft new first --quiet
lineshaft test --strict first.yaml
lineshaft check --strict "$folder"/usr/share/lineshaft/programs/0*.yaml
port=$(/usr/bin/python3 -c 'import socket; s = socket.socket(); s.bind(("127.0.0.1", 0)); print(s.getsockname()[1])')
lineshaft serve first.yaml --http "127.0.0.1:$port" --for 0.1s >/dev/null
if lineshaft new first; then echo "a second 'new' replaced the file"; exit 1; fi

program() { printf 'lineshaft: 1\ncontroller: %s\nblocks: {n: {type: ctu, task: main, cu: inputs.part, pv: 3}}\ninputs: {part: false}\nrun: {for: 1 s}\n' "$1"; }
program s7_1515 >named.yaml
lineshaft show named.yaml | grep "^task servo: every .* ms" >/dev/null
mkdir -p config
printf 'lineshaft_controller: 1\ntasks: {main: {every: 7 ms}}\n' >config/s7_1515.yaml
lineshaft show named.yaml | grep "^task main: every 7 ms" >/dev/null
grep -q "MC_MoveAbsolute\|Subcommands\|lineshaft run" usr/share/man/man1/lineshaft.1
bash -c '. usr/share/bash-completion/completions/lineshaft && complete -p lineshaft' >/dev/null
cmp usr/share/lineshaft/config/program.schema.json <(lineshaft schema)
echo ok
