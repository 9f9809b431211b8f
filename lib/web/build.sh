#!/usr/bin/env bash
# build.sh BUILD VERSION: the reader in WebAssembly, and the npm package around it, in BUILD/web/package. BUILD has the
# shaders' texts (target acdf_shader_texts). Needs clang, lld, wasi-libc, libc++ and compiler-rt for WebAssembly; ends with 77
# where they are missing. CLANG names another clang++. wasm-opt (binaryen), where it is installed, takes a twelfth off.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
root=$(cd "$here/../.." && pwd)
build=$(cd "$1" && pwd) version=$2
clang=${CLANG:-clang++}
work=$build/web
mkdir -p "$work/objects" "$work/package"

# Small before fast, as a page loads it, with the copies that engines have: functions that processors are to take in stay functions.
flags=(--target=wasm32-wasi -Oz -flto -mbulk-memory -ffp-contract=off -fvisibility=hidden -DNDEBUG -Wall -Wextra)
for name in ACDF_INLINE ACDF_OUTLINE ACDF_OUTLINE_ON_CPU ACDF_CALLED; do flags+=("-D$name=static inline"); done
includes=(-I"$root/format" -I"$root/lib/reader" -I"$root/lib/indexed" -I"$root/lib/shader" -I"$root/lib" -I"$here/zlib")
libcxx=$(echo "$("$clang" -print-resource-dir)"/../../../include/wasm32-wasi/c++/v1)
if ! echo '#include <utility>
#include <cstdlib>' | "$clang" --target=wasm32-wasi -isystem "$libcxx" -isystem /usr/include/wasm32-wasi -x c++ -c - \
    -o "$work/objects/probe.o" 2>/dev/null; then
    echo "skipped: no C++ for WebAssembly (wasi-libc, libc++-14-dev-wasm32, libclang-rt-14-dev-wasm32, lld)" >&2
    exit 77
fi
rm -f "$work"/objects/*.o

# The reader, environments of several maps and the tables for shaders.
for source in "$here"/*.cpp "$root"/lib/reader/{,check/,tables/}*.cpp "$root"/lib/indexed/*.cpp "$root"/lib/shader/tables/*.cpp; do
    name=${source#"$root/lib/"}
    case $name in
    *_windows.cpp) continue ;;
    esac
    "$clang" "${flags[@]}" -std=c++17 -fno-exceptions -fno-rtti -isystem "$libcxx" -isystem /usr/include/wasm32-wasi \
        "${includes[@]}" -c "$source" -o "$work/objects/${name//[\/]/_}.o"
done
"$clang" "${flags[@]}" -x c -std=c99 -isystem /usr/include/wasm32-wasi -c "$here/zlib/inflate.c" \
    -o "$work/objects/inflate.o"
# What exports.cpp exports, and not what the C++ library would.
mapfile -t exports < <(sed -n 's/^ACDF_EXPORT.* \**\(acdf_web_[a-z_]*\)(.*/-Wl,--export=\1/p' "$here/exports.cpp")
"$clang" --target=wasm32-wasi -mexec-model=reactor "${exports[@]}" -Wl,--gc-sections,--strip-all \
    "$work"/objects/*.o -o "$work/package/acdf.wasm"
if command -v wasm-opt >/dev/null; then
    wasm-opt -Oz --enable-bulk-memory "$work/package/acdf.wasm" -o "$work/package/acdf.wasm"
fi

cp "$here"/package/{acdf.mjs,acdf.d.ts,shaders.d.ts,README.md} "$root/LICENSE" "$work/package/"
sed "s/@VERSION@/$version/" "$here/package/package.json" >"$work/package/package.json"
for language in glsl wgsl; do
    printf 'export const %s = `' "$language"
    sed 's/[`\\$]/\\&/g' "$build/lib/shader/acdf_walk.$language"
    printf '`;\n'
done >"$work/package/shaders.mjs"
chmod 644 "$work/package/acdf.wasm"
