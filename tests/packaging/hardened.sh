#!/usr/bin/env bash
# hardened.sh FILE...: whether programs and libraries are hardened as ACDF_HARDEN promises.
# hardened.sh --build WORK SOURCE CC CXX: the same of a reader that is built with that option, and of a program beside it.
set -euo pipefail

wrong() { echo "$1: $2" >&2; exit 1; }

check() { # FILE
    local headers dynamic symbols
    headers=$(readelf -hlW "$1") dynamic=$(readelf -dW "$1") symbols=$(readelf --dyn-syms -W "$1")
    grep -q 'Type: *DYN' <<<"$headers" || wrong "$1" "lies at a fixed address"
    grep -q 'GNU_RELRO' <<<"$headers" || wrong "$1" "no section becomes read-only"
    grep -qE 'BIND_NOW|FLAGS.*\bNOW\b' <<<"$dynamic" || wrong "$1" "addresses of functions are found late, in memory that stays writable"
    grep 'GNU_STACK' <<<"$headers" | grep -q ' RW ' || wrong "$1" "the stack is executable"
    if grep -q 'TEXTREL' <<<"$dynamic"; then wrong "$1" "code is written to while it is loaded"; fi
    grep -q '__stack_chk_fail' <<<"$symbols" || wrong "$1" "no return is guarded"
    echo "$1: hardened"
}
# Of all together: small ones may copy nothing whose size the compiler does not prove.
check_fortified() { # FILE...
    for file in "$@"; do
        if readelf --dyn-syms -W "$file" | grep -qE 'UND +__[a-z]+_chk(@|$)' &&
            readelf --dyn-syms -W "$file" | grep -E 'UND +__[a-z]+_chk(@|$)' | grep -qv stack_chk; then return; fi
    done
    wrong "$*" "no call of the C library checks sizes (_FORTIFY_SOURCE)"
}

if [[ $1 == --build ]]; then
    work=$2 source=$3
    rm -rf "$work"
    cmake -S "$source" -B "$work" -G Ninja -DCMAKE_BUILD_TYPE=Release -DACDF_HARDEN=ON -DACDF_BUILD_ONCE=ON -DACDF_BUILD_TOOLS=OFF \
        -DACDF_BUILD_TESTS=OFF -DACDF_BUILD_SHARED=ON -DCMAKE_C_COMPILER="$4" -DCMAKE_CXX_COMPILER="$5" >"$work.log" 2>&1 ||
        { cat "$work.log"; exit 1; }
    cmake --build "$work" --target acdf_reader_shared >>"$work.log" 2>&1 || { cat "$work.log"; exit 1; }
    set -- "$work"/lib/reader/libacdf.so.0
fi
for file in "$@"; do check "$file"; done
check_fortified "$@"
