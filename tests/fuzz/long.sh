#!/usr/bin/env bash
# long.sh [--minutes N] [--build DIR] [NAME...]: every fuzzer, or those named (fuzz_reader, fuzz_npy, ...), one after another, N minutes
# each (60) on all cores. For a schedule (.ci/nightly), beside the seconds of each run of the tests.
# Builds with clang and sanitizers in build/asan first, unless --build names a folder where that was done. What a run finds is where
# the next one goes on (tests/fuzz/found/NAME of the build folder). Exit code 1 where an input broke something: it is named, lies in
# tests/fuzz/crashes of the build folder, and belongs into tests/fuzz/regressions/NAME once it is mended.
set -euo pipefail
root=$(realpath "$(dirname "${BASH_SOURCE[0]}")/../..")
minutes=60 build=
while (($# > 0)); do
    case $1 in
        --minutes) minutes=$2; shift 2 ;;
        --build) build=$(realpath "$2"); shift 2 ;;
        fuzz_*) break ;;
        *) sed -n '2s/^# //p' "$0" >&2; exit 2 ;;
    esac
done
seconds=$(awk -v m="$minutes" 'BEGIN { s = int(60 * m); if (s < 1) exit 1; print s }') || { echo "--minutes $minutes: is no time" >&2; exit 2; }
jobs=$(nproc)
names=("$@")
if ((${#names[@]} == 0)); then
    for source in "$root"/tests/fuzz/fuzz_*.cpp; do names+=("$(basename "$source" .cpp)"); done
fi

if [[ -z $build ]]; then
    build=$root/build/asan
    (cd "$root" && cmake --preset asan -DACDF_TEST_DATA=/nonexistent >/dev/null)
    cmake --build "$build" --parallel "$jobs" --target make_corpus "${names[@]}"
fi
cd "$build/tests/fuzz"
corpus=corpus
mkdir -p "$corpus" crashes
if [[ -x ./make_corpus ]]; then ./make_corpus "$corpus"; fi

broken=0
for name in "${names[@]}"; do
    inputs=("found/$name")
    mkdir -p "found/$name" "$corpus/$name"
    for folder in "$corpus/$name" "$root/tests/fuzz/regressions/$name" "$root/tests/fuzz/seeds/$name"; do
        if [[ -d $folder ]]; then inputs+=("$folder"); fi
    done
    options=(-max_total_time="$seconds" -max_len=4096 -timeout=25 -print_final_stats=1 "-artifact_prefix=$PWD/crashes/$name-")
    dictionary=$root/tests/fuzz/${name#fuzz_}.dict
    if [[ -f $dictionary ]]; then options+=(-dict="$dictionary"); fi
    printf '\n== %s, %s minutes on %s cores\n' "$name" "$minutes" "$jobs"
    # Processes that start anew: leaks and fragments of one do not end the others.
    if ! "./$name" -fork="$jobs" "${options[@]}" "${inputs[@]}"; then broken=1; fi
done
if ((broken)); then
    echo
    echo "Inputs that broke something:"
    ls -l "$PWD/crashes"
fi
exit "$broken"
