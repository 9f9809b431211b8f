#!/usr/bin/env bash
# Writes what docs/performance.md says of environment files and BRDFs: ratios of calls to those of other samplers, and
# instruction counts of a fixed run.
#
#   tests/bench/run.sh BUILD [WIDTHS...]      BUILD: a release build with -DACDF_BUILD_BENCHMARKS=ON
#
# Needs valgrind for the counts, and the measured BRDFs of ACDF_TEST_DATA. Best on a machine that does nothing else. Widths: 1024 and 4096; 16384 takes some 6 GiB.
# Local files are timed by tests/bench/local.sh.
set -euo pipefail

here=$(cd "$(dirname "$0")" && pwd)
build=$(cd "$1" && pwd)
shift
page=$here/../../docs/performance.md
work=$(mktemp -d "${TMPDIR:-/tmp}/acdf-bench-XXXXXX")
trap 'rm -rf "$work"' EXIT

# instructions PROGRAM WHAT FILE [walk]: of one call, from two runs that differ by 100000 of them.
instructions() {
    local bench=$build/tests/bench/$1 what=$2 file=$3 counts=() n
    shift 3
    for n in 1000 101000; do
        valgrind --tool=callgrind --callgrind-out-file=/dev/null "$bench" --count "$what" "$file" "$n" "$@" 2>"$work/log"
        counts+=("$(sed -n 's/.*Collected : //p' "$work/log")")
    done
    echo $(((counts[1] - counts[0]) / 100000))
}

# replace NAME: what is between <!-- NAME --> and <!-- end of NAME --> becomes the standard input.
replace() {
    {
        sed "/^<!-- $1 -->$/q" "$page"
        cat
        echo
        sed -n "/^<!-- end of $1 -->$/,\$p" "$page"
    } >"$work/page"
    cp "$work/page" "$page"
}

"$build/tests/bench/bench_environment" "$@" >"$work/times"
"$build/tests/bench/bench_environment" --write "$work/64" $((64 << 10))
"$build/tests/bench/bench_environment" --write "$work/4" $((4 << 10))
{
    cat "$work/times"
    printf '\n| instructions a call, 1024 x 512 | draw | density of uniform directions |\n|---|---|---|\n'
    for size in 64 4; do
        for walk in '' walk; do
            printf '| %s KiB%s | %s | %s |\n' "$size" "${walk:+, no tables}" \
                "$(instructions bench_environment draw "$work/$size" $walk)" \
                "$(instructions bench_environment pdf "$work/$size" $walk)"
        done
    done
} >"$work/environment"
replace times <"$work/environment"

"$build/tests/bench/bench_brdf" >"$work/times"
"$build/tests/bench/bench_brdf" --write "$work/128" 128
{
    cat "$work/times"
    printf '\n| instructions a call, 128 KiB | sample | pdf |\n|---|---|---|\n'
    for walk in '' walk; do
        printf '| tables%s | %s | %s |\n' "${walk:+ left out}" "$(instructions bench_brdf sample "$work/128" $walk)" \
            "$(instructions bench_brdf pdf "$work/128" $walk)"
    done
} >"$work/brdf"
replace brdf <"$work/brdf"
