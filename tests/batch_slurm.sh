#!/bin/bash
# batch_slurm.sh [BUILD]: the example array (assets/batch/slurm_array.sh) on a real Slurm of one node, which it starts by
# itself in a folder of its own (munge, slurmctld, slurmd on 127.0.0.1; as root): 200 jobs in 8 tasks, one of which is
# requeued in the midst. The table that is merged must be, byte for byte, that of a single run.
# SCANS=N: how many of the jobs are three scans onto a body; the others are 2D poses, which take a thirtieth of the time
# (default: all).
set -euo pipefail
cd "$(dirname "$(readlink -f "$0")")/.."
program=$(readlink -f "${1:-build}")/understudy
jobs=200 tasks=8 scans=${SCANS:-200} host=$(hostname -s)
. cmake/build.sh
install_packages slurm
[ "$(id -u)" -eq 0 ] || { echo "slurmd needs root" >&2; exit 1; }

work=$(mktemp -d)
chmod 755 "$work"
stop() {
  [ -z "${array:-}" ] || scancel "$array" 2>/dev/null || true
  for _ in $(seq 40); do
    [ -n "${array:-}" ] && squeue -h -j "$array" 2>/dev/null | grep -q . || break
    sleep 0.5
  done
  for daemon in slurmd slurmctld munged; do
    [ ! -s "$work/$daemon.pid" ] || kill "$(cat "$work/$daemon.pid")" 2>/dev/null || true
  done
  sleep 1
  rm -rf "$work"
}
trap stop EXIT
fail() {
  echo "batch_slurm.sh: $1" >&2
  tail -5 "$work"/*.log >&2
  exit 1
}
# until_true SECONDS COMMAND...: false when it never was.
until_true() {
  local end=$((SECONDS + $1))
  shift
  until "$@"; do
    [ $SECONDS -lt $end ] || return 1
    sleep 0.3
  done
}

# Slurm of one node.
head -c 1024 /dev/urandom >"$work/munge.key"
chmod 600 "$work/munge.key"
munged --force --key-file="$work/munge.key" --socket="$work/munge.sock" --pid-file="$work/munged.pid" \
  --log-file="$work/munged.log" --seed-file="$work/munge.seed"
export SLURM_CONF=$work/slurm.conf
mkdir "$work/state" "$work/spool"
port=$((20000 + RANDOM % 20000))
cat >"$SLURM_CONF" <<EOF
ClusterName=understudy
SlurmctldHost=$host(127.0.0.1)
SlurmctldPort=$port
SlurmdPort=$((port + 1))
AuthType=auth/munge
AuthInfo=socket=$work/munge.sock,cred_expire=5
SlurmUser=root
SlurmdUser=root
StateSaveLocation=$work/state
SlurmdSpoolDir=$work/spool
SlurmctldPidFile=$work/slurmctld.pid
SlurmdPidFile=$work/slurmd.pid
SlurmctldLogFile=$work/slurmctld.log
SlurmdLogFile=$work/slurmd.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SwitchType=switch/none
MpiDefault=none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
ReturnToService=2
KillWait=20
SchedulerParameters=batch_sched_delay=0,sched_interval=2
NodeName=$host NodeAddr=127.0.0.1 CPUs=$(nproc) RealMemory=4000 State=UNKNOWN
PartitionName=main Nodes=$host Default=YES MaxTime=INFINITE State=UP
EOF
touch "$work/cgroup.conf"
slurmctld || fail "slurmctld does not start"
slurmd || fail "slurmd does not start"
node_is_up() { [ "$(sinfo -h -o %t 2>/dev/null)" = idle ]; }
until_true 60 node_is_up || fail "the node does not come up"

# The jobs.
mkdir "$work/data"
for k in $(seq 0 $((jobs - 1))); do
  mkdir -p "$work/data/scans/$k" "$work/data/poses/$k"
  for i in 0 1 2; do
    cp "$(printf 'assets/samples/scan/frame_%05d.ply' $(((k + i) % 80)))" "$work/data/scans/$k"
    cp "$(printf 'assets/samples/poses/poses_%012d_keypoints.json' $(((k + i) % 80)))" "$work/data/poses/$k"
  done
  source=poses/$k target=reference.json
  [ $((k * scans / jobs)) -eq $(((k + 1) * scans / jobs)) ] || { source=scans/$k target=target_adult.glb; }
  printf '{"id": "job%03d", "source": "%s", "target": "%s"}\n' "$k" "$source" "$target"
done >"$work/data/jobs.jsonl"
cp assets/samples/reference.json assets/samples/target_adult.glb "$work/data"

# In an array, one task of which is requeued when it has done something.
began=$SECONDS
export UNDERSTUDY=$program
cd "$work"
array=$(sbatch --parsable --export=ALL "$OLDPWD/assets/batch/slurm_array.sh" data/jobs.jsonl out)
done_of_first() { find out -name '*.done.json' 2>/dev/null | tr -dc '0-9\n' | awk -v n=$tasks '$1 % n == 0' | wc -l; }
some_is_done() { [ "$(done_of_first)" -ge 2 ]; }
until_true 300 some_is_done || fail "no task does anything"
scontrol requeue "${array}_0"
before=$(done_of_first)
nobody_is_left() { [ -z "$(squeue -h -j "$array" 2>/dev/null)" ]; }
until_true 3000 nobody_is_left || fail "the array does not end"
cat understudy-"${array}"_0.log
grep -q "interrupted; what is done stays" understudy-"${array}"_0.log || fail "the requeued task was not told to end"
grep -qE "[0-9]+ done, [1-9][0-9]* done before, 0 failed, 0 left" understudy-"${array}"_0.log ||
  fail "the requeued task did not go on where it was ($before jobs done)"
echo "the array: $((SECONDS - began)) s"

# Alone, without what Slurm says.
began=$SECONDS
env -u SLURM_CONF "$program" batch data/jobs.jsonl --out alone >alone.log 2>&1 || fail "the single run fails"
echo "alone: $((SECONDS - began)) s"
"$program" batch data/jobs.jsonl --out out --merge array.csv
"$program" batch data/jobs.jsonl --out alone --merge alone.csv
[ "$(wc -l <alone.csv)" -eq $((jobs + 1)) ] || fail "the table has $(wc -l <alone.csv) lines"
cmp array.csv alone.csv || fail "the tables differ"
echo "An array of $tasks tasks, one of them requeued, gives the table of a single run:" \
  "$jobs jobs, $(wc -c <alone.csv) bytes."
