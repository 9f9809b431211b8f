#!/usr/bin/env bash
# product_tables.sh DATA: writes the table of parts of docs/product.md from the program's output.
# DATA holds probes/ and brdfs/. ACDF names the program (default: build/release/tools/acdf). Takes some minutes.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
data=$(cd "${1:?usage: docs/make/product_tables.sh DATA}" && pwd)
acdf=${ACDF:-$root/build/release/tools/acdf}
page=$root/docs/product.md
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

counts=(4 16 100)
parts=(1 8 16 32 64 96)
for samples in "${counts[@]}"; do
    options=(--sampler 'mis(local:1MB,brdf:64KiB)')
    for n in "${parts[@]}"; do options+=(--sampler "product:$n(local:1MB,brdf:64KiB)"); done
    for scene in cook-torrance nickel plastic; do
        "$acdf" render --scene "$root/tools/render/scenes/e6-$scene.json" --data "$data" --size 16x16 --samples "$samples" \
            --no-reference "${options[@]}" -o "$work/out" --force --quiet --json > "$work/$scene-$samples.json"
    done
done
{
    echo "| parts | $(printf '%s samples | ' "${counts[@]}")"
    echo "|---|$(printf -- '---|%.0s' "${counts[@]}")"
    for i in "${!parts[@]}"; do
        printf '| %s |' "${parts[$i]}"
        for samples in "${counts[@]}"; do
            jq -rs --argjson i $((i + 1)) 'def mean: (map(log) | add / length | exp * 100 | round / 100);
                " \([.[].samplers[$i].equal_samples_gain.value] | mean) / \([.[].samplers[$i].equal_time_gain.value] | mean) |"' \
                "$work"/*-"$samples".json | tr -d '\n'
        done
        echo
    done
} > "$work/table"
awk -v table="$work/table" '
    $0 == "<!-- parts -->" { print; while ((getline line < table) > 0) print line; inside = 1; next }
    $0 == "<!-- /parts -->" { inside = 0 }
    !inside { print }' "$page" > "$work/page"
cat "$work/page" > "$page"
