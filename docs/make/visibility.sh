#!/usr/bin/env bash
# visibility.sh DATA [SCENE...]: writes the tables of docs/appendix/visibility.md: of sums at points, and of pictures of
# 16 x 12 pixels; and the summary of both in docs/visibility.md. DATA holds probes/; scenes: hidden-grace and those of
# docs/make/visibility_scenes.py. BENCH names the program (default: build/release/tests/bench/bench_visibility, of a build with
# -DACDF_BUILD_BENCHMARKS=ON); POINTS is how many of those that the camera sees are asked (default: 1000). Files are left in
# RESULTS (default: build/visibility), and used where they are there. A file takes minutes, and so do 1000 points.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
data=$(cd "${1:?usage: docs/make/visibility.sh DATA [SCENE...]}" && pwd)
shift
scenes=${*:-hidden-grace room courtyard car trees}
bench=${BENCH:-$root/build/release/tests/bench/bench_visibility}
results=${RESULTS:-$root/build/visibility}
mkdir -p "$results"
python3 "$root/docs/make/visibility_scenes.py" "$results" > /dev/null
cp "$root/tools/render/scenes/hidden-grace.json" "$results"

table=$results/table.md
{
    echo "| scene | sampler | bytes | relative variance | gain over local | z, all points | RMS z | points with \\|z\\| > 4 | lost |"
    echo "|---|---|---|---|---|---|---|---|---|"
} > "$table"
for scene in $scenes; do
    for kind in "local 1000000" "visibility 4000000"; do
        read -r name bytes <<< "$kind"
        file=$results/$scene-$name.acdf
        [ -e "$file" ] || "$bench" make "$results/$scene.json" "$data" "$name" "$bytes" "$file"
    done
    local=file:$results/$scene-local.acdf visibility=file:$results/$scene-visibility.acdf
    samplers=("$local" "$visibility" "mis($local,cosine)" tiles:32x16 visibility-cache:32x16)
    if grep -q '"portals"' "$results/$scene.json"; then
        for bytes in 1 4; do
            file=$results/$scene-portals$bytes.acdf
            [ -e "$file" ] || "$bench" make "$results/$scene.json" "$data" portals "${bytes}000000" "$file"
            samplers+=("file:$file")
        done
        samplers+=(portals portals:uniform "mis(portals,cosine)")
    fi
    "$bench" measure "$results/$scene.json" "$data" "${POINTS:-1000}" "${samplers[@]}" |
        sed "s/^/| $scene /; s|$local|local:1MB|; s|$visibility|visibility:4MB|; s|file:.*-portals\([14]\).acdf|visibility-portals:\1MB|" >> "$table"
done
"$root/docs/make/put_table.sh" visibility < "$table"

acdf=${ACDF:-$root/build/release/tools/acdf}
{
    echo "| scene | sampler | gain over local, equal samples | gain, equal time | z of the mean |"
    echo "|---|---|---|---|---|"
    for scene in $scenes; do
        local=file:$results/$scene-local.acdf visibility=file:$results/$scene-visibility.acdf
        samplers=("$local" "$visibility" tiles:32x16 visibility-cache:32x16 ris:32 "mis($visibility,cosine)")
        grep -q '"portals"' "$results/$scene.json" &&
            samplers+=("file:$results/$scene-portals4.acdf" portals portals:uniform "mis(portals,cosine)")
        options=()
        for sampler in "${samplers[@]}"; do options+=(--sampler "$sampler"); done
        "$acdf" render --scene "$results/$scene.json" --data "$data" --size 16x12 --samples 16 --seeds 64 --sequence independent --quiet \
            --force -o "$results/$scene-pictures" "${options[@]}" > /dev/null
        jq -r --arg scene "$scene" 'def short: tostring | .[0:5]; .samplers[] |
            "| \($scene) | `\(.sampler)` | \(if .resolved then (.equal_samples_gain.value | short) else "unsure" end) | " +
            "\(if .resolved then (.equal_time_gain.value | short) else "unsure" end) | \(.bias_standard_errors | short) |"' \
            "$results/$scene-pictures/render.json" |
            sed "s|$local|local:1MB|; s|$visibility|visibility:4MB|; s|file:.*-portals4.acdf|visibility-portals:4MB|"
    done
} > "$results/pictures.md"
"$root/docs/make/put_table.sh" visibility_pictures < "$results/pictures.md"

# Gains of both tables, of the files of 4 MB alone.
"$root/docs/make/visibility_summary.sh" "$table" "$results/pictures.md" | "$root/docs/make/put_table.sh" visibility_summary
