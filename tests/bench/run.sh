#!/usr/bin/env bash
# Writes docs/appendix/performance-environment.md, performance-brdf.md and performance-table.md: ratios of calls to those of other samplers, and
# instruction counts of a fixed run.
#
#   tests/bench/run.sh BUILD [WIDTHS...]      BUILD: a release build with -DACDF_BUILD_BENCHMARKS=ON
#
# Needs valgrind for the counts, and the measured BRDFs of ACDF_TEST_DATA. Best on a machine that does nothing else. Widths: 1024
# and 4096; 16384 takes some 6 GiB. Where the variable ACDF_TEST_DATA names a folder with probes/ and brdfs/, local files and
# products are timed too (tests/bench/local.sh, tests/bench/product.sh).
set -euo pipefail

here=$(cd "$(dirname "$0")" && pwd)
build=$(cd "$1" && pwd)
shift
work=$(mktemp -d "${TMPDIR:-/tmp}/acdf-bench-XXXXXX")
trap 'rm -rf "$work"' EXIT

. "$here/instructions.sh"
put=$here/../../docs/make/put_table.sh

"$build/tests/bench/bench_environment" "$@" | "$put" times

"$build/tests/bench/bench_brdf" >"$work/times"
"$build/tests/bench/bench_brdf" --write "$work/128" 128
{
    cat "$work/times"
    printf '\n| instructions a call, 128 KiB | sample | pdf |\n|---|---|---|\n'
    for walk in '' walk; do
        printf '| %s | %s | %s |\n' "${walk:+no }tables" "$(instructions bench_brdf sample "$work/128" $walk)" \
            "$(instructions bench_brdf pdf "$work/128" $walk)"
    done
} | "$put" brdf

"$build/tests/bench/bench_table" | "$put" table

if [ -n "${ACDF_TEST_DATA:-}" ]; then
    "$here/local.sh" "$build" "$ACDF_TEST_DATA"
    "$here/product.sh" "$build" "$ACDF_TEST_DATA"
fi
