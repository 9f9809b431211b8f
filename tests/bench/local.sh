#!/usr/bin/env bash
# Writes the times of local files into docs/performance.md: tests/bench/local.sh BUILD DATA. BUILD: a release build with
# -DACDF_BUILD_BENCHMARKS=ON; DATA holds probes/. Needs valgrind. Best on a machine that does nothing else.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
build=$(cd "$1" && pwd)
data=$(cd "$2" && pwd)
page=$here/../../docs/performance.md
bench=$build/tests/bench/bench_local
work=$(mktemp -d "${TMPDIR:-/tmp}/acdf-bench-XXXXXX")
trap 'rm -rf "$work"' EXIT
local_file() { "$build/tools/acdf" local "$data/probes/$1" "${@:3}" -o "$work/$2.acdf" --quiet; }
local_file noon_grass_1k.hdr small --budget 128KiB
local_file noon_grass_1k.hdr large
local_file noon_grass_1k.hdr octahedral --domain octahedral
local_file spruit_sunrise_4k.exr wide

# instructions WHAT FILE [walk]: of one call, from two runs that differ by 100000 of them.
instructions() {
    local what=$1 file=$2 counts=() n
    shift 2
    for n in 1000 101000; do
        valgrind --tool=callgrind --callgrind-out-file=/dev/null "$bench" --count "$what" "$file" "$n" "$@" 2>"$work/log"
        counts+=("$(sed -n 's/.*Collected : //p' "$work/log")")
    done
    echo $(((counts[1] - counts[0]) / 100000))
}

{
    "$bench" "$work"/{small,large,octahedral,wide}.acdf
    printf '\n| instructions, 1 MiB, noon_grass | shading point | and a draw | and a density |\n|---|---|---|---|\n'
    for how in tables walk; do
        if [ $how = walk ]; then options=(walk); else options=(); fi
        printf '| by %s' $how
        for what in point draw pdf; do printf ' | %s' "$(instructions $what "$work/large.acdf" "${options[@]}")"; done
        printf ' |\n'
    done
} >"$work/table"
awk -v table="$work/table" '
    $0 == "<!-- local -->" { print; while ((getline line < table) > 0) print line; print ""; inside = 1; next }
    $0 == "<!-- /local -->" { inside = 0 }
    !inside { print }' "$page" >"$work/page"
cp "$work/page" "$page"
