#!/usr/bin/env bash
# What bash would offer: completion.sh LINESHAFT PROJECT
set -uo pipefail
lineshaft=$1
cd "$2" || exit 1
. tools/install/completion.bash
failed=0

# offers WANTED LINE...: the completion of the last word of LINE holds WANTED (not, with a leading !).
offers() {
    local wanted=$1 found=no
    shift
    COMP_WORDS=(lineshaft "$@")
    COMP_CWORD=$#
    _lineshaft "$lineshaft" "${COMP_WORDS[$COMP_CWORD]}" "${COMP_WORDS[$((COMP_CWORD - 1))]}"
    grep -qxF -- "${wanted#!}" < <(printf '%s\n' "${COMPREPLY[@]}") && found=yes
    [[ $wanted == !* ]] && expected=no || expected=yes
    [ "$found" = "$expected" ] && return
    echo "lineshaft $*: '${wanted#!}' offered: $found; offers: ${COMPREPLY[*]}"
    failed=1
}

offers report re
offers !run re
offers --version --
offers --trace run --tr
offers --dot show --
offers !--dot run --
offers servo_drive blocks se
offers trigger form tr
offers functions form fu
offers programs/03_ratio_change.yaml run programs/03
offers programs/paper run programs/p
offers !programs/README.md run programs/R
offers slave.position report x.csv programs/03_ratio_change.yaml --signals slave.p
offers slave.position,shaft.velocity plot programs/03_ratio_change.yaml --signals slave.position,shaft.v
offers radius= run programs/paper/wei2025_circle.yaml --set ra
offers !speed= run programs/paper/wei2025_circle.yaml --set ra

trace=$(mktemp --suffix=.csv)
echo 'time,scan,axis.position [mm],axis.done' >"$trace"
offers axis.position report "$trace" --signals axis.p
offers !time report "$trace" --signals t
offers axis.done,axis.position contour "$trace" --actual axis.done,axis.p
offers "$trace" contour "${trace%.csv}"
rm -f "$trace"
[ $failed -eq 0 ] && echo "all completions are right"
exit $failed
