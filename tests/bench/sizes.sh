#!/usr/bin/env bash
# Writes the times of environment files of several probes and sizes into docs/performance.md: tests/bench/sizes.sh BUILD
# DATA. BUILD: a release build with -DACDF_BUILD_BENCHMARKS=ON; DATA holds probes/. Best on a machine that does nothing else.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
build=$(cd "$1" && pwd)
data=$(cd "$2" && pwd)
work=$(mktemp -d "${TMPDIR:-/tmp}/acdf-bench-XXXXXX")
trap 'rm -rf "$work"' EXIT
for probe in studio.exr studio_small_05_1k.hdr noon_grass_1k.hdr spruit_sunrise_4k.exr; do
    for size in 1KiB 16KiB 64KiB 128KiB 256KiB 1024KiB 4096KiB; do
        "$build/tools/acdf" env "$data/probes/$probe" --domain latlong --budget $size -o "$work/${probe%.*}_$size" --quiet
    done
done
for size in 64KiB 256KiB 1024KiB; do
    "$build/tools/acdf" env "$data/probes/studio.exr" --domain octahedral --budget $size -o "$work/studio_octahedral_$size" --quiet
done
find "$work" -type f -print0 | sort -zV | xargs -0 "$build/tests/bench/bench_environment" --files | "$here/../../docs/make/put_table.sh" sizes
