"""Makes code of a checkout wrong for a while, builds it, runs tests, and restores the code."""
import contextlib
import subprocess
import sys

BUILD = "build/ci"
CODE = ["engine", "shaders", "samples"]


def fail(text):
    """Ends the program with exit code 2: nothing could be judged."""
    print(f"mutate: {text}", file=sys.stderr)
    sys.exit(2)


def require_clean():
    """Ends the program if code has uncommitted changes, because mutations overwrite and restore files."""
    if subprocess.run(["git", "diff", "--quiet", "HEAD", "--", *CODE]).returncode != 0:
        fail(f"{', '.join(CODE)}: wanted no changes that are not committed; commit or stash them first")


@contextlib.contextmanager
def replaced(texts):
    """Writes `texts` (path -> text) to files for the time of the block and restores the old texts after it."""
    before = {path: open(path, encoding="utf-8").read() for path in texts}
    try:
        for path, text in texts.items():
            open(path, "w", encoding="utf-8").write(text)
        yield
    finally:
        for path, text in before.items():
            open(path, "w", encoding="utf-8").write(text)


def build(*targets, timeout=1800):
    """Builds the targets. Returns whether they compile and link."""
    return run(["nice", "cmake", "--build", BUILD, "--target", *targets], timeout)[0] == 0


def run(command, timeout):
    """Runs a command for at most `timeout` seconds. Returns its exit code, 124 if it took longer, and its output."""
    try:
        done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, errors="replace",
                              timeout=timeout)
        return done.returncode, done.stdout
    except subprocess.TimeoutExpired as late:
        return 124, (late.stdout or b"").decode(errors="replace")
