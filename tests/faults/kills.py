"""`kill -9` of Snakemake and of a job, and Ctrl-C, at random moments of a run."""

import os
import signal
import subprocess
import time
from functools import partial

import psutil

from .project import expect

WAIT = 0.02  # seconds between two checks


def moments(context, name):
    """Return sorted random moments of a run, in seconds after its start."""
    spread = context.random(name).uniform(0.0, context.seconds, context.moments)
    return sorted(float(moment) for moment in spread)


def job_of(process):
    """Return the process of one of the jobs that a run has started, or None if there is none."""
    try:
        children = psutil.Process(process.pid).children(recursive=True)
        jobs = [child for child in children if ".snakemake/scripts" in " ".join(child.cmdline())]
    except psutil.Error:
        return None
    return jobs[0] if jobs else None


def wait_for_end_of_orphans(folder):
    """Wait until no job of the folder is running; raise Fault after 10 s."""
    scripts, end = f"{folder}/.snakemake/scripts", time.monotonic() + 10
    while any(
        scripts in " ".join(process.info["cmdline"] or [])
        for process in psutil.process_iter(["cmdline"])
    ):
        expect(time.monotonic() < end, "jobs still run 10 s after their run was killed")
        time.sleep(WAIT)


def kill_snakemake(context):
    """Yield trials in which Snakemake is killed at a random moment."""
    for number, moment in enumerate(moments(context, "snakemake")):
        trial = partial(_stopped, context, f"snakemake-{number}", moment, subprocess.Popen.kill)
        yield f"`kill -9` of Snakemake after {moment:.1f} s", trial


def _stopped(context, name, moment, stop):
    project = context.fresh(name)
    process = project.start()
    time.sleep(moment)
    stop(process)
    process.communicate()
    wait_for_end_of_orphans(project.folder)
    return project.recover(context.undisturbed)


def kill_job(context):
    """Yield trials in which a job is killed at a random moment, or the next job if none runs."""
    for number, moment in enumerate(moments(context, "job")):
        trial = partial(_job_killed, context, f"job-{number}", moment)
        yield f"`kill -9` of a job after {moment:.1f} s", trial


def _job_killed(context, name, moment):
    project = context.fresh(name)
    process = project.start()
    time.sleep(moment)
    while process.poll() is None and not (job := job_of(process)):
        time.sleep(WAIT)
    if process.poll() is None and job.is_running():
        job.kill()
    process.communicate()
    return project.recover(context.undisturbed)


def interrupt(context):
    """Yield trials with Ctrl-C at about four of the random moments."""

    def stop(process):
        os.killpg(process.pid, signal.SIGINT)

    for number, moment in enumerate(moments(context, "interrupt")[:: max(context.moments // 4, 1)]):
        trial = partial(_stopped, context, f"interrupt-{number}", moment, stop)
        yield f"Ctrl-C after {moment:.1f} s", trial


TRIALS = [kill_snakemake, kill_job, interrupt]
