#!/usr/bin/env bash
# Do the smoke run (config/smoke.yaml, little data) on a Slurm of one node and locally, and fail
# unless the results have the same bytes.
#   make slurm, or profiles/slurm/try.sh [PATH OF SNAKEMAKE]
# Do another run on such a Slurm, with results in the repository and without comparison:
#   profiles/slurm/try.sh PATH-OF-SNAKEMAKE TARGETS --configfile FILE
# This Slurm runs in its own Linux namespaces (processes, network, mounts) and ends with them.
# Nothing outside changes, and no other Slurm is affected.
set -euo pipefail

stop() {
    echo "profiles/slurm/try.sh: $1" >&2
    exit 1
}

cd "$(dirname "$0")/../.."
snakemake=${1:-snakemake}

if [[ -z ${SLURM_TRIAL:-} ]]; then
    for tool in munged slurmctld slurmd sbatch ip unshare; do
        command -v "$tool" > /dev/null || stop "there is no $tool; on Debian:
    apt-get install slurmctld slurmd slurm-client munge iproute2"
    done
    [[ $(id -u) == 0 ]] || stop "must be run by root: slurmd starts jobs for any user"
    unshare --mount --net --pid --fork true ||
        stop "namespaces are not allowed here (see above); a container must be privileged"
    SLURM_TRIAL=$(mktemp -d)
    export SLURM_TRIAL
    trap 'rm -rf "$SLURM_TRIAL"' EXIT
    # When the first process of the namespace ends, the kernel ends all others in it.
    unshare --mount --net --pid --fork --kill-child --mount-proc "$0" "$@" &
    trap 'kill -KILL $!' INT TERM
    wait $!
    exit
fi

# From here on inside the namespaces.
chmod 755 "$SLURM_TRIAL"
mkdir "$SLURM_TRIAL"/{etc,state,spool,local,slurm}
ip link set lo up
# Slurm ignores 127.0.0.1 when it looks for an address of the host, so it needs another one.
ip address add 127.0.0.2/8 dev lo
node=$(hostname -s)
memory=$(awk '/MemTotal/ { print int($2 / 1024) }' /proc/meminfo)
cat > "$SLURM_TRIAL/etc/slurm.conf" << END
ClusterName=trial
SlurmctldHost=$node(127.0.0.1)
SlurmUser=root
AuthInfo=socket=$SLURM_TRIAL/munge.socket
StateSaveLocation=$SLURM_TRIAL/state
SlurmdSpoolDir=$SLURM_TRIAL/spool
SlurmctldPidFile=$SLURM_TRIAL/slurmctld.pid
SlurmdPidFile=$SLURM_TRIAL/slurmd.pid
SlurmctldLogFile=$SLURM_TRIAL/slurmctld.log
SlurmdLogFile=$SLURM_TRIAL/slurmd.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
MpiDefault=none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU_Memory
MinJobAge=86400
NodeName=$node NodeAddr=127.0.0.1 CPUs=$(nproc) RealMemory=$memory
PartitionName=trial Nodes=$node Default=YES MaxTime=INFINITE State=UP
END
# Jobs read Slurm's configuration in /etc/slurm, whatever the environment says.
mount --bind "$SLURM_TRIAL/etc" /etc/slurm
head -c 1024 /dev/urandom > "$SLURM_TRIAL/munge.key"
chmod 400 "$SLURM_TRIAL/munge.key"
munged --key-file="$SLURM_TRIAL/munge.key" --socket="$SLURM_TRIAL/munge.socket" \
    --pid-file="$SLURM_TRIAL/munged.pid" --log-file="$SLURM_TRIAL/munged.log" \
    --seed-file="$SLURM_TRIAL/munge.seed"
slurmctld
slurmd
for _ in {1..30}; do
    [[ $(sinfo --noheader --format=%t) == idle ]] && break
    sleep 1
done
sinfo
[[ $(sinfo --noheader --format=%t) == idle ]] ||
    stop "the node does not come up: $(grep -h -E 'error|fatal' "$SLURM_TRIAL"/*.log | tail -n 5)"

if (($# > 1)); then
    "$snakemake" --profile profiles/slurm "${@:2}"
    echo "Jobs of Slurm:"
    squeue --noheader --states=all --format=%T | sort | uniq --count
    exit
fi
run() {
    "$snakemake" --directory "$SLURM_TRIAL/$1" --configfile config/smoke.yaml "${@:2}"
}
run local --cores "$(nproc)"
run slurm --profile profiles/slurm
# Only logs, times and the record of the run may differ.
diff --recursive --brief --exclude=logs --exclude=timings --exclude=benchmarks \
    --exclude=provenance.json "$SLURM_TRIAL"/{local,slurm}/results-smoke ||
    stop "Slurm and the local run differ, as listed above"
echo "The same bytes from a local run and from Slurm, whose jobs were:"
squeue --noheader --states=all --format=%T | sort | uniq --count
