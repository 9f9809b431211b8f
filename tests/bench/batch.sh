#!/usr/bin/env bash
# What `acdf batch` costs beside the work of its jobs, as a table: batch.sh ACDF MAKE_BATCH_PROBES. Needs jq. The
# figures of docs/appendix/batch.md, to be made on a quiet machine.
set -euo pipefail

acdf=$1
make_probes=$2
work=$(mktemp -d "${TMPDIR:-/tmp}/acdf-bench-XXXXXX")
trap 'rm -rf "$work"' EXIT

# timed NAME COMMAND...: seconds into the variable, stdout into the file of that name.
timed() {
    local name=$1 start end
    shift
    start=$(date +%s%N)
    "$@" >"$work/$name"
    end=$(date +%s%N)
    printf -v "$name" '%s' "$(jq -n "($end - $start) / 1e9")"
}

"$make_probes" "$work/tiny" 1000 4
timed first "$acdf" batch "$work/tiny" -o "$work/out" --set env.cells=10 --threads 1 --json
timed again "$acdf" batch "$work/tiny" -o "$work/out" --set env.cells=10 --threads 1 --json
own=$(jq '[.jobs[].seconds] | add' "$work/first")
jq -rn "\"| 1000 tiny probes, one thread: each | \(($first - $own) * 1000 / 1000 * 100 | round / 100) ms beside the \
\($own * 100 | round / 100) ms of its own work |
| the same, up to date | \($again * 100 | round / 100) ms each |\""

seq 100000 | sed 's/.*/{"source": "tiny\/probe000.pfm", "output": "&.acdf"}/' >"$work/library.jsonl"
timed lines "$acdf" batch "$work/library.jsonl" -o "$work/none" --dry-run --quiet
echo "| a manifest of 10^5 lines: checked, dry run | $lines s |"

"$make_probes" "$work/large" 8 256
for n in 1 2 4; do
    ((n <= $(nproc))) || continue
    timed "workers$n" "$acdf" batch "$work/large" -o "$work/out$n" --kind local --threads "$n" --quiet
    name=workers$n
    echo "| 8 local maps of 512x256, $n at once | ${!name} s, $(jq -n "$workers1 / ${!name} * 100 | round / 100") times as fast as one |"
done
