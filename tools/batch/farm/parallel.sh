#!/usr/bin/env bash
# Converts a library on several machines with GNU parallel, over ssh, a shard at a time:
#
#   SHARDS=64 PARALLEL='--sshlogin node1,node2,node3' tools/batch/farm/parallel.sh OUT INPUT... [OPTION...]
#
# with the inputs and options of `acdf batch`, best as absolute paths that all machines share. Options of parallel go
# into $PARALLEL; acdf is in the PATH of the machines, or $ACDF is its path. A shard that fails is tried once more; then
# reports are merged. A shard uses all threads of its
# machine, so one at a time is enough; $JOBS is the number of them a machine.
set -euo pipefail

if (($# < 2)); then
    echo "usage: [SHARDS=N] $0 OUT INPUT... [OPTION...]" >&2
    exit 2
fi
out=$1
shift
shards=${SHARDS:-16}
acdf=${ACDF:-acdf}

mkdir -p "$out/reports"
rm -f "$out"/reports/*.json
command=$(printf '%q ' "$acdf" batch "$@" -o "$out" --json --quiet)
status=0
seq "$shards" |
    parallel --jobs "${JOBS:-1}" --retries 2 --joblog "$out/reports/parallel.log" --workdir "$PWD" \
        "$command --shard {}/$shards >$(printf %q "$out")/reports/{}.json" || status=$?
"$acdf" batch --merge-reports "$out"/reports/*.json || status=1
exit "$((status > 0))"
