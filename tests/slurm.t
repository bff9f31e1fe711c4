#!/bin/sh
# The job array of chapter 16 on a real Slurm of one node, which is started
# here, and GNU parallel: a failed shard is not merged over, and sent again it
# completes the picture.
. tests/tap.sh
cd "$T" || exit 1
write_obj a.obj
echo "$facet" >facet.path
N=4
options="-q -r 80x48 --spp 16"
# shellcheck disable=SC2086
"$facet" render a.obj --engine path $options -o one.png

# A facet that fails for shard 3, until somebody repairs the machine.
cat >facet <<E
#!/bin/sh
case "\$*" in *"--shard 3/"*) [ -e broken ] && exit 1 ;; esac
exec "$facet" "\$@"
E
chmod +x facet

if command -v parallel >/dev/null; then
  touch broken
  shards() { seq $N | parallel -j 2 "$@" --joblog jobs ./facet render a.obj --engine path "$options" --shard {}/$N -o p.{}.part; }
  # The options are words of a shell that parallel starts.
  exits 1 "parallel: one shard fails" shards
  exits 1 "and is missed" "$facet" merge p.*.part -o p.png
  says "of shard 3/4 are missing" "by its name"
  rm broken
  exits 0 "only that one is rendered again" shards --resume-failed
  exits 0 "and the parts are a picture" "$facet" merge -q p.*.part -o p.png
  ok "that of a single run" cmp one.png p.png
else
  skip "parallel" "no GNU parallel"
fi

missing=
for tool in munged slurmctld slurmd sbatch squeue scontrol; do
  PATH=$PATH:/usr/sbin:/sbin command -v $tool >/dev/null || missing="$missing $tool"
done
if [ -n "$missing" ] || [ "$(id -u)" != 0 ]; then
  skip "a Slurm of one node" "needs root, slurm-wlm and munge; missing:$missing"
  finish
  exit 0
fi

# Everything of the Slurm lies in this folder, its ports are its own.
PATH=$PATH:/usr/sbin:/sbin
S=$T/slurm
mkdir -p "$S/state" "$S/spool" "$S/munge"
chmod 755 "$T"
chmod 700 "$S/munge"
head -c 1024 /dev/urandom >"$S/munge/key"
chmod 400 "$S/munge/key"
host=$(hostname -s)
port=$((20000 + $$ % 20000))
cat >"$S/slurm.conf" <<E
ClusterName=facet
SlurmctldHost=$host(127.0.0.1)
SlurmUser=root
SlurmctldPort=$port
SlurmdPort=$((port + 1))
AuthType=auth/munge
AuthInfo=socket=$S/munge.socket
CredType=cred/munge
StateSaveLocation=$S/state
SlurmdSpoolDir=$S/spool
SlurmctldPidFile=$S/slurmctld.pid
SlurmdPidFile=$S/slurmd.pid
SlurmctldLogFile=$S/slurmctld.log
SlurmdLogFile=$S/slurmd.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
SchedulerParameters=sched_interval=1,batch_sched_delay=0
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
MpiDefault=none
ReturnToService=2
MailProg=/bin/true
NodeName=$host NodeAddr=127.0.0.1 CPUs=2 RealMemory=500 State=UNKNOWN
PartitionName=all Nodes=$host Default=YES MaxTime=10 State=UP
E
export SLURM_CONF="$S/slurm.conf"
munged --foreground --force --key-file="$S/munge/key" --socket="$S/munge.socket" --pid-file="$S/munge/pid" \
  --log-file="$S/munge/log" --seed-file="$S/munge/seed" >"$S/munged.out" 2>&1 &
daemons=$!
stop() {
  # shellcheck disable=SC2086
  kill $daemons 2>/dev/null
  # shellcheck disable=SC2086
  wait $daemons 2>/dev/null
  rm -rf "$T"
}
trap stop EXIT
for _ in $(seq 50); do [ -S "$S/munge.socket" ] || sleep 0.1; done
slurmctld -D -c >"$S/slurmctld.out" 2>&1 &
daemons="$! $daemons"
slurmd -D -c >"$S/slurmd.out" 2>&1 &
daemons="$! $daemons"
for _ in $(seq 60); do
  sinfo -h -o %t 2>/dev/null | grep -q idle && break
  sleep 0.5
done
if ! sinfo -h -o %t 2>/dev/null | grep -q idle; then
  fail "Slurm starts"
  tail -5 "$S"/*.log "$S"/*.out | sed 's/^/# /'
  finish
  exit 1
fi
echo "# $(sinfo -V), node $(sinfo -h -o '%n %t')"

# queue JOB: wait until nothing of it is waiting or running, but for what can
# never start.
queue() {
  for _ in $(seq 120); do
    squeue -h -j "$1" -o '%T %r' 2>/dev/null | grep -qv DependencyNeverSatisfied || return 0
    sleep 0.5
  done
  return 1
}
state() { scontrol show job "$1" 2>/dev/null | sed -n 's/.*JobState=\([A-Z]*\) Reason=\([^ ]*\).*/\1 \2/p' | sort | uniq -c | tr -s ' \n' ' '; }
submit() { # ARRAY
  # shellcheck disable=SC2086
  job=$(FACET=$T/facet sbatch --parsable --array="$1" --cpus-per-task=1 "$root"/chapters/16-*/render.sbatch $N a.obj s $options)
  merge=$(sbatch --parsable --dependency=afterok:"$job" --kill-on-invalid-dep=yes --output=merge.log \
    --wrap "'$facet' merge s.*.part -o s.png")
  ok "the array $1 and its merge come to an end" queue "$job"
  ok "both of them" queue "$merge"
  echo "# job $job:$(state "$job")"
  echo "# merge $merge:$(state "$merge")"
}
touch broken
submit "1-$N"
ok "shard 3 has failed" sh -c "scontrol show job $job | grep -q JobState=FAILED"
ok "the merge was never started" test ! -e merge.log -a ! -e s.png
ok "as its condition cannot be met" sh -c "scontrol show job $merge | grep -qE 'JobState=CANCELLED.*DependencyNeverSatisfied|JobState=CANCELLED.*Reason=Dependency'"
ok "the others have their parts" test -s s.1.part -a -s s.2.part -a -s s.4.part -a ! -e s.3.part
rm broken
submit 3
ok "shard 3 is complete, of $N though its array is of one" "$facet" merge -q s.*.part -o check.png
ok "the merge wrote the picture" grep -q '^s.png: 80x48, 4 parts' merge.log
ok "and it is that of a single run" cmp one.png s.png
finish
