#!/usr/bin/env bash
# Writes docs/performance.md: ratios of calls to those of samplers of all texels, and instruction counts of a fixed run.
#
#   tests/bench/run.sh BUILD [WIDTHS...]      BUILD: a release build with -DACDF_BUILD_BENCHMARKS=ON
#
# Needs valgrind for the counts. Best on a machine that does nothing else. Widths: 1024 and 4096; 16384 takes some 6 GiB.
set -euo pipefail

here=$(cd "$(dirname "$0")" && pwd)
build=$(cd "$1" && pwd)
shift
page=$here/../../docs/performance.md
bench=$build/tests/bench/bench_environment
work=$(mktemp -d "${TMPDIR:-/tmp}/acdf-bench-XXXXXX")
trap 'rm -rf "$work"' EXIT

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

"$bench" "$@" >"$work/times"
"$bench" --write "$work/64" $((64 << 10))
"$bench" --write "$work/4" $((4 << 10))
{
    sed '/^<!-- times -->$/q' "$page"
    cat "$work/times"
    printf '\n| instructions a call, 1024 x 512 | draw | density of uniform directions |\n|---|---|---|\n'
    for size in 64 4; do
        printf '| %s KiB | %s | %s |\n' "$size" "$(instructions draw "$work/$size")" "$(instructions pdf "$work/$size")"
        printf '| %s KiB, no tables | %s | %s |\n' "$size" "$(instructions draw "$work/$size" walk)" \
            "$(instructions pdf "$work/$size" walk)"
    done
    echo
    sed -n '/^<!-- end of times -->$/,$p' "$page"
} >"$work/page"
cp "$work/page" "$page"
