#!/usr/bin/env bash
# portability.sh: reader and builder for other systems, as far as one machine can test. Not a part of tests/run.sh. The builder is
# compiled and no more: Debian has oneTBB's headers, but for no other system its library. Of Debian 12 it needs
#   libtbb-dev                                  the builder
#   libhwy-dev                                  batches
#   g++-mingw-w64-x86-64 wine64                 Windows: cross-compiled, and run
#   g++-aarch64-linux-gnu qemu-user             64-bit ARM: cross-compiled, and run
#   g++-s390x-linux-gnu                         big-endian: refused with a message
#   clang, gcc, dpkg-dev                        here: what the others are compared with
# What is missing is said and left out; with --strict that is an error. zlib is compiled from Debian's source package, which
# `apt-get source zlib` fetches, or from the folder that ZLIB_SOURCE names.
set -euo pipefail
strict=false
[[ ${1-} == --strict ]] && strict=true
cd "$(dirname "${BASH_SOURCE[0]}")/.."
work=$PWD/build/portability
mkdir -p "$work"
reader=$(find lib/reader lib/arrays lib/curves lib/indexed lib/product lib/visibility lib/shader/tables -name '*.cpp' | sort)
flags="-O1 -std=c++17 -fno-exceptions -fno-rtti -ffp-contract=off -Wall -Wextra -Werror -Iformat -Ilib/reader -Ilib/arrays -Ilib/curves -Ilib/indexed -Ilib/visibility -Ilib/product -Ilib/shader -Ilib"
left_out=0

missing() { # TOOL WHAT
    command -v "$1" >/dev/null && return 1
    echo "left out: $2 ($1 is not installed)"
    left_out=$((left_out + 1))
}

zlib_source() {
    if [[ -n ${ZLIB_SOURCE-} ]]; then echo "$ZLIB_SOURCE"; return; fi
    local found
    found=$(find "$work" -maxdepth 1 -type d -name 'zlib-*' | head -1)
    if [[ -z $found ]]; then
        # Lists of sources of its own: the machine's stay what they are.
        echo 'deb-src http://deb.debian.org/debian bookworm main' >"$work/sources.list"
        mkdir -p "$work/lists/partial"
        local apt=(apt-get -q -o Dir::Etc::sourcelist="$work/sources.list" -o Dir::Etc::sourceparts=- -o Dir::State::lists="$work/lists")
        (cd "$work" && "${apt[@]}" update && "${apt[@]}" source --download-only zlib && dpkg-source -x zlib_*.dsc) \
            >"$work/zlib.log" 2>&1 || return 1
        found=$(find "$work" -maxdepth 1 -type d -name 'zlib-*' | head -1)
    fi
    echo "$found"
}

# build NAME CC CXX: the consumers of tests/packaging, statically linked.
build() {
    local name=$1 cc=$2 cxx=$3 objects=()
    mkdir -p "$work/$name"
    for source in "$zlib"/{adler32,crc32,inflate,inffast,inftrees,zutil}.c; do
        "$cc" -O1 -w -I"$zlib" -c "$source" -o "$work/$name/z_$(basename "$source" .c).o"
        objects+=("$work/$name/z_$(basename "$source" .c).o")
    done
    for source in $reader; do
        local object=${source#lib/}
        object=$work/$name/${object//[\/]/_}.o
        "$cxx" $flags -I"$zlib" -c "$source" -o "$object"
        objects+=("$object")
    done
    "$cc" -std=c99 -O1 -ffp-contract=off -Wall -Wextra -Iformat -Ilib/reader -c tests/packaging/consumer/consumer.c \
        -o "$work/$name/consumer_c.o"
    "$cxx" -static "$work/$name/consumer_c.o" "${objects[@]}" -o "$work/$name/consumer_c.exe"
    "$cxx" $flags -static tests/packaging/consumer/consumer.cpp "${objects[@]}" -o "$work/$name/consumer_cpp.exe"
}

# compile_builder NAME CXX: its sources alone, with headers of oneTBB that are the same for all systems.
compile_builder() {
    local name=$1 cxx=$2 source count=0
    [[ -e /usr/include/oneapi/tbb.h ]] || { echo "left out: the builder for $name (no libtbb-dev)"; left_out=$((left_out + 1)); return; }
    mkdir -p "$work/tbb"
    ln -sfn /usr/include/oneapi "$work/tbb/oneapi"
    ln -sfn /usr/include/tbb "$work/tbb/tbb"
    for source in $(find lib/compress lib/build -name '*.cpp' | sort); do
        "$cxx" -std=c++17 -Wall -Wextra -Werror -Wno-psabi -DACDF_VERSION='"0"' -fsyntax-only -Iformat -Ilib/reader -Ilib/curves -Ilib/indexed -Ilib/visibility -Ilib \
            -Ilib/build -I"$zlib" \
            -isystem "$work/tbb" "$source"
        count=$((count + 1))
    done
    echo "$name: the builder's $count sources compile"
}

# batches NAME CXX RUN...: batches have the bits of single calls, by the vectors that the compiler takes for granted. Of Highway
# only headers, which are the same for all systems.
batches() {
    local name=$1 cxx=$2
    shift 2
    [[ -e /usr/include/hwy/highway.h ]] || { echo "left out: batches for $name (no libhwy-dev)"; left_out=$((left_out + 1)); return; }
    mkdir -p "$work/highway"
    ln -sfn /usr/include/hwy "$work/highway/hwy"
    "$cxx" ${flags/-O1/-O2} -Wno-psabi -DACDF_ZLIB=0 -DHWY_COMPILE_ONLY_STATIC -Ilib/batch -isystem "$work/highway" -static \
        tests/lib/batch/check_files.cpp $(find lib/reader lib/batch lib/curves -name '*.cpp') -o "$work/$name/batches.exe"
    echo "$name, $("$@" "$work/$name/batches.exe" tests/golden/v1.0/*.acdf)"
}

# same NAME RUN...: its samples are those of the compiler here, for every environment of the golden files; a missing file is a
# message.
same() {
    local name=$1 file count=0
    shift
    for file in tests/golden/v1.0/halvings*.acdf; do
        "$work/here/consumer_cpp.exe" "$file" >"$work/expected.txt"
        for consumer in consumer_c consumer_cpp; do
            "$@" "$work/$name/$consumer.exe" "$file" 2>"$work/$name.log" | tr -d '\r' >"$work/$name.txt"
            diff "$work/expected.txt" "$work/$name.txt" >/dev/null || { echo "$name: other samples of $file" >&2; exit 1; }
        done
        count=$((count + 1))
    done
    if "$@" "$work/$name/consumer_cpp.exe" no-such-file.acdf 2>"$work/error.txt"; then exit 1; fi
    grep -q 'no-such-file\.acdf: .' "$work/error.txt"
    if "$@" "$work/$name/consumer_cpp.exe" tests 2>"$work/error.txt"; then exit 1; fi
    grep -q 'directory' "$work/error.txt"
    echo "$name: $count files, the same samples"
}

if ! zlib=$(zlib_source); then
    echo "left out: all that runs (no source of zlib; see $work/zlib.log)"
    left_out=$((left_out + 1))
else
    build here gcc g++
    if ! missing clang "clang"; then
        build clang clang clang++
        same clang env
    fi
    if ! missing x86_64-w64-mingw32-g++ "Windows"; then
        build windows x86_64-w64-mingw32-gcc x86_64-w64-mingw32-g++
        compile_builder windows "$(command -v x86_64-w64-mingw32-g++-posix || echo x86_64-w64-mingw32-g++)"
        wine=$(command -v wine64 || command -v wine || ls /usr/lib/wine/wine64 2>/dev/null || true)
        if [[ -n $wine ]]; then
            export WINEDEBUG=-all WINEPREFIX=$work/wine
            same windows "$wine"
        else
            echo "windows: compiled; left out: running it (wine64 is not installed)"
            left_out=$((left_out + 1))
        fi
    fi
    if ! missing aarch64-linux-gnu-g++ "64-bit ARM" && ! missing qemu-aarch64 "64-bit ARM"; then
        build aarch64 aarch64-linux-gnu-gcc aarch64-linux-gnu-g++
        same aarch64 qemu-aarch64
        batches aarch64 aarch64-linux-gnu-g++ qemu-aarch64
        compile_builder aarch64 aarch64-linux-gnu-g++
    fi
fi
if ! missing s390x-linux-gnu-g++ "big-endian"; then
    echo '#include <acdf/reader.h>' >"$work/big.cpp"
    if s390x-linux-gnu-g++ -std=c++17 -Iformat -Ilib/reader -fsyntax-only "$work/big.cpp" 2>"$work/big.txt"; then
        echo "a big-endian machine is not refused" >&2
        exit 1
    fi
    grep -q 'acdf files are little-endian' "$work/big.txt"
    echo "s390x: refused with its message"
fi
if ((left_out > 0)); then
    echo "$left_out left out"
    ! $strict
fi
