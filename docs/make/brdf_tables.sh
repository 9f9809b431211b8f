#!/usr/bin/env bash
# Makes the BRDF table of docs/appendix/accuracy-brdf.md from a folder of BRDFs: docs/make/brdf_tables.sh BRDFS [ACDF]
set -euo pipefail
brdfs=$1
acdf=${2:-build/release/tools/acdf}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# row TEXT FILE OPTIONS...
row() {
    local text=$1 file=$2
    shift 2
    "$acdf" brdf "$brdfs/$file" -o "$work/file.acdf" --force --quiet "$@" > /dev/null
    "$acdf" measure "$work/file.acdf" --against "$brdfs/$file" --quiet --json |
        jq -r --arg t "$text" --arg f "${file%.*}" '"| " + $f + " | " + $t + " | " + (.bytes | tostring) + " | " +
            ([.relative_variance, .relative_variance_worst] | map(. * 1e5 | round / 1e5 | tostring) | join(" | ")) + " | " +
            (.relative_variance_full_cdf * 1e5 | round / 1e5 | tostring) + " | " + (.support_violations | tostring) + " |"'
}

echo "| BRDF | fit | bytes | variance, mean over views | worst view | 65 MiB table, mean over views | violations |"
echo "|---|---|---|---|---|---|---|"
for file in nickel.binary blue-metallic-paint.binary; do
    for size in 16KiB 32KiB 64KiB 200KiB; do row "variance, $size" $file --budget $size; done
    row "cdf, 32 bins, knots 10x30" $file --fit cdf --views 32 --knots 10x30
    row "cdf, 32x16 bins, knots 10x30 (as published)" $file --fit cdf --views 32x16 --knots 10x30
done
for file in cc_ibiza_sunset_rgb satin_rosaline_rgb paper_white_rgb cg_sunflower_rgb; do
    for size in 64KiB 200KiB; do row "variance, $size" $file.bsdf --budget $size; done
done
