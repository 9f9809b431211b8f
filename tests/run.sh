#!/usr/bin/env bash
# Everything that must hold, from a bare Debian 12: installs what is missing, then
#   0. builds optimised with warnings as errors, while packages are still being installed, and checks the formatting,
#   1. builds libraries, the program and tests of the reader with clang, AddressSanitizer and UndefinedBehaviorSanitizer, and
#      links the other tests with them; runs the tests on synthetic data, and beside them fuzzes the reader for ten
#      seconds, and every parser of our own for 3,
#   2. compares the files that both builds make byte for byte,
#   3. runs all tests of the optimised build, those on real data too where it is present.
# Fails at the first stage that fails. May be run again at any time; later runs build only what changed.
#
#   tests/run.sh            all of it
#   tests/run.sh --quick    the optimised build and its tests, without real data, farms, and packages that are made of it
#
# ACDF_TEST_DATA: the folder of real data, if it is not ../shared/data.
set -euo pipefail

quick=false
case "${1-}" in
    "") ;;
    --quick) quick=true ;;
    *) echo "usage: tests/run.sh [--quick]" >&2; exit 2 ;;
esac
data=${ACDF_TEST_DATA:+$(realpath -m "$ACDF_TEST_DATA")}
cd "$(dirname "${BASH_SOURCE[0]}")/.."
data=${data:-$PWD/../shared/data}
if $quick; then data=/nonexistent; fi

jobs=$(nproc)
log=build/release/ctest.log
installing= # the process that installs the packages of tests

step() { printf '\n== %s (%ds)\n' "$*" "$SECONDS"; }

install_for_tests() {
    tools/install_packages.sh test
    # Daemons: as root only, as on machines that are thrown away. Tests that find none are skipped.
    if ((EUID == 0)); then tools/install_packages.sh farm || true; fi
}

# Unpacking keeps less than one core busy.
begin_to_install_for_tests() {
    mkdir -p build
    install_for_tests >build/packages.log 2>&1 &
    installing=$!
    trap 'wait "$installing"' EXIT # never ended half way
}

end_to_install_for_tests() {
    local status=0
    wait "$installing" || status=$?
    trap - EXIT
    ((status == 0)) || cat build/packages.log >&2
    return "$status"
}

check_formatting() {
    find format lib tools tests docs \( -name '*.h' -o -name '*.c' -o -name '*.cpp' \) -print0 |
        xargs -0 -n 50 -P "$jobs" clang-format --dry-run -Werror
}

run_sanitized_tests() {
    # Real data is left to the release build: sanitizers make it many times slower and it adds no code paths.
    # Tests that only drive libraries and the program are not compiled again (tests/CMakeLists.txt).
    cmake --preset asan -DACDF_TEST_DATA=/nonexistent -DACDF_TESTS_FROM="$PWD/build/release"
    cmake --build --preset asan --parallel "$jobs"
    # Of tests that drive the program and its libraries for minutes, a share: all of them run in the optimised build.
    local long='^test_(octahedral_command|(render|tools|build_local|build_partner|local_tools|builder)\.[1-9])'
    # One more than there are cores, as below: fuzzers end by the clock.
    ctest --preset asan --parallel "$((jobs + 1))" --label-exclude packaging --exclude-regex "$long"
}

build_release() {
    cmake --preset release -DACDF_BUILD_ONCE=ON -DACDF_TEST_DATA="$data"
    cmake --build --preset release --parallel "$jobs"
}

run_all_builds_alike() {
    tests/same_bytes.sh build/release/tools/acdf build/asan/tools/acdf
}

run_tests() { # OPTIONS of ctest
    # One more than there are cores, for some wait: for browsers, for daemons of farms, for what they had killed.
    # ctest lists skipped tests after its summary; the summary is to be the last line.
    local status=0
    ctest --preset release --parallel "$((jobs + 1))" "$@" 2>&1 | tee "$log" || status=$?
    grep 'tests passed' "$log" || true
    return "$status"
}

if $quick; then
    step "Packages, and libraries that need few of them"
    tools/first_build.sh build images quick
    step "Optimised build, in build/release"
    build_release
    step "Its tests"
    run_tests --label-exclude 'packaging|farm'
    exit
fi
step "Packages, and libraries that need few of them"
tools/first_build.sh build images quick
step "0. Optimised build, in build/release, and formatting"
begin_to_install_for_tests
build_release
end_to_install_for_tests
check_formatting
build_release # once more, with the tests of what is installed now
step "1. Tests with sanitizers and fuzzers, in build/asan"
run_sanitized_tests
step "2. The same bytes from both builds, with any number of threads"
run_all_builds_alike
step "3. All tests, optimised, in build/release"
run_tests
