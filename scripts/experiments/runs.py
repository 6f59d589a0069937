"""Runs: folders that programs fill, each done once; and how a script ends when something is missing.

A run's run.json tells the commands, the commit and fingerprints of the programs, the configurations and
the inputs that nothing here makes. While commands and fingerprints are the same it is not done again, so
an interrupted experiment goes on where it was."""

import concurrent.futures
import functools
import glob
import hashlib
import json
import os
import shlex
import shutil
import subprocess
import sys

PROGRAMS = ["rawlog-simulate", "semloop-slam", "semloop-eval", "rawlog-train-vocabulary",
            "loop_closure_benchmark"]


def call_main(main):
    """Ends with main's exit code; or, when something stops it, with one line on stderr and 1."""
    script = os.path.basename(sys.argv[0])
    try:
        sys.exit(main())
    except KeyboardInterrupt:
        sys.exit(f"{script}: interrupted; run again, it goes on where it was")
    except (OSError, RuntimeError) as error:
        sys.exit(f"{script}: {error}")


def fingerprint(programs):
    """Of everything that a result depends on besides its command and inputs."""
    files = [os.path.join(programs, name) for name in PROGRAMS]
    for name in files:
        if not os.path.exists(name):
            raise RuntimeError(f"{name}: no such program; make build makes it"
                               + (", with libbenchmark-dev" if "benchmark" in name else ""))
    files += glob.glob(os.path.join(programs, "../lib/libsemloop-*.so"))
    files += glob.glob("config_ini/**/*.ini", recursive=True)
    digest = hashlib.sha256()
    for name in sorted(files):
        with open(name, "rb") as file:
            digest.update(name.encode() + file.read())
    return digest.hexdigest()[:16]


@functools.lru_cache(maxsize=None)
def digest_of(path):
    with open(path, "rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()


def text_of(*command):
    return subprocess.run(command, check=True, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL,
                          text=True).stdout.strip()


def commit():
    """As git describe --always --dirty, but the results themselves may change."""
    try:
        changed = text_of("git", "status", "--porcelain", "-uno", "--", ".", ":!doc/results")
        return text_of("git", "describe", "--always") + ("-dirty" if changed else "")
    except (OSError, subprocess.CalledProcessError):
        return "unknown"  # an archive of the sources


class Run:
    """Commands, one after the other, that fill a folder; (command, file) keeps what it prints. Inputs are
    files that no other run makes."""

    def __init__(self, folder, commands, remove=(), inputs=()):
        self.folder = folder
        self.commands = [c if isinstance(c, tuple) else (c, None) for c in commands]
        self.remove = remove
        self.inputs = inputs

    def path(self, name):
        return os.path.join(self.folder, name)

    def json(self, name):
        with open(self.path(name), encoding="utf-8") as file:
            return json.load(file)

    def jsonl(self, name):
        with open(self.path(name), encoding="utf-8") as file:
            return [json.loads(line) for line in file]

    def identity(self, opts):
        result = {"commands": [shlex.join(command) for command, _ in self.commands],
                  "fingerprint": opts.fingerprint}
        if self.inputs:
            result["inputs"] = {path: digest_of(path) for path in self.inputs}
        return result

    def is_done(self, opts):
        if not os.path.exists(self.path("run.json")):
            return False
        try:
            made = self.json("run.json")
        except json.JSONDecodeError:
            return False  # stopped while it was written
        return all(made.get(key) == value for key, value in self.identity(opts).items())

    def execute(self, opts):
        shutil.rmtree(self.folder, ignore_errors=True)
        os.makedirs(self.folder)
        with open(self.path("log.txt"), "w", encoding="utf-8") as log:
            for command, output in self.commands:
                self.call(command, output, log)
        for name in self.remove:
            path = self.path(name)
            if os.path.isdir(path):
                shutil.rmtree(path)
            elif os.path.exists(path):
                os.remove(path)
        with open(self.path("run.json"), "w", encoding="utf-8") as file:
            json.dump({**self.identity(opts), "commit": opts.commit}, file, indent=1)

    def call(self, command, output, log):
        if output:
            with open(self.path(output), "w", encoding="utf-8") as stdout:
                code = subprocess.run(command, stdout=stdout, stderr=log, check=False).returncode
        else:
            code = subprocess.run(command, stdout=log, stderr=log, check=False).returncode
        if code != 0:
            raise RuntimeError(f"{log.name}: {os.path.basename(command[0])} ended with exit code {code}: "
                               + last_line(log.name))


def last_line(path):
    with open(path, encoding="utf-8", errors="replace") as file:
        lines = [line for line in file.read().splitlines() if line.strip()]
    return lines[-1] if lines else "it said nothing"


def execute(runs, opts, jobs=None):
    """Does the runs that are not done yet, some at a time."""
    todo = [run for run in runs if not run.is_done(opts)]
    if runs and not todo:
        print(f"{len(runs)} runs, all done before", file=sys.stderr)
    with concurrent.futures.ThreadPoolExecutor(jobs or opts.jobs) as pool:
        pending = {pool.submit(run.execute, opts): run for run in todo}
        try:
            for count, future in enumerate(concurrent.futures.as_completed(pending), 1):
                future.result()
                print(f"{count}/{len(todo)} {pending[future].folder}", file=sys.stderr)
        finally:
            pool.shutdown(cancel_futures=True)
