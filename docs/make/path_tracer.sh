#!/usr/bin/env bash
# path_tracer.sh BUILD: docs/figures/path_tracer.png, by docs/examples/path_tracer: 16 samples a pixel in a studio of softboxes,
# light sampled from `acdf env` with MIS, and from `acdf local` times the surface's lobe. Prints both variances.
set -euo pipefail
build=$(cd "$1" && pwd)
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
"$root/docs/make/build_path_tracer.sh" "$build" "$work"
cd "$work"
python3 "$root/tests/inputs/sky_pfm.py" 512 studio.pfm studio
"$build/tools/acdf" env studio.pfm --budget 16KiB -o environment.acdf --quiet
"$build/tools/acdf" local studio.pfm --budget 256KiB -o product.acdf --quiet

# panel SAMPLER TITLE: the picture, its middle three times larger below it, and a caption
panel() {
    local found text="font=DejaVuSans:color=0.12,0.12,0.12:xalign=center"
    found=$(build/path_tracer "$1" "$1.acdf" studio.pfm "$1.pfm" 16 640)
    echo "$1: $found"
    oiiotool "$1.pfm" --mulc 0.6 --clamp:min=0:max=1 --powc 0.4545 -d uint8 -o whole.png
    oiiotool whole.png --cut 213x80+300+120 --resample 640x240 -o part.png
    oiiotool whole.png part.png --mosaic 1x2 --cut 640x640 -o both.png
    oiiotool both.png --pattern constant:color=1,1,1 648x700 3 --paste +4+4 \
        --text:x=324:y=672:size=20:"$text" "$2" \
        --text:x=324:y=694:size=17:"$text" "16 samples a pixel, relative variance $(printf '%.2g' "${found##* }")" -d uint8 -o "$1.png"
}
panel environment "acdf env 16 KiB, with BRDF samples by MIS"
panel product "acdf local 256 KiB, times the BRDF"
oiiotool --nosoftwareattrib environment.png product.png --mosaic 2x1 -d uint8 \
    --attrib:type=string Software "" -o "$root/docs/figures/path_tracer.png"
