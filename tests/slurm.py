#!/usr/bin/env python3
"""A study through a real Slurm, of one node, which this test starts and stops: munged, slurmctld, slurmd.

slurm.py LINESHAFT SOURCE_DIR

1,000 cases in an array of tasks, one of which is killed and requeued; the merge must be the local run's bytes.
Exit 77: skipped, because Slurm is not installed (tools/setup installs it).
"""
import getpass
import os
import shutil
import socket
import subprocess
import sys
import tempfile
import time
from pathlib import Path

PROGRAM = """lineshaft: 1
parameters: {speed: 10 mm/s, jitter: 4 ms}
tasks: {main: {every: 10 ms, jitter: $jitter}}
blocks:
  axis: {type: axis, task: main, default_acceleration: 1e9 mm/s^2, default_jerk: 0 mm/s^3}
  feed: {type: MC_MoveVelocity, task: main, Axis: axis, Velocity: $speed, Execute: true}
run: {for: 600 s}
"""
PLAN = """lineshaft_study: 1
title: A thousand cases
program: program.yaml
compare: [axis.position]
cases:
  - grid: {speed: [1 mm/s, 2 mm/s]}
    random: {jitter: {uniform: [0 ms, 5 ms]}}
    draws: 500
"""
CHUNKS = 5
SLURM_CONF = """ClusterName=lineshaft
SlurmctldHost={host}(127.0.0.1)
SlurmctldPort={ports[0]}
SlurmdPort={ports[1]}
SlurmUser={user}
SlurmdUser={user}
AuthType=auth/munge
AuthInfo=socket={folder}/munge.socket
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.pid
SlurmctldLogFile={folder}/slurmctld.log
SlurmdLogFile={folder}/slurmd.log
CommunicationParameters=NoInAddrAny
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
AccountingStorageType=accounting_storage/none
JobAcctGatherType=jobacct_gather/none
MpiDefault=none
ReturnToService=2
KillWait=2
NodeName={host} NodeAddr=127.0.0.1 CPUs={cpus} State=UNKNOWN
PartitionName=test Nodes=ALL Default=YES MaxTime=INFINITE State=UP
"""
CGROUP_CONF = "CgroupPlugin=cgroup/v1\nCgroupAutomount=no\n"


def free_ports(count):
    sockets = [socket.socket() for _ in range(count)]
    for s in sockets:
        s.bind(("127.0.0.1", 0))
    ports = [s.getsockname()[1] for s in sockets]
    for s in sockets:
        s.close()
    return ports


class Cluster:
    """Of one node, in a folder of its own. Ends what it started."""

    def __init__(self, folder):
        self.folder = folder
        self.daemons = []
        self.env = {**os.environ, "SLURM_CONF": str(folder / "slurm.conf"), "PATH": os.environ["PATH"] + ":/usr/sbin:/sbin"}

    def __enter__(self):
        try:
            self.start()
        except BaseException:
            self.__exit__()
            raise
        return self

    def start(self):
        for name in ("state", "spool"):
            (self.folder / name).mkdir()
        host = socket.gethostname().split(".")[0]
        (self.folder / "slurm.conf").write_text(SLURM_CONF.format(
            host=host, ports=free_ports(2), user=getpass.getuser(), folder=self.folder, cpus=os.cpu_count()))
        (self.folder / "cgroup.conf").write_text(CGROUP_CONF)
        key = self.folder / "munge.key"
        key.write_bytes(os.urandom(1024))
        key.chmod(0o600)
        f = str(self.folder)
        self.daemon("munged", "--foreground", "--force", f"--key-file={key}", f"--socket={f}/munge.socket",
                    f"--pid-file={f}/munged.pid", f"--log-file={f}/munged.log", f"--seed-file={f}/munged.seed")
        self.wait_for(lambda: (self.folder / "munge.socket").exists(), 20, "munged")
        self.daemon("slurmctld", "-D", "-i")
        self.daemon("slurmd", "-D", "-N", host)
        self.wait_for(lambda: "idle" in self.call("sinfo", "--noheader", "--format=%t", check=False), 60, "the node")

    def daemon(self, *command):
        log = open(self.folder / (command[0] + ".out"), "wb")
        self.daemons.append(subprocess.Popen(command, env=self.env, stdout=log, stderr=log, cwd=self.folder))

    def call(self, *command, check=True):
        result = subprocess.run(command, env=self.env, capture_output=True, text=True, timeout=120)
        if check and result.returncode != 0:
            raise RuntimeError(f"{command}: {result.stdout}{result.stderr}")
        return result.stdout

    def wait_for(self, condition, seconds, what):
        end = time.monotonic() + seconds
        while not condition():
            if time.monotonic() > end or any(d.poll() is not None for d in self.daemons):
                raise RuntimeError(f"no {what} after {seconds} s\n" + self.logs())
            time.sleep(0.1)

    def logs(self):
        return "\n".join(f"== {p.name}\n" + p.read_text(errors="replace")[-3000:]
                         for p in sorted([*self.folder.glob("*.log"), *self.folder.glob("*.out")]))

    def __exit__(self, *_):
        if len(self.daemons) > 1:
            self.call("scancel", f"--user={getpass.getuser()}", check=False)
        for daemon in reversed(self.daemons):
            daemon.terminate()
        for daemon in reversed(self.daemons):
            try:
                daemon.wait(20)
            except subprocess.TimeoutExpired:
                daemon.kill()
                daemon.wait()


def tell(what, start):
    print(f"{time.monotonic() - start:6.1f} s  {what}", flush=True)


def submit_and_kill(cluster, tools, work, env, start):
    print(cluster_call(env, work, str(tools / "submit"), "plan.yaml", f"--chunks={CHUNKS}"), end="")
    tell("submitted", start)
    job = (work / "plan" / "jobs").read_text().split()[1]
    part = work / "plan" / "parts" / "part_1.csv.part"
    cluster.wait_for(lambda: part.exists() and part.read_bytes().count(b"\n") > 20, 60, "first rows")
    cluster.call("scontrol", "requeue", f"{job}_1")
    rows = part.read_bytes().count(b"\n") - 1
    # Slurm lets a requeued task wait for two minutes; here it may start at once.
    cluster.wait_for(lambda: cluster.call("squeue", "--noheader", f"--jobs={job}_1", "--format=%t").strip() == "PD", 60,
                     "requeued task")
    cluster.call("scontrol", "update", f"JobId={job}_1", "StartTime=now")
    assert not (work / "plan" / "parts" / "part_1.csv").exists(), "the task had ended before it was killed"
    tell(f"killed and requeued task 1 after {rows} of its {1000 // CHUNKS} cases", start)
    status = subprocess.run([tools / "status", "plan"], cwd=work, env=env, capture_output=True, text=True)
    print(status.stdout, end="")
    assert status.returncode == 1 and f"of {CHUNKS} done" in status.stdout, status


def cluster_call(env, work, *command):
    result = subprocess.run(command, cwd=work, env=env, capture_output=True, text=True, timeout=120)
    assert result.returncode == 0, (command, result.stdout, result.stderr)
    return result.stdout


def check(lineshaft, source, folder):
    start = time.monotonic()
    work = folder / "work"
    work.mkdir()
    (work / "program.yaml").write_text(PROGRAM)
    (work / "plan.yaml").write_text(PLAN)
    tools = Path(source) / "tools" / "slurm"
    with Cluster(folder) as cluster:
        tell("Slurm is up", start)
        env = {**cluster.env, "LINESHAFT": lineshaft}
        submit_and_kill(cluster, tools, work, env, start)
        done = subprocess.run([tools / "status", "plan"], cwd=work, env=env, capture_output=True, text=True)
        while done.returncode != 0 and "missing" not in done.stdout and time.monotonic() - start < 400:
            time.sleep(0.5)
            done = subprocess.run([tools / "status", "plan"], cwd=work, env=env, capture_output=True, text=True)
        print(done.stdout, end="")
        logs = "".join(p.read_text() for p in sorted((work / "plan" / "logs").iterdir()))
        assert done.returncode == 0, (done, logs[-2000:], cluster.logs())
        tell("merged", start)
    assert "goes on after" in logs, "the killed task began anew"
    cluster_call(os.environ, work, lineshaft, "study", "plan.yaml", "-o", "local.csv", "--quiet")
    tell("run without Slurm", start)
    local, merged = (work / "local.csv").read_bytes(), (work / "plan" / "results.csv").read_bytes()
    assert local.count(b"\n") == 1001 and merged == local, "the merge differs from the local run"
    print("ok  1,000 cases through Slurm: the bytes of the local run")


def main():
    needed = ("munged", "slurmctld", "slurmd", "sbatch", "scontrol")
    path = os.environ["PATH"] + ":/usr/sbin:/sbin"
    missing = [name for name in needed if not shutil.which(name, path=path)]
    if missing:
        print(f"SKIPPED: no {', '.join(missing)} here; tools/setup installs slurm-wlm")
        sys.exit(77)
    with tempfile.TemporaryDirectory(prefix="lineshaft-slurm-") as folder:
        check(os.path.abspath(sys.argv[1]), os.path.abspath(sys.argv[2]), Path(folder))


if __name__ == "__main__":
    main()
