#!/usr/bin/env bash
# scenes/farm with a real Slurm and with GNU parallel over a real ssh, both on this machine:
# tests/farm_engines.sh [WHIT] (build/whit). Needs root or sudo; exits 77 where there is no way to it.
#
# The daemons run in namespaces of their own, with a network, a /run and a home of their own, and with
# keys and configurations in a temporary folder. Those of the system are neither read nor changed, and
# whatever runs in the namespaces is gone when the script ends.
set -euo pipefail

root=$(cd "$(dirname "$0")/.." && pwd)
. "$root/tests/debian13.sh"

# Packages of daemons are installed only where that does not start them.
needPrograms() {
  local program missing=()
  for program in slurmctld slurmd sbatch munged sshd ssh parallel ip; do
    PATH=$PATH:/usr/sbin:/sbin command -v $program >/dev/null || missing+=("$program")
  done
  [ ${#missing[@]} -gt 0 ] || return 0

  if [ ! -x /usr/sbin/policy-rc.d ] || /usr/sbin/policy-rc.d ssh start; then
    cannot "${missing[*]} are missing, and installing them here could start servers"
  fi
  "$root/scenes/install_packages.sh" farm || cannot "${missing[*]} cannot be installed"
}

if [ "${1:-}" != within ]; then
  whit=$(realpath -m "${1:-$root/build/whit}")
  [ -x "$whit" ] || cannot "there is no $whit"
  needPrograms
  sudo=()
  if [ "$(id -u)" != 0 ]; then sudo=(sudo -n); fi
  apart=("${sudo[@]}" unshare --mount --pid --net --fork --kill-child)
  "${apart[@]}" true 2>/dev/null || cannot "no namespaces here"
  work=$(mktemp -d)
  trap '"${sudo[@]}" rm -rf --one-file-system "$work"' EXIT
  # In the background, so that a signal is not left waiting until the end.
  timeout --kill-after=5 180 "${apart[@]}" --mount-proc "$0" within "$whit" "$work" &
  trap 'kill $!; wait' INT TERM
  wait $!
  exit
fi

whit=$2 work=$3
export PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin HOME=$work/home TMPDIR=$work
cd "$work"
# The C library takes a machine without a second address for one that has no network.
ip link set lo up
ip address add 192.0.2.1/32 dev lo
mount -t tmpfs tmpfs /run
mkdir -p /run/sshd /run/munge home/.ssh state spool whole array threads large ssh
trap 'status=$?; [ $status = 0 ] || tail -n 6 ./*.log; exit $status' EXIT
trap 'echo "$0: line $LINENO: $BASH_COMMAND" >&2' ERR

# within SECONDS COMMAND...: waits until the command succeeds.
within() {
  local end=$((SECONDS + $1))
  shift
  until "$@" >/dev/null 2>&1; do
    if [ $SECONDS -ge $end ]; then
      echo "waited in vain for: $*" >&2
      return 1
    fi
    sleep 0.05
  done
}
# same FOLDER: its frames are those of one process, and nothing else is there.
same() { diff -r whole "$1"; }

# A frame takes about half a second, long enough to stop a task before its last one.
frames=0..7
options=(--size 64x40 --spp 512)
"$whit" render whitted -o "whole/####.exr" --frames $frames "${options[@]}" --quiet

# ---- Slurm ----

(umask 077 && head -c 128 /dev/urandom >/run/munge/key)
munged --key-file=/run/munge/key --seed-file=/run/munge/seed --log-file=/run/munge/log

# A requeued job waits for as long as the credential of its first run is valid. No task is bound to
# processors, as in Slurm by default: only slurm.sbatch tells whit how many it has.
host=$(hostname -s)
cat >slurm.conf <<END_OF_FILE
ClusterName=farm
SlurmctldHost=$host(127.0.0.1)
SlurmUser=root
AuthType=auth/munge
AuthInfo=cred_expire=5
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU_Memory
SchedulerParameters=sched_interval=1
JobAcctGatherType=jobacct_gather/linux
JobAcctGatherFrequency=task=1
JobAcctGatherParams=OverMemoryKill
MpiDefault=none
KillWait=2
ReturnToService=2
StateSaveLocation=$work/state
SlurmdSpoolDir=$work/spool
SlurmctldPidFile=$work/slurmctld.pid
SlurmdPidFile=$work/slurmd.pid
SlurmctldLogFile=$work/slurmctld.log
SlurmdLogFile=$work/slurmd.log
SlurmdParameters=config_overrides
NodeName=$host NodeAddr=127.0.0.1 CPUs=2 RealMemory=2000
PartitionName=farm Nodes=ALL Default=YES
END_OF_FILE
export SLURM_CONF=$work/slurm.conf WHIT=$whit CHUNK=4
slurmctld
slurmd
within 20 eval 'sinfo -h -o %T | grep -x idle'

# submit WORD...: the number of the job.
submit() { sbatch --parsable "$@"; }
# ended JOB STATE: waits for all tasks of the job, and fails if one has not ended like this.
ended() {
  within 60 eval "! squeue -h -j $1 | grep ."
  ! scontrol show job "$1" | grep JobState= | grep -v "JobState=$2 "
}
array() { submit --cpus-per-task=1 --mem=500 "$@" "${options[@]}"; }

# The first task is requeued when it has made a frame.
job=$(array --array=0-1 "$root/scenes/farm/slurm.sbatch" whitted "array/####.exr" $frames)
within 20 test -e array/0000.exr
scontrol requeue "${job}_0"
within 10 eval "scontrol show job ${job}_0 | grep JobState=PENDING"
before=$(cd array && ls -i 000[0-3].exr)
test "$(wc -l <<<"$before")" -lt 4
ended "$job" COMPLETED
scontrol show job "${job}_0" | grep -w Restarts=1 >/dev/null
same array
test "$(cd array && ls -i 000[0-3].exr | grep -cFx "$before")" = "$(wc -l <<<"$before")" # kept
echo "slurm: a requeued task has gone on after $(wc -l <<<"$before") of 4 frames"

for cpus in 1 2; do
  job=$(submit --cpus-per-task=$cpus --mem=500 --array=0 "$root/scenes/farm/slurm.sbatch" whitted "threads/####.exr" \
    0..0 --size 64x40 --json threads$cpus.json)
  ended "$job" COMPLETED
  grep "\"threads\": $cpus," threads$cpus.json
  rm threads/*
done

# Slurm looks once a second at how much memory a task has. By itself whit would take no more than it is
# given, and refuse the picture.
job=$(submit --cpus-per-task=1 --mem=100 --array=0 "$root/scenes/farm/slurm.sbatch" whitted "large/####.png" 0..0 \
  --size 6000x4000 --max-memory 4)
ended "$job" '\(FAILED\|CANCELLED\|OUT_OF_MEMORY\)'
grep -i -m 1 "exceeded .*memory limit" "whit-${job}_0.log"
test ! -e large/0000.png

# ---- GNU parallel over ssh ----

# Two machines: two addresses of this one. Root's home and a lock on its account are in the files of
# users, which have copies here.
sed "s,^\(root:.*\):[^:]*:\([^:]*\)$,\1:$HOME:\2," /etc/passwd >passwd
sed 's,^root:[^:]*,root:*,' /etc/shadow >shadow
mount --bind passwd /etc/passwd
mount --bind shadow /etc/shadow
for key in host user; do ssh-keygen -q -t ed25519 -N '' -f $key.key; done
cat >sshd_config <<END_OF_FILE
Port 2222
HostKey $work/host.key
AuthorizedKeysFile $work/user.key.pub
StrictModes no
PasswordAuthentication no
PermitRootLogin prohibit-password
PidFile none
END_OF_FILE
cat >home/.ssh/config <<END_OF_FILE
Port 2222
IdentityFile $work/user.key
UserKnownHostsFile $work/known_hosts
Host one
  HostName 127.0.0.1
Host two
  HostName 192.0.2.1
END_OF_FILE
for address in 127.0.0.1 192.0.2.1; do echo "[$address]:2222 $(cat host.key.pub)"; done >known_hosts
/usr/sbin/sshd -f sshd_config -E sshd.log

# Writes down its machine and port, its process, its frames and their threads, and is whit.
cat >recorder <<END_OF_FILE
#!/bin/sh
echo "\${SSH_CONNECTION#* * } \$\$ \$8 \$3" >>"$work/jobs"
exec "$whit" "\$@"
END_OF_FILE
chmod +x recorder
export WHIT=$work/recorder LOGINS=one,two THREADS=1

# A job is killed on the second machine when it has made a frame; the first machine goes on with it.
timeout 60 "$root/scenes/farm/parallel.sh" frames whitted "ssh/####.exr" $frames "${options[@]}" 2>parallel.log &
run=$!
within 20 grep '^192.0.2.1 2222 ' jobs
read -r _ _ process range threads < <(grep '^192.0.2.1 ' jobs)
test "$threads" = 1
first=${range%%..*}
within 20 test -e "ssh/000$first.exr"
kill -KILL "$process"
count=$(compgen -G "ssh/000[$first-${range##*..}].exr" | wc -l)
test "$count" -lt 4
wait $run
grep -x "8 images: $count kept, $((8 - count)) traced, 0 failed" parallel.log
tail -n 1 jobs | grep "^127.0.0.1 2222 .* $range 1$"
same ssh

# The bands of one picture, half of them on each machine.
rm jobs
"$whit" render whitted -o whole.exr --size 96x60 --quiet
CHUNK=30 timeout 60 "$root/scenes/farm/parallel.sh" image whitted bands.exr 96x60
cmp whole.exr bands.exr
test "$(grep ' 2222 ' jobs | cut -d ' ' -f 1 | sort | tr '\n' ' ')" = "127.0.0.1 192.0.2.1 "
echo "farm engines: Slurm and GNU parallel over ssh give the bits of one process"
