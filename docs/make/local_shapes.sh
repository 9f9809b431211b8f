#!/usr/bin/env bash
# local_shapes.sh DATA [ACDF]: prints the table of docs/appendix/local-shapes.md, the mean relative variance of local files
# of each shape.
set -euo pipefail
data=$1
acdf=${2:-build/release/tools/acdf}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# variance PROBE SIZE SHAPE
variance() {
    "$acdf" local "$1" -o "$work/out.acdf" --budget "$2" --shape "$3" --filter nearest --force --quiet --json 2>/dev/null |
        jq .relative_variance
}

echo "| mean relative variance | 1 MiB, halvings | small, ratio | 128 KiB, halvings | small, ratio |"
echo "|---|---|---|---|---|"
for name in noon_grass_1k.hdr studio_small_05_1k.hdr venice_sunset_1k.hdr courtyard.exr sunset.exr city.exr; do
    line="| ${name%.*} |"
    for size in 1MiB 128KiB; do
        least=$(variance "$data/probes/$name" $size halvings)
        line+=$(awk -v v="$least" 'BEGIN { printf " %.4f |", v }')
        line+=$(awk -v v="$(variance "$data/probes/$name" $size small)" -v of="$least" 'BEGIN { printf " %.4f, %.2f |", v, v / of }')
    done
    echo "$line"
done
