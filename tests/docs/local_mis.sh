#!/usr/bin/env bash
# local_mis.sh ACDF MAKE_SKY LOCAL_MIS: docs/examples/local_mis.cpp as its first lines say. With the file, light and
# cosine samples together agree with cosine samples alone and have less noise.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
"$2" "$folder/sky.pfm"
"$1" local "$folder/sky.pfm" --filter bilinear --mis cosine --budget 256KiB -o "$folder/sky.acdf" --quiet
"$3" "$folder/sky.pfm" "$folder/sky.acdf" | tee "$folder/figures.txt"
awk '{ sub(",", "", $(NF - 3)); mean[NR] = $(NF - 3); variance[NR] = $NF }
    END {
        n = 64 * 256
        error = mean[1] * sqrt((variance[1] + variance[2]) / n)
        if (NR != 2 || variance[2] * 2 > variance[1]) { print "no less noise"; exit 1 }
        if ((mean[1] - mean[2]) ^ 2 > (4 * error) ^ 2) { print "the means differ"; exit 1 }
    }' "$folder/figures.txt"
if "$3" "$folder/sky.pfm" "$folder/sky.pfm" 2>/dev/null; then echo "took a picture for a file of acdf local"; exit 1; fi
