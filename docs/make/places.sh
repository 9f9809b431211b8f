#!/usr/bin/env bash
# places.sh DATA: writes the table of docs/places.md. DATA holds probes/. ACDF names the program (default:
# build/release/tools/acdf); scenes and pictures are left in RESULTS (default: build/places).
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
data=$(cd "${1:?usage: docs/make/places.sh DATA}" && pwd)
acdf=${ACDF:-$root/build/release/tools/acdf}
results=${RESULTS:-$root/build/places}
page=$root/docs/places.md
mkdir -p "$results"
python3 "$root/docs/make/place_scenes.py" "$results" > /dev/null
cp "$root/tools/render/scenes/hidden-grace.json" "$results"

table=$results/table.md
{
    echo "| scene | sampler | bytes | less variance than local:1MB | at equal time | bias, standard errors |"
    echo "|---|---|---|---|---|---|"
} > "$table"
for scene in hidden-grace room courtyard car trees; do
    "$acdf" render --scene "$results/$scene.json" --data "$data" --size 64x48 --samples 16 --seeds 12 --force --quiet \
        --sampler local:1MB --sampler places:4MB --sampler full-cdf --sampler cosine --sampler "mis(local:1MB,cosine)" \
        --sampler ris:32 -o "$results/$scene" > /dev/null
    jq -r --arg scene "$scene" '
        def sig: if . == null then "–" else (. * 100 | round / 100 | tostring) end;
        def gain: if . == null then "–" elif .value == null then "–" else "\(.value | sig) (\(.low | sig)–\(.high | sig))" end;
        .samplers[] | "| \($scene) | `\(.sampler)` | \(.bytes) | \(.equal_samples_gain | gain) | \(.equal_time_gain | gain) | \(.bias_standard_errors | sig) |"' \
        "$results/$scene/render.json" >> "$table"
done
awk -v table="$table" '
    /<!-- table -->/ { print; while ((getline line < table) > 0) print line; skip = 1 }
    /<!-- \/table -->/ { skip = 0 }
    !skip' "$page" > "$page.new"
mv "$page.new" "$page"
