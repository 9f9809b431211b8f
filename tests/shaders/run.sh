#!/usr/bin/env bash
# run.sh DEVICE ACDF COMPARE MAKE_SKY COUNT [FORM...]: exports files, samples and evaluates COUNT times of each on a device, and
# compares with the reader. DEVICE: c, opencl, cuda, webgl, mesa (webgl on Mesa's llvmpipe), webgpu; or glslang and kernels, which only
# compile. FORM: environment, on a lat-long grid; environment_square, on the octahedral one; local and local_square; brdf and brdf_anisotropic; maps. PROBE, BRDF, BUDGET and FLOOR in the environment
# name another source than that of tests, the size of the file, and the share of a BRDF that follows the cosine. MADE names a
# folder for files that several devices take: DEVICE "file" puts them there, others take those that there are.
set -euo pipefail
device=$1 acdf=$2 compare=$3 make_sky=$4 count=$5
forms=("${@:6}")
((${#forms[@]})) || forms=(environment)
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
all=$(mktemp -d)
trap 'rm -rf "$all"' EXIT

# use FORM: what is done next is done with that, in a folder of its own.
use() {
    form=$1 work=$all/$1 brdf='' of='' define=''
    case $form in
    brdf*) brdf=brdf of=_brdf define=BRDF ;;
    maps) of=_sky define=MAPS ;;
    esac
    defines=${define:+-D$define}
    mkdir -p "$work"
}

skip() {
    echo "skipped: $1 (tools/packages.txt names the package)"
    exit 77
}
need() { command -v "$1" >/dev/null || skip "no $1"; }

make_file() {
    if [ -e "${MADE-}/$form.acdf" ]; then
        cp "$MADE/$form.acdf" "$work/sky.acdf"
    else
        make_new_file
    fi
    "$compare" inputs "$work/sky.acdf" "$count" "$work"
}

make_new_file() {
    local probe=${PROBE:-$work/sky.pfm} domain=latlong kind=env
    if [ "$brdf" ]; then
        local model=cook-torrance:m=0.2
        [ "$form" = brdf ] || model=ggx:alpha=0.1,0.3
        "$acdf" brdf "${BRDF:-$model}" --budget "${BUDGET:-16KiB}" --diffuse-floor "${FLOOR:-0.1}" -o "$work/sky.acdf" --quiet
        return
    fi
    if [ "$form" = maps ]; then
        local root maps=()
        root=$(cd "$here/../.." && pwd)
        "${CXX:-c++}" -std=c++17 -O1 -I"$root" "$root/docs/examples/clear_sky/acdf_clear_sky.cpp" -o "$work/clear_sky"
        for hour in 7 8 9; do
            for turbidity in 2 4; do
                "$work/clear_sky" 128 $hour $turbidity "$work/$hour-$turbidity.pfm"
                maps+=("$work/$hour-$turbidity.pfm")
            done
        done
        "$acdf" env "${maps[@]}" --axis time=7,8,9 --axis turbidity=2,4 --budget "${BUDGET:-16KiB}" -o "$work/sky.acdf" --quiet
        return
    fi
    [ -n "${PROBE-}" ] || "$make_sky" "$probe"
    case $form in *square) domain=octahedral ;; esac
    case $form in
    local*) kind=local ;;
    esac
    "$acdf" $kind "$probe" --domain $domain --budget "${BUDGET:-16KiB}" -o "$work/sky.acdf" --quiet
}

# export TARGET -o FILE ...
export_sky() { "$acdf" export "$work/sky.acdf" --force --target "$@"; }

# Steps of 2^-24 by which the density of a sample may differ from that of its direction. Where floats are IEEE's, and sums of
# products are not fused: none.
check() { "$compare" check "$work/sky.acdf" "$count" "$work" "$1"; }

on_c() {
    make_file
    export_sky c -o "$work/exported.h"
    "${CC:-cc}" -std=c99 -O2 -Wall -Wextra -Wconversion -Werror -ffp-contract=off $defines -I"$work" "$here/device.c" \
        -o "$work/device" -lm
    "$work/device" "$work"
    check 0
    export_sky c --tables "$work/tables.bin" -o "$work/exported.h"
    "${CC:-cc}" -std=c99 -O2 -Werror -ffp-contract=off $defines -DTABLES_FILE -I"$work" "$here/device.c" -o "$work/device" -lm
    rm "$work/samples.bin" "$work/densities.bin"
    "$work/device" "$work"
    check 0
}

on_opencl() {
    printf '#define CL_TARGET_OPENCL_VERSION 120\n#include <CL/cl.h>\n' >"$work/has.c"
    cc -c "$work/has.c" -o "$work/has.o" 2>/dev/null || skip "no CL/cl.h"
    cc "$here/opencl.c" -o "$work/device" -lOpenCL 2>/dev/null || skip "no libOpenCL"
    make_file
    export_sky c --tables "$work/tables.bin" -o "$work/exported.h"
    status=0
    HOME=$work POCL_CACHE_DIR=$work "$work/device" "$work" $define || status=$?
    [ "$status" != 77 ] || exit 77
    [ "$status" = 0 ]
    check 0
}

on_cuda() {
    local nvcc
    nvcc=$(PATH=$PATH:/usr/local/cuda/bin command -v nvcc) || skip "no nvcc"
    nvidia-smi -L >/dev/null 2>&1 || skip "no graphics card of NVIDIA's"
    make_file
    export_sky c --tables "$work/tables.bin" -o "$work/exported.h"
    "$nvcc" -std=c++17 -O2 --fmad=false $defines -I"$work" "$here/cuda.cu" -o "$work/device"
    "$work/device" "$work"
    check 0
}

# Each dialect by the compiler of the Khronos group, for OpenGL, WebGL and Vulkan.
on_glslang() {
    need glslangValidator
    make_file
    export_sky glsl -o "$work/sky.glsl"
    export_sky hlsl -o "$work/sky.hlsl"
    local at='acdf_at(vec3(0.0, 1.0, 0.0)), '
    case $define in
    BRDF) at='acdf_view(vec3(0.0, 0.6, 0.8)), ' ;;
    MAPS) at='acdf_sky(vec3(8.0, 3.0, 0.0)), ' ;;
    esac
    local main="void main() { answer = acdf_sample$of(${at}uvec2(1u, 2u)) + acdf_sample$of(${at}vec2(0.5)) * acdf_pdf$of(${at}vec3(0.0, 0.0, 1.0)); }"
    for version in '300 es' '330' '430'; do
        {
            printf '#version %s\nprecision highp float;\nprecision highp int;\n' "$version"
            cat "$work/sky.glsl"
            printf 'out vec4 answer;\n%s\n' "$main"
        } >"$work/shader.frag"
        glslangValidator "$work/shader.frag" || { echo "GLSL $version does not compile" >&2; exit 1; }
    done
    for version in '310 es' '430'; do
        {
            printf '#version %s\n#define ACDF_BUFFER 0\nlayout(local_size_x = 64) in;\n' "$version"
            printf 'layout(std430, binding = 1) buffer Answers { vec4 answer; };\n'
            cat "$work/sky.glsl"
            printf '%s\n' "$main"
        } >"$work/shader.comp"
        glslangValidator "$work/shader.comp" || { echo "GLSL $version with buffers does not compile" >&2; exit 1; }
    done
    glslangValidator -V "$work/shader.comp" -o "$work/shader.spv"
    {
        cat "$work/sky.hlsl"
        printf 'RWStructuredBuffer<float4> answers : register(u0);\n[numthreads(64, 1, 1)]\n'
        printf 'void main(uint3 id : SV_DispatchThreadID) {\n'
        at=${at/vec3/float3}
        printf '    answers[id.x] = acdf_sample%s(%sid.xy) + acdf_sample%s(%sfloat2(0.5, 0.5)) * acdf_pdf%s(%sfloat3(0.0, 0.0, 1.0));\n}\n' \
            "$of" "$at" "$of" "$at" "$of" "$at"
    } >"$work/shader.hlsl"
    glslangValidator -D -V -S comp -e main "$work/shader.hlsl" -o "$work/hlsl.spv"
    echo "GLSL, GLSL with buffers, SPIR-V and HLSL compile"
}

# CUDA and HIP, as far as there is no device: clang makes code for one, of which no number is a double.
on_kernels() {
    need clang++
    make_file
    export_sky c --tables "$work/tables.bin" -o "$work/exported.h"
    cp "$here/kernel.cu" "$work"
    local flags=(-std=c++17 -O2 -S -emit-llvm -nostdinc++ --cuda-device-only -Wno-unknown-cuda-version)
    local cuda=(-x cuda --cuda-gpu-arch=sm_70 -nocudainc -nocudalib) hip=(-x hip --offload-arch=gfx906 -nogpuinc -nogpulib)
    for language in cuda hip; do
        local -n target=$language
        clang++ "${flags[@]}" $defines "${target[@]}" "$work/kernel.cu" -o "$work/kernel.ll"
        grep -q 'define.*answer' "$work/kernel.ll" || { echo "$language: no kernel" >&2; exit 1; }
        if grep -q '\bdouble\b' "$work/kernel.ll"; then
            echo "$language: the kernel computes in doubles" >&2
            exit 1
        fi
    done
    echo "CUDA and HIP compile for devices, without doubles"
}

# on_browser PAGE TARGET STEPS [FLAG...]: a page in headless Chromium, whose GPU is software, for each form in turn: it fetches what
# lies in $work and sends the answers back.
on_browser() {
    need chromium
    need python3
    local pages=()
    for each in "${forms[@]}"; do
        use "$each"
        make_file
        export_sky "$2" --tables "$work/tables.bin" -o "$work/sky.$2"
        cp "$here/$1.html" "$work/index.html"
        pages+=("$form/index.html${define:+?$define}")
    done
    python3 "$here/browser.py" "$all" "${pages[@]}" "${@:4}" || exit "$?"
    for each in "${forms[@]}"; do
        use "$each"
        check "$3"
    done
}

# The GLSL by the compiler of a real OpenGL driver.
on_mesa() {
    export LIBGL_ALWAYS_SOFTWARE=1 EGL_PLATFORM=surfaceless
    on_browser webgl glsl 4 --use-angle=gl-egl --ignore-gpu-blocklist
    grep -q llvmpipe "$work/renderer" || skip "no Mesa with llvmpipe, but $(cat "$work/renderer")"
}

each_form() { # FUNCTION
    for each in "${forms[@]}"; do
        use "$each"
        "$1"
    done
}

new_file() {
    make_new_file
    cp "$work/sky.acdf" "$MADE/$form.acdf"
}

case $device in
file) each_form new_file ;;
c | opencl | cuda | glslang | kernels) each_form "on_$device" ;;
webgl) on_browser webgl glsl 4 ;;
mesa) on_mesa ;;
webgpu) on_browser webgpu wgsl 4 ;;
*)
    echo "usage: run.sh file|c|opencl|cuda|glslang|kernels|webgl|mesa|webgpu ACDF COMPARE MAKE_SKY COUNT [FORM...]" >&2
    exit 2
    ;;
esac
