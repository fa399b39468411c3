"""What is known of earlier runs: each test's last result in the build folder, and each label's in the tree."""
import datetime
import json
import os
import shutil
import subprocess
import sys
import tempfile

FILE = "tests/last-run.json"  # written by the runner alone


def git(top, *arguments, **variables):
    """Returns what git prints, without the line's end."""
    return subprocess.run(["git", *arguments], cwd=top, capture_output=True, text=True, check=True,
                          env={**os.environ, **variables}).stdout.strip()


def tree_of(top):
    """Returns git's hash of the working tree without FILE: with uncommitted changes and new files."""
    with tempfile.TemporaryDirectory() as folder:
        index = os.path.join(folder, "index")
        present = os.path.join(top, git(top, "rev-parse", "--git-path", "index"))
        if os.path.exists(present):  # It knows which files are older than itself, so the copy keeps its time.
            shutil.copy2(present, index)
        git(top, "add", "--all", GIT_INDEX_FILE=index)
        git(top, "rm", "--cached", "--quiet", "--ignore-unmatch", FILE, GIT_INDEX_FILE=index)
        return git(top, "write-tree", GIT_INDEX_FILE=index)


def now():
    return datetime.datetime.now(datetime.timezone.utc).strftime("%Y-%m-%dT%H:%M:%SZ")


def write_whole(path, text):
    """Writes a file that a reader or a kill never finds half."""
    with open(f"{path}.part", "w", encoding="utf-8") as file:
        file.write(text)
        file.flush()
        os.fsync(file.fileno())
    os.replace(f"{path}.part", path)


class Results:
    """The last result of each test: {"test", "tree", "result", "reason", "skipped", "seconds", "date"}.

    A line of a file for each result, added when the test ends, so that a kill loses only tests that run."""

    def __init__(self, path):
        self.path, self.of = path, {}
        os.makedirs(os.path.dirname(path), exist_ok=True)
        if os.path.exists(path):
            with open(path, encoding="utf-8") as file:
                for line in file:
                    try:
                        row = json.loads(line)
                        self.of[row["test"]] = row
                    except (ValueError, KeyError, TypeError):
                        pass  # half a line, written when the runner was killed
        self.save()

    def add(self, name, tree, outcome, seconds):
        row = {"test": name, "tree": tree, "result": outcome.result, "reason": outcome.reason,
               "skipped": outcome.skipped, "seconds": round(seconds, 2), "date": now()}
        self.of[name] = row
        with open(self.path, "a", encoding="utf-8") as file:
            file.write(json.dumps(row) + "\n")

    def forget(self):
        """Lets every test run again. Its seconds stay known."""
        for row in self.of.values():
            row["tree"] = ""
        self.save()

    def save(self):
        write_whole(self.path, "".join(json.dumps(row) + "\n" for row in self.of.values()))

    def on(self, tree, tests):
        """Returns the rows of those tests that ran on this tree."""
        return [row for test in tests if (row := self.of.get(test.name)) and row["tree"] == tree]


def shortfalls(row):
    """Returns texts for a test that failed or did not run, and for each skipped case of a test that passed."""
    if row["result"] == "passed":
        return [f"not run: {row['test']}: {text}" for text in row["skipped"]]
    return [f"{row['result']}: {row['test']}: {row['reason']}"]


def summary(rows):
    """Returns counts, seconds and reasons of results. A skipped case of a test that passed counts as not run."""
    reasons = [text for row in sorted(rows, key=lambda row: row["test"]) for text in shortfalls(row)]
    failed = sum(row["result"] == "failed" for row in rows)
    return {"passed": sum(row["result"] == "passed" for row in rows), "failed": failed,
            "not_run": len(reasons) - failed, "seconds": round(sum(row["seconds"] for row in rows)),
            "reasons": reasons}


class Records:
    """The last run of each label (FILE): {label: {"tree", "commit", "date", "passed", "failed", "not_run", "seconds",
    "reasons", "green"}}. "green" holds tree, commit and date of the last run without a failure."""

    def __init__(self, top):
        self.top, self.path = top, os.path.join(top, FILE)
        self.of = {}
        if os.path.exists(self.path):
            with open(self.path, encoding="utf-8") as file:
                try:
                    self.of = json.load(file)
                except ValueError as error:
                    sys.exit(f"test: {FILE}: wanted JSON, found {error}; restore it: git checkout HEAD -- {FILE}")

    def is_green(self, label, tree):
        """Returns whether every test of a label ran on this tree and passed."""
        record = self.of.get(label, {})
        return record.get("tree") == tree and not record["failed"] and not record["not_run"]

    def set(self, label, tree, counts):
        """Records a run of a label, unless it is the same run."""
        before = self.of.get(label, {})
        record = {"tree": tree, "commit": git(self.top, "rev-parse", "HEAD"), "date": now(), **counts}
        same = ("tree", *counts)
        if [before.get(key) for key in same] == [record[key] for key in same]:
            return
        mark = {key: record[key] for key in ("tree", "commit", "date")}
        record["green"] = mark if not counts["failed"] and counts["passed"] else before.get("green")
        self.of[label] = record
        rows = ",\n".join(f"{json.dumps(label)}: {json.dumps(self.of[label])}" for label in sorted(self.of))
        write_whole(self.path, f"{{\n{rows}\n}}\n")

    def ages(self, labels):
        """Returns a text for each label: how many commits and days ago it was last green."""
        texts = []
        for label in labels:
            green = self.of.get(label, {}).get("green")
            if not green:
                texts.append(f"{label}: never")
                continue
            try:
                commits = git(self.top, "rev-list", "--count", f"{green['commit']}..HEAD")
            except subprocess.CalledProcessError:
                commits = "unknown"  # the commit is not in this clone
            then = datetime.datetime.fromisoformat(green["date"])
            days = (datetime.datetime.now(datetime.timezone.utc) - then).total_seconds() / 86400
            texts.append(f"{label}: {commits} commits, {days:.1f} days ago")
        return texts
