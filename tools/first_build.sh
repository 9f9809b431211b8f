#!/usr/bin/env bash
# first_build.sh SET...: installs sets of tools/packages.txt, those packages first that the libraries without images need, and
# compiles these libraries, in build/release, while the others are unpacked: that keeps less than one core busy. What
# is configured there next finds their objects, and no option of theirs. Where there is a build already, or nothing may be
# installed, it is install_packages.sh.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

may_install() { command -v apt-get && { ((EUID == 0)) || command -v sudo; }; } >/dev/null

if [[ -e build/release ]] || ! may_install; then
    exec tools/install_packages.sh "$@"
fi
tools/install_packages.sh first
mkdir -p build/release
tools/install_packages.sh "$@" >build/packages.log 2>&1 &
installing=$!

end() {
    local status=$?
    wait "$installing" || { status=1 && cat build/packages.log >&2; } # never ended half way
    rm -f build/release/CMakeCache.txt
    exit "$status"
}
trap end EXIT
cmake --preset release -DACDF_BUILD_ONCE=ON -DACDF_BUILD_BUILDER=ON -DACDF_BUILD_TOOLS=OFF -DACDF_BUILD_TESTS=OFF
cmake --build --preset release --target acdf_build --parallel "$(nproc)"
