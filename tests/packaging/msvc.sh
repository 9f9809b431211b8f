#!/usr/bin/env bash
# msvc.sh SOURCE: what the reader and the builder are compiled with where the compiler calls itself MSVC. No such compiler is
# run: CMake is made to believe that it has one, and the commands that it would run must not have flags that only others know.
set -euo pipefail
source=$(cd "$1" && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
touch "$work/zlib.lib" "$work/tbb.lib"
mkdir "$work/include" "$work/TBB"
touch "$work/include/zlib.h"
printf 'add_library(TBB::tbb UNKNOWN IMPORTED)\nset_target_properties(TBB::tbb PROPERTIES IMPORTED_LOCATION "%s")\n' \
    "$work/tbb.lib" >"$work/TBB/TBBConfig.cmake"
cat >"$work/toolchain.cmake" <<'END'
set(CMAKE_SYSTEM_NAME Generic)
set(CMAKE_SYSTEM_PROCESSOR AMD64)
foreach(language C CXX)
    set(CMAKE_${language}_COMPILER /bin/true)
    set(CMAKE_${language}_COMPILER_ID MSVC)
    set(CMAKE_${language}_COMPILER_VERSION 19.38)
    set(CMAKE_${language}_COMPILER_ID_RUN TRUE)
    set(CMAKE_${language}_COMPILER_FORCED TRUE)
    set(CMAKE_${language}_SIMULATE_ID "")
endforeach()
set(CMAKE_CXX_COMPILE_FEATURES cxx_std_11 cxx_std_14 cxx_std_17)
set(CMAKE_CXX17_STANDARD_COMPILE_OPTION "-std:c++17")
set(MSVC 1)
set(WIN32 1)
set(CMAKE_SIZEOF_VOID_P 8)
set(CMAKE_TRY_COMPILE_TARGET_TYPE STATIC_LIBRARY)
END
cmake -S "$source" -B "$work/build" -G Ninja -DCMAKE_TOOLCHAIN_FILE="$work/toolchain.cmake" -DACDF_BUILD_TOOLS=OFF \
    -DACDF_BUILD_BUILDER=ON -DACDF_BUILD_TESTS=OFF -DACDF_BUILD_PYTHON=OFF -DACDF_BUILD_SHARED=OFF -DACDF_INSTALL=OFF \
    -DACDF_WERROR=ON -DCMAKE_EXPORT_COMPILE_COMMANDS=ON -DZLIB_LIBRARY="$work/zlib.lib" -DZLIB_INCLUDE_DIR="$work/include" \
    -DZLIB_VERSION_STRING=1.2.13 -DTBB_DIR="$work/TBB" >"$work/log" 2>&1 || { cat "$work/log" >&2; exit 1; }
commands=$work/build/compile_commands.json
count=$(grep -c '"command"' "$commands")
[ "$count" -gt 50 ] || { echo "only $count sources are compiled" >&2; exit 1; }
grep -q '"command".*/fp:precise' "$commands" || { echo "/fp:precise is missing" >&2; exit 1; }
if grep '"command"' "$commands" | grep -oE ' -(f|m|W|O[s3g]|pthread|std=|g)[a-z0-9=+_-]*' | sort | uniq -c | grep .; then
    echo "flags that MSVC does not know, with how often they occur" >&2
    exit 1
fi
echo "$count sources, and no flag that MSVC does not know"
