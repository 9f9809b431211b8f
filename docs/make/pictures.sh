#!/usr/bin/env bash
# pictures.sh DATA [NAME...]: the pictures of README.md and of the pages, into docs/figures. DATA holds probes/ and brdfs/.
# Names: noise local_file brdf render sweep plot, which are all of them without; and visibility, which needs the files that
# visibility.sh leaves in RESULTS (default: build/visibility). ACDF names the program (default:
# build/release/tools/acdf). Needs oiiotool, jq and, for `sweep`, chromium; tools/packages.txt lists them.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
data=$(cd "${1:?usage: docs/make/pictures.sh DATA [NAME...]}" && pwd)
shift
acdf=${ACDF:-$root/build/release/tools/acdf}
figures=$root/docs/figures
results=${RESULTS:-$root/build/visibility}
work=$(mktemp -d)
trap 'rm -rf -- "$work"' EXIT

# panel IN OUT TITLE DETAILS: a picture with two lines of text below it, larger below a wide one
panel() {
    local width height scale text="font=DejaVuSans:color=0.12,0.12,0.12:xalign=center"
    read -r width height < <(oiiotool --info "$1" | sed -n "s/.*: *\([0-9]*\) x *\([0-9]*\),.*/\1 \2/p")
    scale=$((width < 480 ? 10 : width / 40))
    oiiotool "$1" --ch R,G,B --pattern constant:color=1,1,1 "$((width + 8))x$((height + 52 * scale / 10))" 3 --paste +4+4 \
        --text:x=$((width / 2 + 4)):y=$((height + 24 * scale / 10)):size=$((3 * scale / 2)):"$text" "$3" \
        --text:x=$((width / 2 + 4)):y=$((height + 43 * scale / 10)):size=$((12 * scale / 10)):"$text" "$4" -d uint8 -o "$2"
}

side_by_side() { # OUT IN...
    local out=$1
    shift
    oiiotool --nosoftwareattrib "$@" --mosaic "$#x1" -d uint8 -o "$figures/$out.png"
}

# figure_of SAMPLER KEY: a number of render.json, to three digits
figure_of() {
    printf '%.3g' "$(jq --arg s "$1" ".samplers[] | select(.sampler == \$s) | $2" "$work/render/render.json")"
}

# lit SCENE SAMPLES SAMPLER...: renders a scene into $work/render, of `size` pixels where that is set
lit() {
    local scene=$1 samples=$2 options=() sampler
    shift 2
    for sampler in "$@"; do options+=(--sampler "$sampler"); done
    "$acdf" render --scene "$root/tools/render/scenes/$scene.json" --data "$data" --size "${size:-320x240}" --samples "$samples" --seeds 4 \
        --sequence independent --no-reference --no-timing --images --quiet --force -o "$work/render" "${options[@]}" > /dev/null
}

# The light of Grace Cathedral on matte surfaces: as many samples of the full table and of a file. README.md has the
# variances and their ratio below the picture.
noise() {
    size=600x450 lit e4-grace 16 full-cdf local:1MB
    local full local
    full=$(figure_of full-cdf .relative_variance.value) local=$(figure_of local:1MB .relative_variance.value)
    panel "$work/render/full-cdf.png" "$work/1.png" "full-resolution CDF, 4 MiB" "16 samples a pixel, relative variance $full"
    panel "$work/render/local-1MB.png" "$work/2.png" "acdf local, 1 MB" "16 samples a pixel, relative variance $local"
    side_by_side noise "$work"/[12].png
    awk -v full="$full" -v mine="$local" '
        $0 == "<!-- noise -->" {
            print
            printf "**The acdf file, which uses the normal, has %.1f times less variance than the CDF: %s instead of %s.**\n", full / mine, mine, full
            inside = 1
            next
        }
        $0 == "<!-- /noise -->" { inside = 0 }
        !inside { print }' "$root/README.md" > "$work/README.md"
    cat "$work/README.md" > "$root/README.md"
}

# The pdfs of one local file for two normals.
local_file() {
    "$acdf" local "$data/probes/venice_sunset_1k.hdr" -o "$work/venice_sunset.acdf" --force --quiet
    "$acdf" plot "$work/venice_sunset.acdf" -o "$work/1.png" --normal 0,0,1 --width 512 --no-knots --range 1e-5:10 --force --quiet
    "$acdf" plot "$work/venice_sunset.acdf" -o "$work/2.png" --normal 1,0.3,0.2 --width 512 --no-knots --range 1e-5:10 --force --quiet
    side_by_side local "$work"/[12].png
}

# The lobe of one BRDF file for two views.
brdf() {
    "$acdf" brdf "$data/brdfs/nickel.binary" --budget 64KiB -o "$work/nickel.acdf" --force --quiet
    "$acdf" plot "$work/nickel.acdf" -o "$work/1.png" --view 30 --width 512 --range 1e-4:100 --force --quiet
    "$acdf" plot "$work/nickel.acdf" -o "$work/2.png" --view 75 --width 512 --range 1e-4:100 --force --quiet
    side_by_side brdf "$work"/[12].png
}

# Two of the pictures that `acdf render` writes of a sampler: variance, gain.
render() {
    lit hidden-grace 16 full-cdf local:1MB
    local map
    for map in variance gain; do oiiotool "$work/render/local-1MB-$map.png" --resize 60% -o "$work/$map.png"; done
    side_by_side render "$work"/{variance,gain}.png
}

# A sweep's page down to its last plot, as wide as a column of text, so that it can be read there.
sweep() {
    (cd "$data/probes" && "$acdf" sweep noon_grass_1k.hdr -o "$work/sweep" --force --quiet > /dev/null)
    chromium --headless --no-sandbox --disable-gpu --disable-background-networking --hide-scrollbars --window-size=840,2500 \
        --user-data-dir="$work/profile" --screenshot="$figures/sweep.png" "file://$work/sweep/report.html" 2> "$work/log"
}

# One probe in files of two sizes.
plot() {
    local size
    for size in 4KiB 64KiB; do
        "$acdf" env "$data/probes/venice_sunset_1k.hdr" -o "$work/venice_sunset.acdf" --budget $size --force --quiet
        "$acdf" plot "$work/venice_sunset.acdf" -o "$work/$size.png" --width 512 --range 1e-3:30 --force --quiet
    done
    side_by_side plot "$work"/{4KiB,64KiB}.png
}

# equal_time SCENE SAMPLER...: the first sampler takes 16 samples a pixel, the others as many as they can in its time; what
# they make anew for a picture takes some of it. A sampler is TEXT=NAME.
equal_time() {
    local scene=$1 options=() shown=() one points made sampling budget='' i=0 samples
    shift
    local common=(render --scene "$results/$scene.json" --data "$data" --size 320x240 --sequence independent --no-reference --seeds 3
                  --images --quiet --force)
    for one in "$@"; do options+=(--sampler "${one%=*}"); done
    "$acdf" "${common[@]}" --samples 16 -o "$work/timed" "${options[@]}" > /dev/null
    points=$(jq .points "$work/timed/render.json")
    for one in "$@"; do
        made=$(jq "1e9 * (.samplers[$i].making_seconds // 0) / $points" "$work/timed/render.json") # ns a pixel
        sampling=$(jq ".samplers[$i].nanoseconds.value - $made" "$work/timed/render.json")
        budget=${budget:-$sampling}
        samples=$(awk -v b="$budget" -v m="$made" -v d="$sampling" 'BEGIN { s = int(16 * (b - m) / d + 0.5); print s < 2 ? 2 : s }')
        "$acdf" "${common[@]}" --samples "$samples" --no-timing -o "$work/lit-$i" --sampler "${one%=*}" > /dev/null
        panel "$(ls "$work/lit-$i"/*.png | grep -v -e reference -e -variance -e -above)" "$work/panel-$i.png" "${one##*=}" \
            "$samples samples, variance $(printf %.3g "$(jq '.samplers[0].relative_variance.value' "$work/lit-$i/render.json")")"
        shown+=("$work/panel-$i.png")
        i=$((i + 1))
    done
    side_by_side "visibility-$scene" "${shown[@]}"
}

# A room at equal time.
visibility() {
    equal_time room "file:$results/room-local.acdf=local:1MB" portals=portals visibility-cache:32x16=visibility-cache \
        "file:$results/room-visibility.acdf=visibility:4MB"
}

pictures=("$@")
((${#pictures[@]})) || pictures=(noise local_file brdf render sweep plot)
for picture in "${pictures[@]}"; do
    echo "$picture" >&2
    "$picture"
done
