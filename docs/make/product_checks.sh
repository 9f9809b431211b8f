#!/usr/bin/env bash
# product_checks.sh BUILD DATA: checks acdf/product/product.h at 200 shading points for each of eight probes and eleven BRDFs, and writes
# the table of docs/appendix/product-checks.md. BUILD: a release build with -DACDF_BUILD_BENCHMARKS=ON; DATA holds probes/ and brdfs/.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
build=$(cd "${1:?usage: product_checks.sh BUILD DATA}" && pwd)
data=$(cd "${2:?usage: product_checks.sh BUILD DATA}" && pwd)
work=$(mktemp -d "${TMPDIR:-/tmp}/acdf-checks-XXXXXX")
trap 'rm -rf "$work"' EXIT
lights=()
while read -r name options; do
    # shellcheck disable=SC2086
    "$build/tools/acdf" local "$data/probes/$name" $options --budget 256KiB -o "$work/$name.acdf" --quiet
    lights+=("$work/$name.acdf")
done <<'ROWS'
grace_probe.hdr --projection angular
stpeters_cross.hdr
beach_probe.hdr --projection angular
city.exr
courtyard.exr
noon_grass_1k.hdr
venice_sunset_1k.hdr
studio_small_05_1k.hdr
ROWS

# row NAME ARGUMENT...: the sum over all probes
row() {
    local name=$1
    shift
    { printf '%s\0' "${lights[@]}" | xargs -0 -I LIGHT -P "$(nproc)" "$build/tests/bench/product_checks" LIGHT "$@" || true; } |
        awk -F'|' -v name="$name" '{ pairs += $2; if ($3 > worst) worst = $3; pdf += $4; support += $5; mean += $6 }
            END { printf "| %s | %d | %.1g | %d | %d | %d |\n", name, pairs, worst, pdf, support, mean }'
}
file() { # NAME BRDF
    "$build/tools/acdf" brdf "$2" --budget 64KiB -o "$work/brdf.acdf" --force --quiet
    row "$1" "$work/brdf.acdf"
}
{
    echo "| BRDF | pairs | integral of the light's part less 1, largest | samples with another \`pdf\` | light without pdf | means beyond 4 standard errors |"
    echo "|---|---|---|---|---|---|"
    file Lambert lambert
    for alpha in 0.05 0.2 0.7; do row "GGX, α $alpha" $alpha $alpha; done
    row "GGX, α 0.05 × 0.3" 0.05 0.3
    for name in nickel.binary blue-metallic-paint.binary cc_ibiza_sunset_rgb.bsdf cg_sunflower_rgb.bsdf paper_white_rgb.bsdf satin_rosaline_rgb.bsdf; do
        file "$name" "$data/brdfs/$name"
    done
} | "$root/docs/make/put_table.sh" checks
