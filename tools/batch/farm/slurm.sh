#!/usr/bin/env bash
# A Slurm array job that converts a library of probes and BRDFs, each task a shard of it:
#
#   sbatch --array=1-8 --cpus-per-task=4 --mem=16G tools/batch/farm/slurm.sh OUT INPUT... [OPTION...]
#
# with the inputs and options of `acdf batch`. All nodes see the inputs and OUT under the same names, and have acdf in
# their PATH, or in $ACDF. A task that is killed and requeued goes on where it was. When all have ended:
#
#   acdf batch --merge-reports OUT/reports/JOB/*.json
#
#SBATCH --job-name=acdf
#SBATCH --requeue
#SBATCH --open-mode=append
set -euo pipefail

if (($# < 2)); then
    echo "usage: sbatch --array=1-N $0 OUT INPUT... [OPTION...]" >&2
    exit 2
fi
out=$1
shift

limits=(--threads "${SLURM_CPUS_PER_TASK:-1}")
# Slurm's unit is MiB. A quarter is left for what estimates miss.
memory=${SLURM_MEM_PER_NODE:-$((${SLURM_MEM_PER_CPU:-0} * ${SLURM_CPUS_PER_TASK:-1}))}
if ((memory > 0)); then limits+=(--memory "$((memory * 3 / 4))MiB"); fi

reports="$out/reports/$SLURM_ARRAY_JOB_ID"
mkdir -p "$reports"
report="$reports/$SLURM_ARRAY_TASK_ID.json"
status=0
"${ACDF:-acdf}" batch "$@" -o "$out" --shard slurm --json --quiet "${limits[@]}" >"$report.part" || status=$?
# There is a report also where jobs failed; none where nothing was started.
if [[ -s $report.part ]]; then mv "$report.part" "$report"; else rm -f "$report.part"; fi
exit "$status"
