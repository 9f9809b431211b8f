#!/usr/bin/env bash
# Makes the tables of docs/appendix/accuracy-local.md from a folder of probes: docs/make/local_tables.sh PROBES [ACDF]
# TABLES="sizes baselines bins tiles paper" chooses among them.
set -euo pipefail
probes=$1
acdf=${2:-build/release/tools/acdf}
tables=${TABLES:-sizes baselines bins tiles paper}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# name, file, projection
list="city city.exr latlong
sunset sunset.exr latlong
studio studio.exr latlong
courtyard courtyard.exr latlong
noon_grass_1k noon_grass_1k.hdr latlong
grace_probe grace_probe.hdr angular
stpeters_cross stpeters_cross.hdr cube-cross
beach_probe beach_probe.hdr angular"

field() { jq -r ".$2" "$1"; }

# build NAME FILE PROJECTION OPTIONS...: makes $work/NAME.acdf, measures it into $work/NAME.json
build() {
    local name=$1 file=$2 projection=$3
    shift 3
    "$acdf" local "$probes/$file" --projection "$projection" --filter nearest -o "$work/$name.acdf" --force --quiet "$@" > /dev/null
    "$acdf" measure "$work/$name.acdf" --against "$probes/$file" --projection "$projection" --quiet --json ${baselines:+--baselines} \
        > "$work/$name.json"
}

geomean() { awk '{ s += log($1); n++ } END { printf "%.4g", exp(s / n) }'; }

sizes() {
    echo "| probe | full CDF | 64 KiB | 256 KiB | 1 MB | 2 MB | above the horizon at 1 MB: mean, worst normal | full CDF |"
    echo "|---|---|---|---|---|---|---|---|"
    : > "$work/gains"
    while read -r name file projection; do
        line="| $name |"
        for size in 64KiB 256KiB 1MB 2MB; do
            build "$name" "$file" "$projection" --budget $size
            json=$work/$name.json
            [ $size = 64KiB ] && line="$line $(jq -r '.relative_variance_full_cdf*1000|round/1000' "$json") |"
            line="$line $(jq -r '(.relative_variance*1e5|round/1e5|tostring) + " (" + (.gain|round|tostring) + "×)"' "$json") |"
            echo "$size $(field "$json" gain)" >> "$work/gains"
            [ $size = 1MB ] && above="$(jq -r '[.share_above_horizon,.least_share_above_horizon]|map(.*1000|round/10|tostring+" %")|join(", ")' "$json") | $(jq -r '[.share_above_horizon_full_cdf,.least_share_above_horizon_full_cdf]|map(.*1000|round/10|tostring+" %")|join(", ")' "$json") |"
        done
        echo "$line $above"
    done <<< "$list"
    line="| geometric mean of gains | |"
    for size in 64KiB 256KiB 1MB 2MB; do line="$line $(awk -v s=$size '$1 == s { print $2 }' "$work/gains" | geomean)× |"; done
    echo "$line | |"
}

baselines() {
    echo "| probe | ours, 1 MB | full CDF | RIS, 32 candidates | 512 tiles × cosine on the fly | cosine hemisphere |"
    echo "|---|---|---|---|---|---|"
    while read -r name file projection; do
        baselines=1 build "$name" "$file" "$projection" --budget 1MB
        jq -r --arg n "$name" '"| " + $n + " | " + ([.relative_variance, (.baselines | .full_cdf, .resampling_32, .tiling_512, .cosine | .relative_variance)] | map(. * 1e5 | round / 1e5 | tostring) | join(" | ")) + " |"' "$work/$name.json"
    done <<< "$list"
}

# One probe, one option at a time
bins() {
    echo "| \`--normals\` at 1 MB, grace_probe | bins | relative variance | worst normal above the horizon |"
    echo "|---|---|---|---|"
    for n in 6 8 10 12 14 16 20; do
        build grace grace_probe.hdr angular --budget 1MB --normals $n
        jq -r --arg n $n '"| " + $n + " | " + (.bins|tostring) + " | " + (.relative_variance*1e5|round/1e5|tostring) + " | " + (.least_share_above_horizon*1000|round/10|tostring) + " % |"' "$work/grace.json"
    done
}

tiles() {
    echo "| \`--tiles\` at 1 MB, grace_probe | cells in them | relative variance |"
    echo "|---|---|---|"
    for n in 200 400 800 1100 1300 1500; do
        build grace grace_probe.hdr angular --budget 1MB --tiles $n
        jq -r --arg n $n '"| " + $n + " | " + (.cells|tostring) + " | " + (.relative_variance*1e5|round/1e5|tostring) + " |"' "$work/grace.json"
    done
}

paper() {
    echo "| 25×10 bins, a tree each, grace_probe | bytes | relative variance | gain | above the horizon: mean, worst normal | violations |"
    echo "|---|---|---|---|---|---|"
    while read -r text options; do
        # shellcheck disable=SC2086
        build grace grace_probe.hdr angular --no-sharing --normals 25x10 $options
        jq -r --arg t "${text//_/ }" '"| " + $t + " | " + (.bytes|tostring) + " | " + (if .relative_variance then (.relative_variance*1e4|round/1e4|tostring) + " | " + (.gain*10|round/10|tostring) + "×" else "infinite | none" end) + " | " + ([.share_above_horizon,.least_share_above_horizon]|map(.*1000|round/10|tostring+" %")|join(", ")) + " | " + (.support_violations|tostring) + " |"' "$work/grace.json"
    done <<< "cdf,_of_the_centre_(as_published) --fit cdf --knots 128x128 --bin-target centre
cdf,_of_the_bin's_mean --fit cdf --knots 128x128"
    build grace grace_probe.hdr angular --budget 1MB
    jq -r '"| shared, 1 MB, 12 | \(.bytes) | \(.relative_variance*1e4|round/1e4) | \(.gain*10|round/10)× | \([.share_above_horizon,.least_share_above_horizon]|map(.*1000|round/10|tostring+" %")|join(", ")) | \(.support_violations) |"' "$work/grace.json"
}

for table in $tables; do
    $table
    echo
done
