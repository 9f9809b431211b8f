#!/usr/bin/env bash
# method_tables.sh PROBES: tables of environment files (docs/appendix/accuracy-environment.md, performance-building.md), from the
# probes in a folder, as Markdown on stdout.
# ACDF names the program (default: build/release/tools/acdf). TABLES chooses some of: fits sizes filters options ratio building. The last
# needs oiiotool, for maps of other sizes.
set -euo pipefail
probes=${1:?usage: docs/make/method_tables.sh PROBES}
build=$(dirname "${BASH_SOURCE[0]}")/../../build/release
acdf=${ACDF:-$build/tools/acdf}
tables=${TABLES:-fits sizes filters options ratio building}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# field KEY ARGUMENTS...: one number of the report of `acdf env ARGUMENTS`.
field() {
    local key=$1
    shift
    "$acdf" env "$@" -o "$work/x.acdf" --force --quiet --json | sed -n "s/^  \"$key\": \([0-9.e+-]*\),*$/\1/p"
}
row() { # LABEL ARGUMENTS...: relative variances for each set of options in `columns`
    local label=$1 options
    shift
    printf '| %s' "$label"
    for options in "${columns[@]}"; do
        # shellcheck disable=SC2086 # options are several words
        printf ' | %.3g' "$(field relative_variance "$@" $options)"
    done
    printf ' |\n'
}

six=(city.exr sunset.exr studio.exr courtyard.exr noon_grass_1k.hdr venice_sunset_1k.hdr)

fits() {
    echo "| probe | uniform | cdf | cdf, eq. 4 as printed | cdf, 16 gradient knots | pdf | variance |"
    echo "|---|---|---|---|---|---|---|"
    columns=("--fit uniform" "--fit cdf --order z" "--fit cdf --order z --conditional mean" "--fit cdf --order z --gradient 16"
        "--fit pdf" "--cells 4096")
    for probe in city sunset studio courtyard; do row "$probe" "$probes/$probe.exr" --filter nearest; done
}

sizes() {
    echo "| probe | 4 KiB | 16 KiB | 64 KiB | 256 KiB | 64 KiB, weights below 3 | 64 KiB, zlib |"
    echo "|---|---|---|---|---|---|---|"
    columns=("--budget 4KiB" "--budget 16KiB" "--budget 64KiB" "--budget 256KiB" "--budget 64KiB --max-weight 3"
        "--budget 64KiB --compress zlib")
    for probe in "${six[@]}"; do row "${probe%.*}" "$probes/$probe" --filter nearest; done
}

# What files of 64 KiB for either lookup have under either; "biased" where the pdf is 0 in directions with light.
filters() {
    echo "| probe | nearest lookup: file for it | bilinear file | bilinear lookup: file for it | nearest file |"
    echo "|---|---|---|---|---|"
    for probe in "${six[@]}"; do
        printf '| %s' "${probe%.*}"
        for lookup in nearest bilinear; do
            for made in "$lookup" "$([ $lookup = nearest ] && echo bilinear || echo nearest)"; do
                "$acdf" env "$probes/$probe" --filter "$made" -o "$work/x.acdf" --force --quiet
                { "$acdf" measure "$work/x.acdf" --against "$probes/$probe" --filter "$lookup" --quiet --json 2>/dev/null || :; } |
                    jq -r 'if .relative_variance then .relative_variance else "biased" end' |
                    awk '{ printf $1 == "biased" ? " | %s" : " | %.3g", $1 }'
            done
        done
        printf ' |\n'
    done
}

# One row for each option of `acdf env`: what it does to a file of one probe. Seconds are of the processor, over all
# threads, the reading of the probe and the exact measurement included.
options() {
    local map=$probes/courtyard.exr arguments numbers filter TIMEFORMAT='%U %S'
    echo "| \`acdf env courtyard.exr --filter nearest\` with | bytes | cells | relative variance | largest weight | seconds |"
    echo "|---|---|---|---|---|---|"
    while read -r arguments; do
        case $arguments in *--filter*) filter="" ;; *) filter="--filter nearest" ;; esac
        # shellcheck disable=SC2086
        { time "$acdf" env "$map" $filter $arguments -o "$work/x.acdf" --force --quiet --json >"$work/report"; } 2>"$work/time"
        numbers=$(for key in bytes cells relative_variance max_weight; do
            sed -n "s/^  \"$key\": \([0-9.e+-]*\),*$/\1/p" "$work/report"
        done)
        # shellcheck disable=SC2086
        printf '| %s | %d | %d | %.4g | %.3g | %.2f |\n' "\`$arguments\`" $numbers \
            "$(awk '{ print $1 + $2 }' "$work/time")"
    done <<'LIST'
--cells 4096
--cells 1024
--cells 16384
--budget 16KiB
--budget 64KiB
--target-variance 0.05
--target-variance 0.005
--budget 64KiB --max-weight 3
--cells 4096 --channel rgb
--cells 4096 --channel max
--cells 4096 --channel red
--cells 4096 --channel green
--cells 4096 --channel blue
--cells 4096 --filter nearest
--cells 4096 --compress zlib
--cells 4096 --threads 1
--fit uniform
--fit cdf
--fit cdf --order phi
--fit cdf --order z
--fit cdf --knots 32x128
--fit cdf --eps 0.01
--fit cdf --eps 0.001
--fit cdf --gradient 16
--fit cdf --conditional mean
--fit pdf
--fit pdf --eps 0.01
LIST
}

# Bytes that --fit cdf needs, its better order, for the variance of --budget SIZE, over that size. Between two
# counts of knots the variance is taken as a power of the bytes.
ratio() {
    local probe size goal knots line
    echo "| probe | cdf over 16 KiB | cdf over 64 KiB |"
    echo "|---|---|---|"
    for probe in "${six[@]}"; do
        for knots in 16 23 32 45 64 90 128 181 256 362 512; do
            echo "$(field bytes "$probes/$probe" --filter nearest --fit cdf --knots "${knots}x$knots")" \
                "$(field relative_variance "$probes/$probe" --filter nearest --fit cdf --knots "${knots}x$knots")"
        done >"$work/points"
        line="| ${probe%.*}"
        for size in 16 64; do
            goal=$(field relative_variance "$probes/$probe" --filter nearest --budget "${size}KiB")
            line+=" | $(awk -v goal="$goal" -v size=$((size * 1024)) '
                $2 <= goal && NR > 1 && !done { share = log(v / goal) / log(v / $2)
                    printf "%.2f", b / size * exp(share * log($1 / b)); done = 1 }
                { b = $1; v = $2 }
                END { if (!done) printf "> %.2f", b / size }' "$work/points")"
        done
        echo "$line |"
    done
}

# Seconds of the processor, over all threads, and peak memory of `acdf env`, the start of the program, reading, hashing and
# the exact measurement included. Noise is added to a map that has little else: the most that a partition can be asked for.
building() {
    local label map arguments spruit=$probes/spruit_sunrise_4k.exr
    oiiotool "$spruit" --resize 8192x4096 -d half -o "$work/8k.exr"
    oiiotool "$spruit" --resize 16384x8192 -d half --compression zip -o "$work/16k.exr"
    oiiotool "$probes/noon_grass_1k.hdr" --resize 8192x4096 --noise:type=gaussian:mean=0:stddev=0.1 --clamp:min=0 \
        -d half -o "$work/noise.exr"
    echo "| map | options | seconds | memory |"
    echo "|---|---|---|---|"
    while IFS='|' read -r label map arguments; do
        # shellcheck disable=SC2086
        /usr/bin/time -f '%U %S %M' "$acdf" env "$map" $arguments -o "$work/x.acdf" --force --quiet 2>"$work/time"
        awk -v label="$label" -v arguments="$arguments" \
            '{ printf "| %s | `%s` | %.2f | %d MiB |\n", label, arguments, $1 + $2, $3 / 1024 }' "$work/time"
    done <<LIST
courtyard, 1024×512|$probes/courtyard.exr|--budget 64KiB
courtyard, 1024×512|$probes/courtyard.exr|--budget 256KiB
courtyard, 1024×512|$probes/courtyard.exr|--budget 1MiB
spruit_sunrise, 4096×2048|$spruit|--budget 64KiB
spruit_sunrise, 4096×2048|$spruit|--budget 1MiB
spruit_sunrise, 8192×4096|$work/8k.exr|--budget 64KiB
spruit_sunrise, 16384×8192|$work/16k.exr|--budget 64KiB
noise, 8192×4096|$work/noise.exr|--budget 64KiB
LIST
}

for table in $tables; do
    "$table"
    echo
done
