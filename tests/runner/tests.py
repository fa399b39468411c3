"""The tests of a build, as CTest lists them, and one run of one test."""
import ctypes
import dataclasses
import json
import os
import re
import signal
import subprocess
import time

MARKS = {"slow"}  # labels that say something about a test of another label
KNOWN = {"COST", "ENVIRONMENT", "LABELS", "RUN_SERIAL", "SKIP_RETURN_CODE", "TIMEOUT", "WORKING_DIRECTORY"}
DEFAULT_TIMEOUT = 1500  # CTest's


@dataclasses.dataclass
class Test:
    """A test of CTest."""
    name: str
    labels: list
    slow: bool
    command: list  # empty if the program is not built
    environment: dict
    folder: str
    timeout: float
    alone: bool  # no other test may run beside it
    skip_code: int | None

    @property
    def file_name(self):
        return self.name.replace("/", "_")


def read(listed):
    """Returns the tests of the text that `ctest --show-only=json-v1` prints."""
    found = []
    for test in json.loads(listed)["tests"]:
        has = {entry["name"]: entry["value"] for entry in test.get("properties", [])}
        if unknown := sorted(set(has) - KNOWN):
            raise ValueError(f"test {test['name']}: property {unknown[0]} is unknown to tests/runner/tests.py")
        labels = has.get("LABELS", [])
        found.append(Test(test["name"], [label for label in labels if label not in MARKS], "slow" in labels,
                          test.get("command", []), dict(text.split("=", 1) for text in has.get("ENVIRONMENT", [])),
                          has["WORKING_DIRECTORY"], has.get("TIMEOUT", DEFAULT_TIMEOUT), has.get("RUN_SERIAL", False),
                          has.get("SKIP_RETURN_CODE")))
    return found


def of_build(build):
    """Returns the tests of a build folder."""
    ended = subprocess.run(["ctest", "--test-dir", build, "--show-only=json-v1"], capture_output=True, text=True,
                           check=True)
    return read(ended.stdout)


@dataclasses.dataclass
class Outcome:
    """How a test ended: "passed", "failed" or "not run". `skipped` names the cases that did not run, with reasons."""
    result: str
    reason: str = ""
    skipped: list = dataclasses.field(default_factory=list)


def skipped_cases(output):
    """Returns the cases of GoogleTest that skipped themselves, each with the text that it printed."""
    found, lines, reason = [], output.splitlines(), ""
    for line, after in zip(lines, [*lines[1:], ""]):
        if line.startswith("[ RUN      ] "):
            reason = ""
        elif line.endswith(": Skipped"):
            reason = after
        elif case := re.match(r"\[  SKIPPED \] (\S+) \(", line):
            found.append(f"{case[1]}: {reason or 'no reason said'}")
    return found


def judge(test, code, output):
    """Returns the outcome of a run by its exit code, below 0 for a signal, and its output."""
    lines = [line for line in output.splitlines() if line.strip()]
    if test.skip_code is not None and code == test.skip_code:
        return Outcome("not run", lines[-1] if lines else f"exit code {code}")
    if code != 0:
        cases = sorted(set(re.findall(r"^\[  FAILED  \] (\w[\w/]*\.[\w/]*)", output, re.M)))
        how = f"signal {signal.Signals(-code).name}" if code < 0 else f"exit code {code}"
        return Outcome("failed", ", ".join([how, *cases[:5]]))
    skipped = skipped_cases(output)
    if skipped and "[  PASSED  ] 0 tests" in output:
        return Outcome("not run", skipped[0].split(": ", 1)[1], skipped)
    return Outcome("passed", "", skipped)


def prepare_process():
    """Lets the kernel end this process when its parent is killed (PR_SET_PDEATHSIG), and lets it be interrupted."""
    ctypes.CDLL(None).prctl(1, signal.SIGTERM)
    signal.signal(signal.SIGINT, signal.SIG_DFL)  # A parent in the background ignores it.


class Run:
    """A run of a test in a session of its own, whose output goes to a file."""

    def __init__(self, test, log):
        self.test, self.log, self.start = test, log, time.monotonic()
        self.asked = False
        with open(log, "wb") as output:
            self.process = subprocess.Popen(test.command, cwd=test.folder, env={**os.environ, **test.environment},
                                            stdin=subprocess.DEVNULL, stdout=output, stderr=subprocess.STDOUT,
                                            start_new_session=True, preexec_fn=prepare_process)

    @property
    def seconds(self):
        return time.monotonic() - self.start

    def poll(self):
        """Returns the outcome if the test has ended. Ends a test that takes longer than its timeout."""
        code = self.process.poll()
        if code is None:
            if self.seconds < self.test.timeout:
                return None
            end([self])
            return Outcome("failed", f"took longer than {self.test.timeout:.0f} s")
        with open(self.log, errors="replace") as output:
            return judge(self.test, code, output.read())


def end(runs, patience=1.2):
    """Interrupts the processes of runs, so that they tidy up. Kills those that remain after `patience` seconds."""
    def tell(run, number):
        try:
            os.killpg(run.process.pid, number)
        except ProcessLookupError:
            pass
    for run in runs:
        tell(run, signal.SIGINT)
    last = time.monotonic() + patience
    while time.monotonic() < last and any(run.process.poll() is None for run in runs):
        time.sleep(.02)
    for run in runs:
        tell(run, signal.SIGKILL)
        run.process.wait()
