#!/usr/bin/env bash
# Writes the times of local files into docs/appendix/performance-local.md: tests/bench/local.sh BUILD DATA. BUILD: a release build with
# -DACDF_BUILD_BENCHMARKS=ON; DATA holds probes/. Needs valgrind. Best on a machine that does nothing else.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
build=$(cd "$1" && pwd)
data=$(cd "$2" && pwd)
work=$(mktemp -d "${TMPDIR:-/tmp}/acdf-bench-XXXXXX")
trap 'rm -rf "$work"' EXIT
local_file() { "$build/tools/acdf" local "$data/probes/$1" "${@:3}" -o "$work/$2.acdf" --quiet; }
local_file noon_grass_1k.hdr small --budget 128KiB
local_file noon_grass_1k.hdr large
local_file noon_grass_1k.hdr octahedral --domain octahedral
local_file spruit_sunrise_4k.exr wide

. "$here/instructions.sh"
{
    "$build/tests/bench/bench_local" "$work"/{small,large,octahedral,wide}.acdf
    printf '\n| instructions, 1 MiB, noon_grass | shading point | sample | pdf |\n|---|---|---|---|\n'
    for how in tables walk; do
        if [ $how = walk ]; then options=(walk); else options=(); fi
        printf '| %s' "$([ $how = tables ] && echo tables || echo 'no tables')"
        for what in point draw pdf; do printf ' | %s' "$(instructions bench_local $what "$work/large.acdf" "${options[@]}")"; done
        printf ' |\n'
    done
} | "$here/../../docs/make/put_table.sh" local
