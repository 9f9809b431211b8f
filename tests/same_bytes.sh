#!/usr/bin/env bash
# The same bytes from every build: same_bytes.sh ACDF [ACDF...]
# Runs each acdf program with 1, 2 and 7 threads on the same inputs (a sky and a table made here, a model of a BRDF) to
# files of all kinds, and compares all of them with the first's. Exit code 1 and the names of files that
# differ, else 0. Builds may be of any compiler and optimisation, for one architecture.
set -euo pipefail
[ $# -ge 1 ] || { echo "usage: same_bytes.sh ACDF [ACDF...]" >&2; exit 2; }

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# A table of 4 x 12 x 16 numbers of different magnitudes as an .npy file.
write_table() {
    awk 'BEGIN { for (i = 0; i < 768; ++i) printf "%c%c%c%c", 65 + i * 7 % 26, 65 + i * 11 % 50, i * 37 % 100 + 1, 58 + i % 8 }' \
        > "$work/data"
    local dict="{'descr': '<f4', 'fortran_order': False, 'shape': (4, 12, 16), }"
    { printf '\x93NUMPY\x01\x00\x76\x00%-117s\n' "$dict"; cat "$work/data"; } > "$work/table.npy"
}

# A sky of 64 x 32 texels as a Radiance file: a gradient, noise, and one bright texel.
write_sky() {
    { printf '#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 32 +X 64\n'
      awk 'BEGIN { for (i = 0; i < 2048; ++i) {
                       v = 40 + (i * 2654435 + int(i / 64) * 977) % 200
                       printf "%c%c%c%c", v, 20 + v / 2, 250 - int(i / 64) * 3, i == 700 ? 142 : 128 } }'
    } > "$work/sky.hdr"
}

# make ACDF THREADS FOLDER
make_files() {
    local acdf=$1 out=$3
    local common=(--threads "$2" --quiet)
    mkdir -p "$out"
    for codec in none zlib; do
        "$acdf" env "$work/sky.hdr" -o "$out/env_$codec.acdf" --cells 500 --compress $codec "${common[@]}"
        "$acdf" local "$work/sky.hdr" -o "$out/local_$codec.acdf" --budget 16KiB --compress $codec "${common[@]}"
        "$acdf" table "$work/table.npy" --indexed 1 -o "$out/table_$codec.acdf" --cells 40 --compress $codec "${common[@]}"
    done
    "$acdf" brdf ggx:alpha=0.2 -o "$out/brdf.acdf" --budget 12KiB --views 6 "${common[@]}"
    for fit in cdf pdf uniform; do
        "$acdf" env "$work/sky.hdr" -o "$out/env_$fit.acdf" --fit $fit --knots 12x12 "${common[@]}"
    done
    "$acdf" sample "$out/env_none.acdf" -n 1000 -o "$out/samples.csv"
}

export LC_ALL=C
write_table
write_sky

status=0
number=0
for acdf in "$@"; do
    number=$((number + 1))
    makers=()
    for threads in 1 2 7; do
        make_files "$acdf" $threads "$work/$number.$threads" &
        makers+=($!)
    done
    for maker in "${makers[@]}"; do wait "$maker"; done
    for threads in 1 2 7; do
        if ! diff -rq "$work/1.1" "$work/$number.$threads" > "$work/differ"; then
            echo "$acdf, $threads threads: not the bytes of $1 with 1 thread:" >&2
            sed 's/^/    /' "$work/differ" >&2
            status=1
        fi
    done
done
[ $status = 0 ] && echo "same_bytes: $(ls "$work/1.1" | wc -l) files, the same from $# programs with 1, 2 and 7 threads"
exit $status
