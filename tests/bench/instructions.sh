# Sourced: instructions PROGRAM WHAT FILE [walk] prints those of one call, from two runs that differ by 100000 of them. Needs
# valgrind; $build is a release build with benchmarks.
instructions() {
    local bench=$build/tests/bench/$1 what=$2 file=$3 counts=() n
    shift 3
    for n in 1000 101000; do
        counts+=("$(valgrind --tool=callgrind --callgrind-out-file=/dev/null "$bench" --count "$what" "$file" "$n" "$@" 2>&1 |
            sed -n 's/.*Collected : //p')")
    done
    echo $(((counts[1] - counts[0]) / 100000))
}
