"""Checks the installed Python package. check.py package CATOPTRIC, check.py table or check.py documents FOLDER."""

import json
import math
import pathlib
import re
import signal
import subprocess
import sys
import threading
import time

import catoptric
import numpy

SIZE = (96, 64)


def check(is_right, text):
    """Ends the program with an error unless the condition holds."""
    if not is_right:
        sys.exit(f"python: {text}")


def measure_import():
    """Checks the seconds that `import catoptric` takes: the least of five, since other programs may disturb them."""
    code = "import time; t = time.perf_counter(); import catoptric; print(time.perf_counter() - t)"
    least = min(float(subprocess.check_output([sys.executable, "-c", code])) for _ in range(5))
    print(f"import: {least:.3f} s")
    check(least <= .3, f"import: wanted at most .3 s, found {least:.3f} s")


def read_exr(path):
    """Returns the pixels of an OpenEXR file. OpenImageIO's program writes them without compression."""
    plain = path.with_suffix(".plain.exr")
    subprocess.run(["oiiotool", path, "-ch", "R,G,B", "--compression", "none", "-o", plain], check=True)
    data, at, header = plain.read_bytes(), 8, {}
    while data[at]:
        name, kind, rest = data[at:].split(b"\0", 2)
        at += len(name) + len(kind) + 2
        length = int.from_bytes(data[at:at + 4], "little")
        header[name] = rest[4:4 + length]
        at += 4 + length
    left, top, right, bottom = numpy.frombuffer(header[b"dataWindow"], "<i4")
    width, height = right - left + 1, bottom - top + 1
    # After an offset for each row: the rows, with 8 bytes before the values of B, G and R.
    rows = numpy.frombuffer(data[at + 1 + 8 * height:], numpy.uint8).reshape(height, 8 + 12 * width)
    return rows[:, 8:].copy().view("<f4").reshape(height, 3, width)[:, ::-1].transpose(0, 2, 1)


def check_pictures(program, session):
    """Checks that arrays have the bytes of the pictures that the command line writes."""
    size = f"{SIZE[0]}x{SIZE[1]}"
    cases = {"raytrace": [], "reuse": [], "secant": [], "parallax": ["--frames", "4", "--warmup", "0"]}
    for technique, options in cases.items():
        path = pathlib.Path(f"{technique}.exr")
        subprocess.run([program, "render", "--technique", technique, "--size", size, "--quiet", *options, "-o", path],
                       check=True)
        session.forget()
        frame = session.frame(technique, size=SIZE, frames=4) if options else session.render(technique, size=SIZE)
        found = frame.hdr
        check(found.shape == (SIZE[1], SIZE[0], 3) and found.dtype == numpy.float32, f"{technique}: {found.shape}")
        check(found.tobytes() == read_exr(path).tobytes(), f"{technique}: other bytes than {path}")
        check(numpy.array_equal(found, catoptric.read_picture(path)), f"{technique}: read_picture reads other values")
        check(frame.gpu_ms > 0 and all(ms >= 0 for _, ms in frame.passes), f"{technique}: {frame.passes}")
        catoptric.write_exr(found, "again.exr")
        check(path.read_bytes() == pathlib.Path("again.exr").read_bytes(), f"{technique}: write_exr: other bytes")
    print(f"{len(cases)} pictures: the bytes of `catoptric render`")


def check_memory(session):
    """Checks that arrays share the memory of the frame, also after its last name is gone."""
    frame = session.frame("raytrace", size=SIZE)
    array = frame.hdr
    check(numpy.shares_memory(array, frame.hdr), "hdr: each access has its own memory")
    copy = array.copy()
    array[0, 0, 0] = 7
    check(frame.hdr[0, 0, 0] == 7, "hdr: writing into the array does not change the frame")
    array[0, 0, 0] = copy[0, 0, 0]
    del frame
    for _ in range(3):
        session.frame("raytrace", size=SIZE, exposure=1)
    check(numpy.array_equal(array, copy), "hdr: later frames changed the array")


def check_difference(program, session):
    """Checks that diff finds what `catoptric diff` finds."""
    a, b = session.render("reuse", size=SIZE).hdr, session.render("secant", size=SIZE).hdr
    catoptric.write_exr(a, "a.exr")
    catoptric.write_exr(b, "b.exr")
    for stops in (0.0, 1.5):
        text = subprocess.check_output([program, "diff", "a.exr", "b.exr", "--json", f"--exposure={stops}"])
        told, found = json.loads(text), catoptric.diff(a, b, exposure=stops)
        for name in ("flip", "rmse", "mae", "psnr", "p99", "max"):
            value = getattr(found, name)
            check(math.isclose(value, told[name], rel_tol=1e-12), f"diff: {name}: wanted {told[name]}, found {value}")
    check(found.flip_map.shape == (SIZE[1], SIZE[0]), f"diff: flip_map has the shape {found.flip_map.shape}")
    same = catoptric.diff(a, a)
    check(same.flip == 0 and same.rmse == 0 and same.psnr is None, f"diff of equal pictures: {same}")
    mask = numpy.zeros(a.shape[:2], bool)
    mask[found.max_at] = True
    one = catoptric.diff(a, b, exposure=stops, mask=mask)
    check(one.pixels == 1 and one.max == found.max, f"diff over one pixel: {one.pixels}, {one.max}")
    check(catoptric.encode_png(a)[:4] == b"\x89PNG", "encode_png: no PNG")
    shown = catoptric.to_display(a)
    check(shown.max() <= 1 and numpy.allclose(shown * 255, numpy.round(shown * 255), atol=1e-3), "to_display")


def expect_error(kind, failure, text, function, *arguments, **named):
    """Checks the type, the exit code and the text of an exception."""
    try:
        function(*arguments, **named)
    except kind as error:
        check(isinstance(error, catoptric.Error) and error.failure == failure and text in str(error),
              f"wanted '{text}' with {failure}, found {error!r} with {getattr(error, 'failure', None)}")
        return
    sys.exit(f"python: wanted {kind.__name__} with '{text}', found none")


def check_errors(session):
    """Checks that failures of the library are Python exceptions with the same text."""
    black = numpy.zeros((4, 5, 3), numpy.float32)
    expect_error(ValueError, 2, "did you mean 'secant'?", session.frame, "secand")
    expect_error(catoptric.UsageError, 2, "size: wanted", session.frame, size=(0, 5))
    expect_error(catoptric.UsageError, 2, "model: wanted", session.frame, model="all")
    expect_error(catoptric.UsageError, 2, "cornell-mirrors", catoptric.load, "cornell-mirror")
    expect_error(FileNotFoundError, 66, "none.glb", catoptric.load, "none.glb")
    expect_error(catoptric.BadData, 65, "", catoptric.diff, black, black[:2])
    expect_error(catoptric.BadData, 65, "mask: wanted", catoptric.diff, black, black, mask=numpy.ones((2, 2), bool))
    expect_error(catoptric.UsageError, 2, "no such card", catoptric.Engine, "no such card")
    expect_error(catoptric.UsageError, 2, "count: wanted", catoptric.views, "cornell-mirrors", count=5)
    expect_error(OSError, 73, "none", catoptric.write_png, black, "none/black.png")


def check_threads(session):
    """Checks that other Python threads run during a frame, and that threads may share a session."""
    counted, done, pictures = 0, threading.Event(), []

    def render():
        pictures.append(session.frame("secant", size=SIZE).hdr)

    session.frame("secant", size=SIZE)
    threads = [threading.Thread(target=render) for _ in range(3)]
    for thread in threads:
        thread.start()
    waiter = threading.Thread(target=lambda: ([thread.join() for thread in threads], done.set()))
    waiter.start()
    while not done.wait(.001):
        counted += 1
    check(counted > 0 and len(pictures) == 3, f"threads: counted {counted} with {len(pictures)} pictures")


def check_interrupt():
    """Checks that Ctrl+C ends a comparison by KeyboardInterrupt."""
    code = ("import catoptric; print('begun', flush=True)\n"
            "try: catoptric.compare('cornell-mirrors', ['secant'], frames=100000)\n"
            "except KeyboardInterrupt: print('interrupted')")
    process = subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE, text=True)
    process.stdout.readline()
    time.sleep(4)
    process.send_signal(signal.SIGINT)
    begun = time.monotonic()
    rest, _ = process.communicate(timeout=60)
    check(rest == "interrupted\n" and process.returncode == 0, f"Ctrl+C: found {rest!r} and {process.returncode}")
    print(f"Ctrl+C: ended in {time.monotonic() - begun:.1f} s")


def check_rows():
    """Checks the rows without pandas, and the files of a report."""
    rows = catoptric.compare("cornell-mirrors", ["reuse", "raytrace"], size=(64, 48), frames=6, warmup=1,
                             report="report")
    check([row["technique"] for row in rows] == ["reuse", "raytrace"], f"rows: {rows}")
    reuse, rays = rows
    check(reuse["gpu_ms_low"] <= reuse["gpu_ms"] <= reuse["gpu_ms_high"], f"times: {reuse}")
    check(reuse["flip"] > .05 > rays["flip"] and reuse["scene_passes"] > rays["scene_passes"] == 0, f"errors: {rows}")
    told = json.loads(pathlib.Path("report/report.json").read_text())["rows"]
    check(told[0]["label"] == "reuse" and pathlib.Path("report/report.html").exists(), "report: other rows")


def check_choice(program):
    """Checks that choose finds what `catoptric choose` finds, and that its file is a plan of the command line."""
    limits = {"share": .5, "training_views": 6, "cameras_per_instant": 1, "size": (48, 48), "frames": 6, "warmup": 1}
    chosen = catoptric.choose("cornell-mirrors", ["reuse", "raytrace:depth=3"], max_flip=.1, **limits)
    options = ["--share", ".5", "--training-views", "6", "--cameras-per-instant", "1", "--size", "48x48", "--frames", "6",
               "--warmup", "1", "--quiet", "--max-error", "flip=.1", "--techniques", "reuse", "raytrace:depth=3"]
    subprocess.run([program, "choose", "cornell-mirrors", *options, "-o", "told.json"], check=True,
                   stdout=subprocess.DEVNULL)
    told = json.loads(pathlib.Path("told.json").read_text())
    check(chosen.plan == "raytrace:depth=3" and chosen.failure is None, f"choose: {chosen.plan}, {chosen.failure}")
    check(chosen.document["plan"] == told["plan"], f"choose: wanted {told['plan']}, found {chosen.document['plan']}")
    for part in ("proofs", "candidates"):  # the errors are those of the same views; only times differ
        wanted, found = ([(plan["technique"], plan["errors"]) for plan in document[part]]
                         for document in (told, chosen.document))
        check(wanted == found and len(found) > 0, f"choose: {part}: wanted {wanted}, found {found}")
    unmeasured = {"ms", "ms_range"}
    wanted, found = ({name: value for name, value in document["certificate"].items() if name not in unmeasured}
                     for document in (told, chosen.document))
    check(wanted == found, f"choose: wanted the certificate {wanted}, found {found}")
    chosen.write("plan.json")
    subprocess.run([program, "render", "--plan", "plan.json", "--size", "48x48", "--quiet", "-o", "plan.png"], check=True)
    none = catoptric.choose("cornell-mirrors", ["reuse"], max_rmse=0, **limits)
    check(none.plan is None and "the best that is reachable is reuse" in none.failure, f"choose: {none.failure}")
    none.write("nearest.json")
    nearest = json.loads(pathlib.Path("nearest.json").read_text())
    check(nearest["plan"][0]["technique"] == "reuse" and nearest["nearest"]["why"] == none.failure, f"choose: {nearest}")
    expect_error(catoptric.UsageError, 2, "wanted one of them", catoptric.choose, "flat", max_flip=.1, max_rmse=.1)
    expect_error(catoptric.UsageError, 2, "a limit is missing", catoptric.choose, "flat")
    expect_error(FileNotFoundError, 66, "none.json", catoptric.choose, "flat", max_ms=4, costs="none.json")
    print(f"choose: {chosen.plan}, as the command line")


def check_package(program):
    measure_import()
    names = [technique.name for technique in catoptric.techniques()]
    check({"naive", "reuse", "parallax", "secant", "raytrace"} <= set(names), f"techniques: {names}")
    check(catoptric.devices() and all(getattr(catoptric, name).__doc__ for name in catoptric.__all__), "docstrings")
    check("pandas" not in sys.modules, "importing catoptric imported pandas")
    scene = catoptric.load("cornell-mirrors")
    check(len(scene.mirrors) == 4 and scene.triangles > 0 and len(scene.cameras) > 0, f"{scene}: {scene.mirrors}")
    session = catoptric.Session(catoptric.Engine(), scene)
    check_pictures(program, session)
    check_memory(session)
    check_difference(program, session)
    check_errors(session)
    check_threads(session)
    check_rows()
    check_choice(program)
    check_interrupt()


def check_table():
    """Checks the tables that pandas makes."""
    import pandas
    table = catoptric.compare("cornell-mirrors", ["secant"], size=(48, 48), frames=6, warmup=1)
    check(isinstance(table, pandas.DataFrame) and table.loc[0, "technique"] == "secant", f"table: {table}")
    check((table.dtypes[["gpu_ms", "flip", "rmse", "psnr"]] == "float64").all(), f"types: {table.dtypes}")
    views = catoptric.views("cornell-mirrors", ["reuse", "secant"], 6, size=(48, 48))
    means = views.groupby("label")["flip"].mean()
    check(len(views) == 12 and means["secant"] < means["reuse"], f"views: {views}")
    session = catoptric.Session(catoptric.Engine(), catoptric.load("cornell-mirrors"))
    view = views.iloc[0]
    drawn = session.render(view["label"], size=(48, 48), camera=view["camera"], time=view["time"]).hdr
    truth = session.render("raytrace:depth=16", size=(48, 48), camera=view["camera"], time=view["time"]).hdr
    flip = catoptric.diff(drawn, truth).flip
    check(math.isclose(flip, view["flip_all"], rel_tol=1e-6), f"views: wanted {view['flip_all']}, found {flip}")


def check_documents(folder):
    """Runs the code of docs/python.md, and the notebook."""
    import nbclient
    import nbformat
    begun = time.monotonic()
    blocks = re.findall(r"^```python\n(.*?)^```", (folder / "python.md").read_text(), re.M | re.S)
    check(len(blocks) >= 3, f"python.md: wanted at least 3 blocks of code, found {len(blocks)}")
    exec(compile("\n".join(blocks), "python.md", "exec"), {})
    print(f"python.md: {time.monotonic() - begun:.1f} s")
    begun = time.monotonic()
    notebook = nbformat.read(folder / "python.ipynb", 4)
    nbclient.NotebookClient(notebook, timeout=120, kernel_name="python3").execute()
    print(f"python.ipynb: {time.monotonic() - begun:.1f} s")


if __name__ == "__main__":
    part, *rest = sys.argv[1:]
    if part == "package":
        check_package(*rest)
    elif part == "table":
        check_table()
    else:
        check_documents(pathlib.Path(rest[0]))
