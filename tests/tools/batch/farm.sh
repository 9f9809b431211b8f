#!/usr/bin/env bash
# Tests the scripts of tools/batch/farm on the engines they are for, all on loopback and in a folder of their own:
#
#   farm.sh ninja|parallel|slurm ACDF MAKE_BATCH_PROBES
#
# Installs the packages that are missing where it may (as root, on Debian), else exits with 77:
# skipped. Every engine has to end with the bytes of one undisturbed `acdf batch`, and without litter.
set -euo pipefail

engine=$1
acdf=$2
make_probes=$3
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../../.." && pwd)
farm=$(cd "$root/tools/batch/farm" && pwd)
work=$(mktemp -d "${TMPDIR:-/tmp}/acdf-farm-XXXXXX")
daemons=()

clean_up() {
    if [[ -e $work/slurm.conf ]]; then # never another cluster's jobs
        SLURM_CONF=$work/slurm.conf scancel --user="$(id -un)" 2>/dev/null && sleep 1
    fi
    for pid in "${daemons[@]}"; do kill "$pid" 2>/dev/null || true; done
    for pid in "${daemons[@]}"; do wait "$pid" 2>/dev/null || true; done
    rm -rf "$work"
}
trap clean_up EXIT

fail() {
    echo "FAILED: $*" >&2
    for log in "$work"/*.log; do [[ -s $log ]] && { echo "== $log"; tail -n 30 "$log"; } >&2; done
    exit 1
}

need() {
    command -v "$1" >/dev/null && return
    if ((EUID == 0)) && command -v apt-get >/dev/null; then
        "$root/tools/install_packages.sh" farm >"$work/install.log" 2>&1 || true
    fi
    command -v "$1" >/dev/null && return
    echo "SKIPPED: there is no $1; run tools/install_packages.sh farm, or this as root on Debian"
    exit 77
}

# Waits up to a minute for a command to succeed.
await() {
    for ((i = 0; i < 600; ++i)); do
        if "$@" >/dev/null 2>&1; then return; fi
        sleep 0.1
    done
    fail "waited in vain for: $*"
}

# The files that were made are those of the undisturbed run.
expect_same() {
    (cd "$work/expected" && find . -type f | sort) >"$work/expected.list"
    # A task that is ended while the next one starts may leave its temporary file to the run after that.
    (cd "$1" && find . -type f -name '*.acdf' ! -name '.acdf-*' | sort) >"$work/made.list"
    cmp "$work/expected.list" "$work/made.list" || fail "other files were made"
    while read -r file; do cmp "$work/expected/$file" "$1/$file" || fail "$file differs"; done <"$work/expected.list"
    [[ -z $(find "$1" -name '.acdf-*') ]] || fail "temporary files are left in $1"
}

options=(--kind "env,local" --set local.budget=16KiB --set env.cells=100)

test_ninja() {
    need ninja
    local out=$work/out
    count() { grep -c '^\[[0-9]*/[0-9]*\] .*\.acdf' "$work/ninja.log" || true; }
    build() { ACDF=$acdf "$farm/ninja.sh" "$out" "$work/probes" "${options[@]}" "$@" >"$work/ninja.log" 2>&1; }

    build || fail "ninja.sh"
    [[ $(count) == 16 ]] || fail "$(count) jobs ran, not 16"
    expect_same "$out"
    build || fail "ninja.sh, again"
    [[ $(count) == 0 ]] || fail "$(count) jobs ran though nothing had changed"

    "$make_probes" "$work/other" 1 40
    cp "$work/other/probe000.pfm" "$work/probes/probe003.pfm"
    ninja -C "$out" >"$work/ninja.log" 2>&1 || fail "ninja"
    [[ $(count) == 2 ]] || fail "$(count) jobs ran for a source that changed"

    cp "$work/other/probe000.pfm" "$work/probes/new.pfm" # found without the script: the build file depends on folders
    ninja -C "$out" >"$work/ninja.log" 2>&1 || fail "ninja"
    [[ $(count) == 2 ]] || fail "$(count) jobs ran for a source that is new"
    rm "$work/probes/new.pfm" "$out"/new.*

    build --set env.filter=bilinear || fail "ninja.sh with another option"
    [[ $(count) == 8 ]] || fail "$(count) jobs ran for an option of env"

    echo "no probe" >"$work/probes/probe004.pfm"
    rm "$out/probe005.acdf"
    if build --set env.filter=bilinear; then fail "ninja.sh does not tell failures"; fi
    [[ -f $out/probe005.acdf ]] || fail "ninja.sh stops at a failure"
}

test_parallel() {
    need parallel
    SHARDS=5 JOBS=2 ACDF=$acdf PARALLEL=--will-cite \
        "$farm/parallel.sh" "$work/out" "$work/probes" "${options[@]}" >"$work/parallel.log" 2>&1 || fail "parallel.sh"
    grep -q '^all .* 16 .* 0 ' "$work/parallel.log" || fail "the table does not tell 16 jobs"
    expect_same "$work/out"
    echo "no probe" >"$work/probes/probe004.pfm"
    if SHARDS=5 ACDF=$acdf PARALLEL=--will-cite \
        "$farm/parallel.sh" "$work/out" "$work/probes" "${options[@]}" >"$work/parallel.log" 2>&1; then
        fail "parallel.sh does not tell failures"
    fi
    grep -q 'probe004.pfm: ' "$work/parallel.log" || fail "the failure is not named"
}

start() {
    "$@" >>"$work/$(basename "$1").log" 2>&1 &
    daemons+=($!)
}

start_slurm() {
    local host port=$((20000 + $$ % 20000))
    host=$(hostname -s)
    mkdir -p "$work/run" "$work/state" "$work/spool"
    chmod 755 "$work"
    (umask 077 && head -c 1024 /dev/urandom >"$work/munge.key")
    start munged --foreground --force --socket="$work/run/munge" --key-file="$work/munge.key" \
        --pid-file="$work/run/munged.pid" --log-file="$work/munge.log" --seed-file="$work/munge.seed"
    cat >"$work/slurm.conf" <<CONF
ClusterName=acdf
SlurmctldHost=$host(127.0.0.1)
SlurmUser=$(id -un)
SlurmdUser=root
AuthType=auth/munge
AuthInfo=socket=$work/run/munge
SlurmctldPort=$port
SlurmdPort=$((port + 1))
StateSaveLocation=$work/state
SlurmdSpoolDir=$work/spool
SlurmctldPidFile=$work/run/slurmctld.pid
SlurmdPidFile=$work/run/slurmd.pid
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
SwitchType=switch/none
MpiDefault=none
CommunicationParameters=NoAddrCache
SchedulerParameters=sched_interval=1,batch_sched_delay=0
KillWait=1
ReturnToService=2
NodeName=$host NodeAddr=127.0.0.1 CPUs=$(nproc) State=UNKNOWN
PartitionName=main Nodes=ALL Default=YES MaxTime=INFINITE State=UP
CONF
    export SLURM_CONF=$work/slurm.conf
    await test -S "$work/run/munge"
    start slurmctld -D -f "$SLURM_CONF"
    start slurmd -D -f "$SLURM_CONF"
    await node_is_up
}

node_is_up() { [[ $(sinfo -h -o %T) =~ idle|mixed ]]; }

# By itself Slurm waits two minutes before it starts a job again.
has_ended() {
    scontrol update "JobId=$1" StartTime=now >/dev/null 2>&1 || true
    [[ -z $(squeue -h) ]]
}

# In place of acdf: the second task, at its first start, is killed in the middle of its shard and hangs.
write_interrupted_acdf() {
    cat >"$work/acdf" <<SCRIPT
#!/usr/bin/env bash
if [[ \$SLURM_ARRAY_TASK_ID != 2 || \${SLURM_RESTART_COUNT:-0} != 0 ]]; then exec "$acdf" "\$@"; fi
outputs=(\$("$acdf" "\$@" --dry-run | sed -n 's/.*"output": "\(.*\)".*/\1/p'))
has_begun() { for output in "\${outputs[@]}"; do [[ ! -e $work/out/\$output ]] || return 0; done; return 1; }
"$acdf" "\$@" &
until has_begun; do :; done
kill -KILL \$!
wait
touch "$work/out/.acdf-Stale0.acdf" "$work/killed"
exec sleep 600
SCRIPT
    chmod +x "$work/acdf"
}

test_slurm() {
    need slurmctld
    need slurmd
    need munged
    if ((EUID != 0)); then
        echo "SKIPPED: slurmd has to be started as root"
        exit 77
    fi
    if [[ -z $(ls -A /sys/fs/cgroup 2>/dev/null) ]]; then
        echo "SKIPPED: slurmd needs control groups, and none are mounted on /sys/fs/cgroup"
        exit 77
    fi
    start_slurm
    write_interrupted_acdf
    local job
    job=$(ACDF=$work/acdf sbatch --parsable --array=1-4 --output="$work/task.%a.log" \
        "$farm/slurm.sh" "$work/out" "$work/probes" "${options[@]}")
    await test -e "$work/killed"
    await scontrol requeue "${job}_2"
    sleep 3 # what starts within the second of a kill, Slurm takes for what was killed
    await has_ended "${job}_2"
    expect_same "$work/out"
    "$acdf" batch --merge-reports "$work/out/reports/$job"/*.json >"$work/merged.log" || fail "reports"
    grep -q '^all .* 16 .* 0 ' "$work/merged.log" || fail "the table does not tell 16 jobs"
    grep -q '"up to date"' "$work/out/reports/$job/2.json" || fail "task 2 did not go on where it was killed"
}

"$make_probes" "$work/probes" 8 40
"$acdf" batch "$work/probes" -o "$work/expected" "${options[@]}" --quiet
"test_$engine"
echo "$engine: all 16 files as expected"
