#!/usr/bin/env bash
# method_tables.sh PROBES: the tables of docs/method.md, from the probes in a folder, as Markdown on stdout.
# ACDF names the program (default: build/release/tools/acdf).
set -euo pipefail
probes=${1:?usage: tools/method_tables.sh PROBES}
acdf=${ACDF:-$(dirname "${BASH_SOURCE[0]}")/../build/release/tools/acdf}
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

echo "| probe | uniform | cdf | cdf, eq. 4 as printed | cdf, 16 gradient knots | pdf | variance, cascade | variance, tree |"
echo "|---|---|---|---|---|---|---|---|"
columns=("--fit uniform" "--fit cdf --order z" "--fit cdf --order z --conditional mean" "--fit cdf --order z --gradient 16"
    "--fit pdf" "--shape cascade" "")
for probe in city sunset studio courtyard; do row "$probe" "$probes/$probe.exr"; done

echo
echo "| probe | 4 KiB | 16 KiB | 64 KiB | 256 KiB | 64 KiB, weights below 3 | 64 KiB, zlib |"
echo "|---|---|---|---|---|---|---|"
columns=("--budget 4KiB" "--budget 16KiB" "--budget 64KiB" "--budget 256KiB" "--budget 64KiB --max-weight 3"
    "--budget 64KiB --compress zlib")
for probe in city.exr sunset.exr studio.exr courtyard.exr noon_grass_1k.hdr; do row "${probe%.*}" "$probes/$probe"; done
row "grace_probe" "$probes/grace_probe.hdr" --projection angular
