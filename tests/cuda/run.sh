#!/usr/bin/env bash
# run.sh BUILD DATA [COLUMNS...]: writes docs/appendix/performance-gpu.md. BUILD: a release build with
# -DACDF_BUILD_CUDA=ON and -DACDF_BUILD_BENCHMARKS=ON; DATA holds probes/ and brdfs/. COLUMNS of the maps that environments are
# compared with: 1024 4096 16384, which take 10 GiB.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
build=$(cd "$1" && pwd)
data=$(cd "$2" && pwd)
shift 2
work=$(mktemp -d "${TMPDIR:-/tmp}/acdf-cuda-XXXXXX")
trap 'rm -rf "$work"' EXIT
acdf=$build/tools/acdf write=$build/tests/bench/bench_environment cuda=$build/tests/cuda
cd "$work"
"$write" --write 64KiB.acdf $((64 << 10))
"$write" --write 4KiB.acdf $((4 << 10))
"$write" --write octahedral_64KiB.acdf $((64 << 10)) octahedral
"$acdf" env "$data/probes/noon_grass_1k.hdr" --budget 256KiB -o noon_grass_256KiB.acdf --quiet
"$acdf" local "$data/probes/noon_grass_1k.hdr" -o local_1MiB.acdf --quiet
"$acdf" local "$data/probes/noon_grass_1k.hdr" --budget 128KiB -o local_128KiB.acdf --quiet
"$acdf" brdf "$data/brdfs/nickel.binary" --budget 128KiB -o nickel_128KiB.acdf --quiet
tables() { "$acdf" export "$1.acdf" --target c --tables "$2.bin" -o "$2.h"; }
tables 64KiB 64KiB
tables 4KiB 4KiB
tables octahedral_64KiB octahedral_64KiB
tables local_1MiB local_1MiB
tables local_128KiB local_128KiB
tables nickel_128KiB nickel_128KiB_brdf

all=(64KiB.acdf octahedral_64KiB.acdf noon_grass_256KiB.acdf local_128KiB.acdf local_1MiB.acdf nickel_128KiB.acdf)
{
    for rounding in agree agree_fused; do
        printf '\n%s\n\n' "$([ $rounding = agree ] && echo 'Compiled with `--fmad=false`:' || echo 'As nvcc compiles by default:')"
        "$cuda/cuda_$rounding" 10000000 "${all[@]}"
        [ $rounding != agree ] || "$cuda/cuda_agree" 1000000 --product 8 local_128KiB.acdf nickel_128KiB.acdf | tail -1
    done
} | "$here/../../docs/make/put_table.sh" cuda_agree
{
    for columns in "${@:-1024 4096 16384}"; do
        for one in $columns; do
            "$cuda/cuda_bench" environments "$one" 64KiB.acdf 4KiB.acdf octahedral_64KiB.acdf noon_grass_256KiB.acdf 64KiB.bin 4KiB.bin \
                octahedral_64KiB.bin
        done
    done
    "$cuda/cuda_bench" others local_1MiB.acdf local_128KiB.acdf nickel_128KiB.acdf local_1MiB.bin local_128KiB.bin nickel_128KiB_brdf.bin
} | "$here/../../docs/make/put_table.sh" cuda
