#!/usr/bin/env bash
# places.sh DATA [SCENE...]: writes the table of docs/places.md. DATA holds probes/; scenes: hidden-grace and those of
# docs/make/place_scenes.py. ACDF names the program (default:
# build/release/tools/acdf); scenes and pictures are left in RESULTS (default: build/places).
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
data=$(cd "${1:?usage: docs/make/places.sh DATA [SCENE...]}" && pwd)
shift
scenes=${*:-hidden-grace room courtyard car trees}
acdf=${ACDF:-$root/build/release/tools/acdf}
results=${RESULTS:-$root/build/places}
page=$root/docs/places.md
mkdir -p "$results"
python3 "$root/docs/make/place_scenes.py" "$results" > /dev/null
cp "$root/tools/render/scenes/hidden-grace.json" "$results"

table=$results/table.md
{
    echo "| scene | sampler | bytes | less variance than local:1MB | bias, standard errors |"
    echo "|---|---|---|---|---|"
} > "$table"
for scene in $scenes; do
    "$acdf" render --scene "$results/$scene.json" --data "$data" --size 48x36 --samples 16 --seeds 60 --no-timing --force --quiet \
        --sampler local:1MB --sampler places:4MB --sampler cosine --sampler "mis(local:1MB,cosine)" \
        -o "$results/$scene" > /dev/null
    jq -r --arg scene "$scene" '
        def sig: if . == null then "–" else (. * 100 | round / 100 | tostring) end;
        def gain: if . == null then "–" elif .value == null then "–" else "\(.value | sig) (\(.low | sig)–\(.high | sig))" end;
        .samplers[] | "| \($scene) | `\(.sampler)` | \(.bytes) | \(.equal_samples_gain | gain) | \(.bias_standard_errors | sig) |"' \
        "$results/$scene/render.json" >> "$table"
done
awk -v table="$table" '
    /<!-- table -->/ { print; while ((getline line < table) > 0) print line; skip = 1 }
    /<!-- \/table -->/ { skip = 0 }
    !skip' "$page" > "$page.new"
mv "$page.new" "$page"
