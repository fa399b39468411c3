"""Makes code of a checkout wrong for a while, builds it, runs programs in it, and restores the code."""
import contextlib
import hashlib
import os
import subprocess
import sys

CODE = ["engine", "shaders", "samples"]


def fail(text):
    """Ends the program with exit code 2: nothing could be judged."""
    print(f"mutate: {text}", file=sys.stderr)
    sys.exit(2)


class Checkout:
    """A checkout at `folder`, built in its subfolder `build`."""

    def __init__(self, folder, build):
        self.folder = os.path.abspath(folder)
        self.build = build

    def path(self, *parts):
        """Returns the absolute path of a file of the checkout."""
        return os.path.join(self.folder, *parts)

    def require_clean(self):
        """Ends the program if code has uncommitted changes, because mutations overwrite and restore files."""
        if subprocess.run(["git", "diff", "--quiet", "HEAD", "--", *CODE], cwd=self.folder).returncode != 0:
            fail(f"{', '.join(CODE)}: wanted no changes that are not committed; commit or stash them first")

    def content_id(self, folders):
        """Returns a text that differs if what is committed in one of the folders differs."""
        return subprocess.run(["git", "rev-parse", *(f"HEAD:{folder}" for folder in folders)], cwd=self.folder,
                              capture_output=True, text=True, check=True).stdout.replace("\n", " ").strip()

    def tests_id(self):
        """Returns a text that differs if what is committed in a folder of tests differs. Mutations are no tests."""
        listed = subprocess.run(["git", "ls-tree", "HEAD", "tests/"], cwd=self.folder, capture_output=True, text=True,
                                check=True).stdout.splitlines()
        folders = [line for line in listed if not line.endswith("\ttests/mutations")]
        return hashlib.sha1("\n".join(folders).encode()).hexdigest()

    @contextlib.contextmanager
    def replaced(self, texts):
        """Writes `texts` (path -> text) to files for the time of the block and restores the old texts after it."""
        before = {path: open(self.path(path), encoding="utf-8").read() for path in texts}
        try:
            for path, text in texts.items():
                open(self.path(path), "w", encoding="utf-8").write(text)
            yield
        finally:
            for path, text in before.items():
                open(self.path(path), "w", encoding="utf-8").write(text)

    def make(self, *targets, jobs=None, timeout=1800):
        """Builds the targets. Returns whether they compile and link."""
        # Checkouts in different folders share what ccache, if installed, has compiled.
        shared = {"CCACHE_BASEDIR": self.folder, "CCACHE_NOHASHDIR": "1"}
        command = ["nice", "cmake", "--build", self.build, *(["-j", str(jobs)] if jobs else []), "--target", *targets]
        return self.run(command, timeout, environment=shared)[0] == 0

    def run(self, command, timeout, environment={}, folder=None):
        """Runs a command for at most `timeout` seconds, by default at the top of the checkout.

        Returns its exit code, 124 if it took longer, and its output. Ends processes that it started too."""
        with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, errors="replace",
                              cwd=folder or self.folder, env={**os.environ, **environment},
                              start_new_session=True) as process:
            try:
                return_text, _ = process.communicate(timeout=timeout)
                return process.returncode, return_text
            except BaseException as error:  # also an interrupt, so that the code is restored at once
                os.killpg(process.pid, 9)
                if not isinstance(error, subprocess.TimeoutExpired):
                    raise
                return 124, process.communicate()[0]
