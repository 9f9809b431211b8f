#!/usr/bin/env bash
# moving_turned.sh ACDF PROBE...: the table of docs/notes/moving.md of probes that turn and get brighter: nine frames in one file, each four
# columns further and a tenth brighter, and the variance at every quarter of a frame.
set -euo pipefail
acdf=$1
shift
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

frame() { oiiotool "$1" --ch R,G,B --cshift "+$2+0" --mulc "$(awk "BEGIN { print 1 + $2 / 40 }")" -d float -o "$3"; }

echo "| probe | least variance | most | from frame to frame, most |"
echo "|---|---|---|---|"
for probe; do
    for i in 0 1 2 3 4 5 6 7 8; do frame "$probe" $((4 * i)) "$work/probe.$i.exr"; done
    "$acdf" env "$work/probe.#.exr" -o "$work/turned.acdf" --force --quiet
    for shift in $(seq 0 32); do
        frame "$probe" "$shift" "$work/now.exr"
        "$acdf" measure "$work/turned.acdf" --against "$work/now.exr" --at "$(awk "BEGIN { print $shift / 4 }")" --json |
            sed -n 's/.*"relative_variance": \([^,]*\),.*/\1/p'
    done | awk -v name="$(basename "$probe")" '
        { v = $1; if (NR == 1 || v < low) low = v; if (v > high) high = v }
        NR > 1 { r = v > last ? v / last : last / v; if (r > most) most = r }
        { last = v }
        END { printf "| %s | %.2g | %.2g | %.0f %% |\n", name, low, high, 100 * (most - 1) }'
done
