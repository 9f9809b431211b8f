#!/usr/bin/env bash
# Local files of 1 MiB of other shapes: tests/bench/shapes.sh BUILD DATA. For each number of tiles, and for fewer normals, the relative
# variance on four probes, then the times of bench_local on noon_grass. BUILD: a release build with -DACDF_BUILD_BENCHMARKS=ON.
set -euo pipefail
build=$(cd "$1" && pwd)
data=$(cd "$2" && pwd)
work=$(mktemp -d "${TMPDIR:-/tmp}/acdf-bench-XXXXXX")
trap 'rm -rf "$work"' EXIT
shapes=("--tiles 150" "--tiles 300" "--tiles 600" "--tiles 900" "--tiles 1235" "--tiles 1700" "--normals 8")
printf '| | noon_grass_1k | studio_small_05_1k | venice_sunset_1k | courtyard |\n|---|---|---|---|---|\n'
for shape in "${shapes[@]}"; do
    printf '| `%s` |' "$shape"
    for probe in noon_grass_1k.hdr studio_small_05_1k.hdr venice_sunset_1k.hdr courtyard.exr; do
        file=$work/$probe${shape// /}.acdf
        read -ra options <<<"$shape"
        "$build/tools/acdf" local "$data/probes/$probe" "${options[@]}" --shape small -o "$file" --json --quiet |
            awk '/"relative_variance":/ { printf " %.4f |", $2 }'
    done
    printf '\n'
done
"$build/tests/bench/bench_local" "$work"/noon_grass_1k.hdr--{tiles{150,300,600,900,1235,1700},normals8}.acdf
