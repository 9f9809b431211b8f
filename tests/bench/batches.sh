#!/usr/bin/env bash
# Writes the times of batches into docs/appendix/performance-batch.md: tests/bench/batches.sh BUILD DATA. BUILD: a release build with
# -DACDF_BUILD_BENCHMARKS=ON and Google Highway; DATA holds probes/ and brdfs/. Best on a machine that does nothing else.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
build=$(cd "$1" && pwd)
data=$(cd "$2" && pwd)
work=$(mktemp -d "${TMPDIR:-/tmp}/acdf-bench-XXXXXX")
trap 'rm -rf "$work"' EXIT
make_file() { "$build/tools/acdf" "$1" "$data/$2" "${@:4}" -o "$work/$3.acdf" --quiet; }
make_file env probes/noon_grass_1k.hdr noon_grass_1k
make_file env probes/spruit_sunrise_4k.exr spruit_sunrise_4k
make_file env probes/noon_grass_1k.hdr noon_grass_1k_octahedral --domain octahedral
make_file local probes/city.exr city
make_file local probes/noon_grass_1k.hdr noon_grass_1k_local
make_file brdf brdfs/nickel.binary nickel
make_file brdf brdfs/satin_rosaline_rgb.bsdf satin_rosaline
"$build/tests/bench/bench_batch" "$work"/{noon_grass_1k,spruit_sunrise_4k,noon_grass_1k_octahedral,city,noon_grass_1k_local,nickel,satin_rosaline}.acdf |
    "$here/../../docs/make/put_table.sh" batch
