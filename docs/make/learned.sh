#!/usr/bin/env bash
# learned.sh DATA [SCENE...]: writes the table of learned visibility cells in docs/visibility.md. DATA holds probes/;
# scenes: those of docs/make/visibility_scenes.py. BENCH names the program (default: build/release/tests/bench/bench_visibility,
# of a build with -DACDF_BUILD_BENCHMARKS=ON); POINTS is how many of those that the camera sees are asked (default: 100).
# A scene takes two minutes.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
data=$(cd "${1:?usage: learned.sh DATA [SCENE...]}" && pwd)
shift
scenes=${*:-room courtyard trees roof open_ground car}
bench=${BENCH:-$root/build/release/tests/bench/bench_visibility}
results=${RESULTS:-$root/build/visibility}
mkdir -p "$results"
python3 "$root/docs/make/visibility_scenes.py" "$results" > /dev/null
{
    echo "| scene | sampler | relative variance | gain | learned in | z |"
    echo "|---|---|---|---|---|---|"
    for scene in $scenes; do
        "$bench" trimmed "$results/$scene.json" "$data" "${POINTS:-100}" "mis(full-cdf,cosine)" \
            "mis(local:1MB --mis cosine,cosine)" "mis(visibility:4MB --mis cosine,cosine)" "mis(learned:4MB,cosine)" "mis(learned:4MB --mis cosine,cosine)" | sed "s/^/| $scene /"
    done
} | "$root/docs/make/put_table.sh" learned
