#!/usr/bin/env bash
# partner_tables.sh DATA [SIZE [SEEDS]]: the tables of docs/appendix/accuracy-mis.md about two samples a point, of the light and of the
# cosine, in the scene of hidden-grace.json. DATA holds probes/. ACDF names the program (default: build/release/tools/acdf).
# Maps are resized to 256 x 128 by oiiotool: the ideal rows look at every texel at every point.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
data=$(cd "${1:?usage: docs/make/partner_tables.sh DATA [SIZE [SEEDS]]}" && pwd)
size=${2:-16x12}
seeds=${3:-256}
acdf=${ACDF:-$root/build/release/tools/acdf}
probes=${PROBES:-venice_sunset_1k.hdr city.exr noon_grass_1k.hdr}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

samplers=("full-cdf" "mis(full-cdf,cosine)" "mis-compensated" "mis(env:64KiB,cosine)" "mis(env:64KiB --mis mean,cosine)"
    "mis(env:64KiB --mis cosine,cosine)" "mis(env:64KiB --mis cosine --scene,cosine)" "mis(ideal,cosine)"
    "mis(ideal --mis cosine,cosine)" "mis(local:1MB,cosine)" "mis(local:1MB --mis cosine,cosine)" "local:1MB"
    "mis-power(mis-compensated)" "mis-power(local:1MB,cosine)" "mis-power(local:1MB --mis cosine,cosine)"
    "mis-power(local:1MB --mis cosine --heuristic power,cosine)")
samplers=("${samplers[@]/mis-power(mis-compensated)/mis-power(compensated,cosine)}")

for probe in $probes; do
    oiiotool "$data/probes/$probe" --ch R,G,B --resize:filter=box 256x128 -d float -o "$work/$probe.exr" > /dev/null
    jq --arg probe "$probe.exr" '.light = {probe: $probe} | .samples = 2 | del(."$schema")' \
        "$root/tools/render/scenes/hidden-grace.json" > "$work/$probe.json"
    arguments=()
    for sampler in "${samplers[@]}"; do arguments+=(--sampler "$sampler"); done
    "$acdf" render --scene "$work/$probe.json" --data "$work" -o "$work/$probe" --size "$size" --seeds "$seeds" \
        --no-timing --quiet "${arguments[@]}" > /dev/null
done

# table KEY: relative variance of an estimate of two samples, mean over pixels, of all probes.
table() {
    echo "| two samples a point, $2 |$(for probe in $probes; do printf ' %s |' "${probe%%.*}"; done)"
    echo "|---|$(for probe in $probes; do printf -- '---|'; done)"
    for i in "${!samplers[@]}"; do
        line="| \`${samplers[$i]}\` |"
        for probe in $probes; do
            line="$line $(jq -r --argjson i "$i" "$1"' | .samplers[$i].relative_variance | .value | . * 1e4 | round / 1e4' "$work/$probe/render.json") |"
        done
        echo "$line"
    done
    echo
}
table ".nothing_hidden" "nothing hidden"
table "." "behind the wall"
