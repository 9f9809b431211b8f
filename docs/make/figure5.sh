#!/usr/bin/env bash
# Our version of Fig. 5 of Lawrence, Rusinkiewicz and Ramamoorthi 2005: the pdf of the Grace Cathedral probe on
# the unit disc, at full resolution, in uniform and adaptive cascades of 16 x 16 and 64 x 64 segments, and in a
# minimum-variance tree with as many cells as the 64 x 64, all on the paper's lat-long grid. Every panel has the same
# colours, and under it what it costs: cells, bytes, and the relative variance of one sample, as `acdf measure` prints them.
#
#   docs/make/figure5.sh grace_probe.hdr [FIGURE.png]      docs/figures/figure5.png by default
#
# The probe: P. Debevec's light probe gallery. ACDF names the program, build/release/tools/acdf by default. Needs
# oiiotool (openimageio-tools) and DejaVu Sans (fonts-dejavu-core); tools/packages.txt lists both.
set -euo pipefail

if (($# < 1 || $# > 2)); then
    echo "usage: docs/make/figure5.sh grace_probe.hdr [FIGURE.png]" >&2
    exit 2
fi
root=$(realpath -- "$(dirname -- "${BASH_SOURCE[0]}")/../..")
probe=$1
figure=${2:-$root/docs/figures/figure5.png}
acdf=${ACDF:-$root/build/release/tools/acdf}
[[ -r $probe ]] || { echo "figure5.sh: $probe: cannot be read; give the Grace Cathedral probe" >&2; exit 1; }
command -v "$acdf" >/dev/null || { echo "figure5.sh: $acdf: not built; see tools/demo.sh, or set ACDF" >&2; exit 1; }
command -v oiiotool >/dev/null || { echo "figure5.sh: oiiotool is missing; see tools/install_packages.sh" >&2; exit 1; }

range=1e-3:100 # sr^-1: five decades
panel=360      # pixels across a disc
caption=50     # pixels below it
work=$(mktemp -d)
trap 'rm -rf -- "$work"' EXIT

plot() { # FILE OUT [OPTION...]
    "$acdf" plot "$1" -o "$2" --projection angular --width "$panel" --range "$range" --no-knots --quiet "${@:3}"
}

json_number() { # KEY, JSON on stdin
    sed -n "s/.*\"$1\": *\([0-9.eE+-]*\).*/\1/p"
}

add_caption() { # IMAGE TITLE DETAILS: adds the caption to the panel, in place
    local text="font=DejaVuSans:color=0.12,0.12,0.12:xalign=center"
    oiiotool "$1" --pattern constant:color=1,1,1 "$((panel + 16))x$((panel + caption))" 3 --paste +8+4 \
        --text:x=$((panel / 2 + 8)):y=$((panel + 23)):size=15:"$text" "$2" \
        --text:x=$((panel / 2 + 8)):y=$((panel + 41)):size=12:"$text" "$3" \
        -d uint8 -o "$1"
}

make_panel() { # NAME TITLE ENV-OPTION...: fits, measures, plots
    local name=$1 title=$2 report variance
    "$acdf" env "$probe" -o "$work/$name.acdf" --projection angular --domain latlong --quiet "${@:3}"
    report=$("$acdf" measure "$work/$name.acdf" --against "$probe" --projection angular --json --quiet)
    variance=$(json_number relative_variance <<<"$report")
    full=$(json_number relative_variance_full_cdf <<<"$report")
    plot "$work/$name.acdf" "$work/$name.png" --no-legend
    printf -v details '%s cells, %s bytes, relative variance %.3g' \
        "$(json_number cells <<<"$report")" "$(json_number bytes <<<"$report")" "$variance"
    printf '%-12s %s\n' "$name" "$details"
    add_caption "$work/$name.png" "$title" "$details"
}

make_panel u16 "(b) uniform, 16 x 16" --fit uniform --knots 16x16 --order z
make_panel a16 "(c) adaptive (paper), 16 x 16" --fit cdf --knots 16x16 --order z
make_panel u64 "(e) uniform, 64 x 64" --fit uniform --knots 64x64 --order z
make_panel a64 "(f) adaptive (paper), 64 x 64" --fit cdf --knots 64x64 --order z
make_panel variance "(d) minimum variance" --fit variance --cells 4096

plot "$probe" "$work/full.png" --no-legend --probe-projection angular
# What is left is resampling: texels of the lat-long grid cut those of the probe.
printf -v details 'relative variance %.3g' "$full"
printf '%-12s %s\n' full "$details"
add_caption "$work/full.png" "(a) full-resolution CDF" "$details"

# The colour bar is the part of a plot with legend right of the picture and below the title.
plot "$probe" "$work/legend.png" --probe-projection angular
read -r width height < <(oiiotool --info "$work/legend.png" | sed -n 's/.* : *\([0-9]*\) x *\([0-9]*\),.*/\1 \2/p')
left=$((panel + 20))
oiiotool "$work/legend.png" --cut "$((width - left))x$height+$left+0" -d uint8 -o "$work/bar.png"

rows=$((2 * (panel + caption)))
columns=$((3 * (panel + 16)))
oiiotool "$work/full.png" "$work/u16.png" "$work/a16.png" "$work/variance.png" "$work/u64.png" "$work/a64.png" \
    --mosaic 3x2 -o "$work/panels.png"
oiiotool "$work/bar.png" \
    "$work/panels.png" --pattern constant:color=1,1,1 "$((columns + width - left))x$rows" 3 --paste +0+0 \
    --paste "+$columns+$(((rows - height) / 2))" \
    --nosoftwareattrib --attrib:type=int png:compressionLevel 9 -d uint8 -o "$work/figure.png"
mkdir -p "$(dirname -- "$figure")"
mv -f -- "$work/figure.png" "$figure"
echo "$figure: $(stat -c %s "$figure") bytes"
