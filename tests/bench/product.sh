#!/usr/bin/env bash
# Writes the times of sampling the product into docs/appendix/performance-product.md: tests/bench/product.sh BUILD DATA. BUILD: a release build with
# -DACDF_BUILD_BENCHMARKS=ON; DATA holds probes/ and brdfs/.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
build=$(cd "$1" && pwd)
data=$(cd "$2" && pwd)
work=$(mktemp -d "${TMPDIR:-/tmp}/acdf-bench-XXXXXX")
trap 'rm -rf "$work"' EXIT
"$build/tools/acdf" local "$data/probes/grace_probe.hdr" --projection angular --budget 1MB --shape small -o "$work/light.acdf" --quiet
"$build/tools/acdf" local "$data/probes/grace_probe.hdr" --projection angular --budget 1MB --shape fast -o "$work/fast.acdf" --quiet
"$build/tools/acdf" brdf "$data/brdfs/nickel.binary" --budget 64KiB -o "$work/brdf.acdf" --quiet
for shape in light fast; do # one after the other: they share a core's caches
    "$build/tests/bench/bench_product" "$work/$shape.acdf" "$work/brdf.acdf" >"$work/$shape"
done
{
    echo "| what | ns, small shape | fast shape |"
    echo "|---|---|---|"
    paste -d '|' "$work/light" "$work/fast" | awk -F'|' 'NR > 2 { print "|" $2 "|" $3 "|" $7 "|" }'
} | "$here/../../docs/make/put_table.sh" product
