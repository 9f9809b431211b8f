#!/usr/bin/env bash
# moving.sh ACDF ACDF_CLEAR_SKY: docs/figures/moving.png, three hours of one day from one file, as docs/moving.md makes it. The
# hours lie between those of its maps.
set -euo pipefail
acdf=$1 clear_sky=$2
root=$(cd "$(dirname "$0")/../.." && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"

hours=$(awk 'BEGIN { for (i = 0; i < 24; ++i) printf "%s%.4f", i ? "," : "", 4.5 + 15 * i / 23 }')
maps=()
for hour in ${hours//,/ }; do
    for turbidity in 2 4 6; do
        "$clear_sky" 1024 "$hour" $turbidity "$hour-$turbidity.pfm"
        maps+=("$hour-$turbidity.pfm")
    done
done
"$acdf" env "${maps[@]}" -o day.acdf --axis "time=$hours" --axis turbidity=2,4,6

shown=()
for hour in 6.2 9.5 13; do
    "$acdf" plot day.acdf -o $hour.png --at time=$hour,turbidity=3 --width 512 --range 5e-3:2 --quiet
    shown+=($hour.png)
done
oiiotool --nosoftwareattrib "${shown[@]}" --mosaic 3x1 -d uint8 -o "$root/docs/figures/moving.png"
