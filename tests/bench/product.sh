#!/usr/bin/env bash
# Writes the times of sampling the product into docs/appendix/performance-product.md: tests/bench/product.sh BUILD DATA. BUILD: a release build with
# -DACDF_BUILD_BENCHMARKS=ON; DATA holds probes/ and brdfs/.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
build=$(cd "$1" && pwd)
data=$(cd "$2" && pwd)
work=$(mktemp -d "${TMPDIR:-/tmp}/acdf-bench-XXXXXX")
trap 'rm -rf "$work"' EXIT
"$build/tools/acdf" local "$data/probes/grace_probe.hdr" --projection angular --budget 1MB -o "$work/light.acdf" --quiet
"$build/tools/acdf" brdf "$data/brdfs/nickel.binary" --budget 64KiB -o "$work/brdf.acdf" --quiet
"$build/tests/bench/bench_product" "$work/light.acdf" "$work/brdf.acdf" | "$here/../../docs/make/put_table.sh" product
