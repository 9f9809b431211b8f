#!/usr/bin/env bash
# embedded.sh BUILD SOURCE CC CXX [CMAKE]: acdf within another project, by add_subdirectory and by FetchContent. The reader alone is
# configured, with no package but zlib; nothing of acdf is installed with that project, and its build type stays what it is.
# Sources are compiled together here: alone they are where the npm package is built.
set -euo pipefail
build=$1 source=$(realpath "$2") cc=$3 cxx=$4 cmake=${5:-cmake}
work=$build/embedded
rm -rf "$work"
mkdir -p "$work/add" "$work/fetch"
cd "$work"

for way in add fetch; do
    cat >$way/CMakeLists.txt <<'PROJECT'
cmake_minimum_required(VERSION 3.16)
project(renderer LANGUAGES C CXX)
PROJECT
done
cat >>add/CMakeLists.txt <<PROJECT
add_subdirectory("$source" acdf)
PROJECT
cat >>fetch/CMakeLists.txt <<PROJECT
include(FetchContent)
FetchContent_Declare(acdf SOURCE_DIR "$source")
FetchContent_MakeAvailable(acdf)
PROJECT
for way in add fetch; do
    cat >>$way/CMakeLists.txt <<PROJECT
add_executable(renderer "$source/tests/packaging/consumer/consumer.cpp")
target_link_libraries(renderer PRIVATE acdf::reader)
install(TARGETS renderer RUNTIME DESTINATION bin)
PROJECT
    without=()
    for package in TBB Freetype PNG OpenEXR OpenImageIO OpenSSL nlohmann_json CLI11 assimp pybind11 Python3 GTest; do
        without+=("-DCMAKE_DISABLE_FIND_PACKAGE_$package=ON")
    done
    "$cmake" -S $way -B $way/build -G Ninja -DCMAKE_C_COMPILER="$cc" -DCMAKE_CXX_COMPILER="$cxx" "${without[@]}" \
        -DACDF_BUILD_ONCE=ON >$way.log 2>&1 || { cat $way.log; exit 1; }
    ninja -C $way/build -t targets all | sed -n 's/^\(acdf[a-z_]*\|test[a-z_]*\|manual\|package\): .*/\1/p' >$way.targets
    if grep -vx 'acdf_reader' $way.targets; then echo "targets that nobody asked for ($way)" >&2; exit 1; fi
    grep -qx 'acdf_reader' $way.targets
    grep -qx 'CMAKE_BUILD_TYPE:[A-Z]*=' $way/build/CMakeCache.txt
done

"$cmake" --build add/build >>add.log 2>&1 || { cat add.log; exit 1; } # not optimised, as asked
add/build/renderer "$source/tests/golden/v1.0/halvings_zlib.acdf" | grep -q '^total '
"$cmake" --install add/build --prefix "$work/installed" >>add.log
diff <(cd installed && find . -type f) <(echo ./bin/renderer)
