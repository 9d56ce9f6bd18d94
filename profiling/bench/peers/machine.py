# profiling/bench/peers/machine.py - runs a program and tells how much of the machine others took meanwhile.
"""Linux only: reads /proc."""
import os
import platform
import signal
import subprocess
import time
from dataclasses import dataclass
from pathlib import Path

TIME = "/usr/bin/time"                  # Debian: time. A process that Python starts counts Python's memory as its own.
TICK = os.sysconf("SC_CLK_TCK")


@dataclass
class Outcome:
    code: int                           # exit code; negative: the signal that ended it
    wall: float                         # [s] of the whole program, reading and set-up included
    memory: float                       # [bytes] greatest resident set of one of its processes; 0: /usr/bin/time is missing
    others: float                       # processors that other programs kept busy, on average
    steal: float                        # processors that the hypervisor withheld, on average
    load: float                         # 1-minute load average at the start


def processor_seconds():
    """Busy and stolen time of all processors since boot [s]."""
    with open("/proc/stat") as file:
        user, nice, system, _idle, _wait, irq, softirq, steal = map(int, file.readline().split()[1:9])
    return (user + nice + system + irq + softirq) / TICK, steal / TICK


def busy(seconds=1.0):
    """Processors that are busy now, while this program sleeps."""
    before, start = processor_seconds()[0], time.monotonic()
    time.sleep(seconds)
    return max(0.0, processor_seconds()[0] - before) / (time.monotonic() - start)


def wait_until_quiet(limit, patience):
    """Waits until less than `limit` processors are busy, for `patience` seconds at most. Returns how many are busy then."""
    end = time.monotonic() + patience
    while (now := busy()) >= limit and time.monotonic() < end:
        time.sleep(2)
    return now


def run(command, output, environment, timeout, folder):
    """Runs the command in the folder, all it says to the file `output`. After `timeout` seconds it and its children are ended."""
    peak = Path(f"{output}.memory")
    if os.access(TIME, os.X_OK):
        command = [TIME, "--quiet", "--format", "%M", "--output", str(peak), *command]
    with open(output, "wb") as file:
        load = os.getloadavg()[0]
        busy_before, steal_before = processor_seconds()
        start = time.monotonic()
        process = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=file, stderr=subprocess.STDOUT, cwd=folder,
                                   env=os.environ | environment, start_new_session=True)
        try:
            while (ended := os.wait4(process.pid, os.WNOHANG))[0] == 0:
                if time.monotonic() - start > timeout:
                    os.killpg(process.pid, signal.SIGKILL)
                    ended = os.wait4(process.pid, 0)
                    break
                time.sleep(0.02)
        except BaseException:
            os.killpg(process.pid, signal.SIGKILL)
            raise
    wall = time.monotonic() - start
    busy_after, steal_after = processor_seconds()
    process.returncode = os.waitstatus_to_exitcode(ended[1])
    usage = ended[2]
    own = usage.ru_utime + usage.ru_stime
    memory = float(peak.read_text()) * 1024 if peak.exists() and peak.read_text().strip().isdigit() else 0.0
    peak.unlink(missing_ok=True)
    return Outcome(process.returncode, wall, memory, max(0.0, busy_after - busy_before - own) / wall,
                   (steal_after - steal_before) / wall, load)


def describe():
    model, cache = platform.machine(), ""
    with open("/proc/cpuinfo") as file:
        lines = file.read().splitlines()
    numbers = {line.split(":")[0].strip(): line.split(":")[1].strip() for line in lines if ":" in line}
    model = numbers.get("model name", model)
    if "model" in numbers:
        model += f" (family {numbers.get('cpu family')}, model {numbers['model']})"
    cache = numbers.get("cache size", "")
    with open("/proc/meminfo") as file:
        memory = int(file.readline().split()[1]) / 2**20
    system = platform.freedesktop_os_release().get("PRETTY_NAME", "")
    return {"processor": model, "processors": len(os.sched_getaffinity(0)), "cache": cache, "memory_GiB": round(memory, 1),
            "system": system, "kernel": platform.release(), "load": [round(x, 2) for x in os.getloadavg()]}
