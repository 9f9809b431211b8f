#!/usr/bin/env bash
# moving.sh ACDF ACDF_CLEAR_SKY: a day of skies in one file, as docs/moving.md makes it, of smaller maps.
set -euo pipefail
acdf=$1 clear_sky=$2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"

maps=()
for hour in 7 9 11 13; do
    for turbidity in 2 4; do
        "$clear_sky" 128 $hour $turbidity sky-$hour-$turbidity.pfm
        maps+=(sky-$hour-$turbidity.pfm)
    done
done
"$acdf" env "${maps[@]}" -o day.acdf --axis time=7,9,11,13 --axis turbidity=2,4 --budget 32KiB --quiet
[ "$(stat -c %s day.acdf)" -le 32768 ]
"$acdf" validate day.acdf >/dev/null
"$acdf" info day.acdf | grep -q "8, 8 with a sun"

# At a map and between: the variance that measure tells, and no support violations.
"$acdf" measure day.acdf --against sky-9-4.pfm --at time=9,turbidity=4 --json >at.json
"$clear_sky" 128 10 3 between.pfm
"$acdf" measure day.acdf --against between.pfm --at 10,3 --json >between.json
python3 - <<'END'
import json
for name in ("at.json", "between.json"):
    told = json.load(open(name))
    assert told["support_violations"] == 0 and told["relative_variance"] < 3, told
    assert abs(told["total_stored"] / told["total"] - 1) < 0.05, told
END

# Samples have the pdf that pdf tells.
"$acdf" sample day.acdf -n 500 --at time=10,turbidity=3 >samples.csv
"$acdf" pdf day.acdf --at time=10,turbidity=3 samples.csv >pdfs
tail -n +2 samples.csv | cut -d, -f6 | cmp - pdfs
"$acdf" plot day.acdf -o day.png --at time=10,turbidity=3 --width 64 --quiet
[ -s day.png ]

"$acdf" export day.acdf --target glsl --tables day.bin >day.glsl
grep -q "AcdfShaderSky acdf_sky(vec3 at)" day.glsl

# A sequence has the axis frame. It is the same file as by its names.
for frame in 7 8 9; do "$clear_sky" 64 $frame 3 day.000$frame.pfm; done
"$acdf" env "day.####.pfm" -o frames.acdf --budget 16KiB --quiet
"$acdf" env day.000{7,8,9}.pfm -o named.acdf --axis frame=7,8,9 --budget 16KiB --quiet
cmp frames.acdf named.acdf

"$acdf" diff frames.acdf named.acdf >/dev/null
("$acdf" diff frames.acdf day.acdf || true) | grep -q "by their bytes alone"

# What is wrong is said in one line.
refused() {
    local code=0
    "$acdf" "$@" >out 2>err || code=$?
    [ "$code" = "$expected" ] || { echo "acdf $*: exit code $code"; cat err; exit 1; }
    [ "$(wc -l <err)" -le 2 ]
}
expected=1 refused measure day.acdf --against between.pfm
expected=1 refused sample day.acdf -n 1 --at time=10
expected=1 refused pdf day.acdf --at time=10,hour=3 samples.csv
expected=1 refused env "no.####.exr" -o none.acdf
expected=2 refused env "${maps[@]}" -o none.acdf --axis time=7,9,11
expected=2 refused env day.0007.pfm day.0008.pfm --axis time=7,8
expected=2 refused env day.0007.pfm day.0008.pfm -o none.acdf --axis time=7,8 --fit cdf
expected=2 refused env day.0007.pfm -o none.acdf --no-sun
expected=1 refused env day.0007.pfm sky-7-2.pfm -o none.acdf --axis time=7,8 --quiet
[ ! -e none.acdf ]
