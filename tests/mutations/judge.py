"""Judges mutants: builds one in a worktree, and runs tests until one fails."""
import glob
import hashlib
import json
import os
import pathlib
import re
import shlex
import shutil
import subprocess
import time

import checkout
import reach

BUILD = "build/mutants"
# Programs that hold all object files that are not tests. Tests need them too.
PROGRAMS = ["catoptric_cli", "catoptric_view", "catoptric", "catoptric_images", "catoptric_draco"]
JUDGED = ("killed", "survived", "undecided")  # outcomes of mutants that compile and change the programs


class Objects:
    """Hashes of the object files of PROGRAMS, without debug information. SPIR-V is compiled into these files."""

    def __init__(self, tree):
        self.tree = tree
        self.known = {}
        self.baseline = self.hashes()

    def hashes(self):
        for path in glob.glob(self.tree.path(BUILD, "**/*.o"), recursive=True):
            if path.startswith(self.tree.path(BUILD, "tests/")):
                continue  # PROGRAMS do not build these, so they can be those of an earlier mutant
            stamp = os.stat(path).st_mtime_ns
            if self.known.get(path, (0, ""))[0] != stamp:
                bare = self.tree.path(BUILD, "bare")  # no *.o, which hashes() would take for code
                subprocess.run(["objcopy", "--strip-debug", path, bare], check=True)
                self.known[path] = (stamp, hashlib.sha1(pathlib.Path(bare).read_bytes()).hexdigest())
        return {path: value for path, (_, value) in self.known.items()}

    def differ(self, since=0):
        """Returns whether an object file that was written at time `since` (ns) or later differs from that of the
        correct code. Older files can be those of an earlier mutant."""
        now = self.hashes()
        return any(now[path] != value and self.known[path][0] >= since for path, value in self.baseline.items())


class ShaderStore:
    """The shaders that tests keep on disk. Wrong code can write wrong files there, so they are restored from a copy."""

    def __init__(self, tree, copy):
        self.folder, self.copy = tree.path(BUILD, "test_cache"), copy
        self.restore()

    def restore(self):
        """Makes the tests' folder equal to the copy."""
        wanted = self.files(self.copy)
        for path, stamp in self.files(self.folder).items():
            if wanted.get(path) != stamp:
                os.remove(os.path.join(self.folder, path))
            else:
                del wanted[path]
        for path in wanted:
            os.makedirs(os.path.dirname(os.path.join(self.folder, path)), exist_ok=True)
            shutil.copy2(os.path.join(self.copy, path), os.path.join(self.folder, path))

    @staticmethod
    def files(folder):
        return {os.path.relpath(os.path.join(at, name), folder): (os.stat(os.path.join(at, name)).st_size,
                                                                 os.stat(os.path.join(at, name)).st_mtime_ns)
                for at, _, names in os.walk(folder) for name in names}


class Judge:
    """A worktree of the last commit in which mutants are built and tested."""

    def __init__(self, folder, reached, shaders):
        if not os.path.isdir(folder):
            subprocess.run(["git", "worktree", "add", "--detach", "--quiet", folder, "HEAD"], check=True)
        head = subprocess.run(["git", "rev-parse", "HEAD"], capture_output=True, text=True, check=True).stdout.strip()
        subprocess.run(["git", "checkout", "--quiet", "--force", "--detach", head], cwd=folder, check=True)
        self.tree = checkout.Checkout(folder, BUILD)
        self.reached = reached
        if not os.path.exists(self.tree.path(BUILD, "build.ninja")):
            self.tree.run(["cmake", "--preset", "mutants"], 600)
        if not self.tree.make("all"):
            checkout.fail(f"{folder}: the code that is right does not build")
        self.tests_id = self.tree.tests_id()
        self.right = set()  # tests that passed on right code after they had noticed a mutant
        # A test that needs the machine for itself cannot run beside other judges.
        self.tests = {name: test for name, test in reach.tests_of(self.tree).items() if not test.alone}
        self.commands = {entry["file"]: entry["command"] for entry in
                         json.loads(pathlib.Path(self.tree.path(BUILD, "compile_commands.json")).read_text())}
        self.alone = {}
        self.store = ShaderStore(self.tree, shaders)
        self.objects = Objects(self.tree)

    def compiles_alone(self, path, text):
        """Returns whether the compiler accepts `text` in place of a C++ file. Quicker than a build, if it does not."""
        folder = os.path.dirname(path)
        group = f"catoptric_{os.path.basename(folder)}.dir/Unity"
        known = [command for file, command in sorted(self.commands.items())
                 if group in file or os.path.dirname(file) == self.tree.path(folder)]
        if not known:
            return True
        words = shlex.split(known[0])
        words = words[:words.index("-o")] + ["-w"]
        if path.endswith(".cpp"):
            words += ["-include", self.precompiled(folder, words)]
        alone = self.tree.path(BUILD, "alone.cpp")
        pathlib.Path(alone).write_text(text)
        words += ["-fsyntax-only", "-fmax-errors=1", "-I", self.tree.path(folder), alone]
        return self.tree.run(["nice", *words], 300, folder=self.tree.path(BUILD))[0] == 0

    def precompiled(self, folder, words):
        """Returns the path of a header with all includes of a folder's sources. It is precompiled once."""
        header = self.tree.path(BUILD, "alone_" + folder.replace("/", "_") + ".hpp")
        if header not in self.alone:
            sources = sorted(glob.glob(self.tree.path(folder, "*.cpp")))
            includes = {line for source in sources for line in pathlib.Path(source).read_text().splitlines()
                        if line.startswith("#include")}
            pathlib.Path(header).write_text("#pragma once\n" + "\n".join(sorted(includes)) + "\n")
            words = [*words, "-x", "c++-header", "-I", self.tree.path(folder), "-o", header + ".gch", header]
            self.tree.run(["nice", *words], 300, folder=self.tree.path(BUILD))
            self.alone[header] = True
        return header

    def correct_compiles_alone(self, path, text):
        """As compiles_alone(), but stores the answer by path."""
        if path not in self.alone:
            self.alone[path] = self.compiles_alone(path, text)
        return self.alone[path]

    def judge(self, record, after, most_seconds):
        """Builds a mutant and runs tests until one fails. Adds what it found to the record.

        "outcome": see JUDGED, or "does not compile" or "same code". "by": the test that failed. "passed": the tests
        that did not, and "tests": which state of the tests that was. "covered by": the number of tests that run the
        code. "seconds": the time of all this."""
        begin = time.monotonic()
        path = record["file"]
        text = pathlib.Path(self.tree.path(path)).read_text()
        lines = text.splitlines(keepends=True)
        lines[record["line"] - 1] = after
        wrong = "".join(lines)
        if path.endswith("pp") and not self.compiles_alone(path, wrong) and self.correct_compiles_alone(path, text):
            record["outcome"] = "does not compile"
        else:
            with self.tree.replaced({path: wrong}):
                record["outcome"] = self.outcome(record, text, most_seconds)
            self.store.restore()
            if record["outcome"] == "killed":
                self.require_pass(record["by"].partition(" ")[0])
        record["seconds"] = round(record.get("seconds", 0) + time.monotonic() - begin)

    def require_pass(self, name):
        """Ends the program if a test fails on right code, where it would notice every mutant. Runs each test once."""
        if name in self.right or name in self.reached.seconds and self.reached.tests == self.tests_id:
            return
        if not self.tree.make(self.tests[name].program):
            checkout.fail(f"{name} does not build, although no code is wrong")
        code, output = reach.run(self.tree, self.tests[name], 1800)
        if code != 0:
            checkout.fail(f"{name} fails, although no code is wrong:\n{output[-2000:]}")
        self.right.add(name)

    def outcome(self, record, text, most_seconds):
        """Returns the outcome of the mutant that the worktree holds now. `text` is the file's correct text."""
        # Tests that are newer than the record of what tests run may run any line.
        wanted = [name for name in self.tests if name not in self.reached.seconds]
        wanted += [name for name in self.reached.tests_for(record["file"], record["line"], text) if name in self.tests]
        first = record.get("first", [])
        for name in first:
            if name not in self.tests:
                checkout.fail(f"{record['file']}:{record['line']}: there is no test '{name}' to run first")
        wanted = [*first, *(name for name in wanted if name not in first)]
        # Most mutants fall to the first test, so its program alone is linked at first.
        program = self.tests[wanted[0]].program if wanted else "all"
        begin = time.time_ns()
        for targets in (PROGRAMS if program == "all" else [program], PROGRAMS):
            if not self.tree.make(*targets, jobs=1):
                return "does not compile"
            if self.objects.differ(begin):
                break
        else:
            return "same code"
        if record.get("tests") != self.tests_id:
            record.update(tests=self.tests_id, passed=[])  # changed tests can notice what the old ones did not
        passed = record["passed"]
        record["covered by"] = len(wanted)
        left_out = False
        for name in wanted:
            test, usual = self.tests[name], self.reached.seconds.get(name, 10)
            if name in passed:
                continue
            taken = sum(self.reached.seconds.get(other, 10) for other in passed)
            if taken + usual > most_seconds and name not in first:
                left_out = True
                continue
            if not self.tree.make(test.program, jobs=1):
                return "does not compile"
            code, output = reach.run(self.tree, test, 20 + 3 * usual)
            if code != 0:
                failed = re.search(r"\[  FAILED  \] (\w[\w/]*\.[\w/]*)", output)
                how = failed[1] if failed else "took too long" if code == 124 else f"ended with {code}"
                record["by"] = f"{name} ({how})"
                return "killed"
            passed.append(name)
        return "undecided" if left_out else "survived"
