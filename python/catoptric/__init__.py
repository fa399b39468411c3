"""Compares the cost and the error of techniques for rendering reflections.

    import catoptric

    scene = catoptric.load("cornell-mirrors")
    table = catoptric.compare(scene, ["reuse", "parallax", "secant"], size=(128, 128))
    print(table)

Pictures are numpy arrays of linear light: shape (height, width, 3), float32, top row first. Sizes are (width, height)
in pixels, times are milliseconds unless a name says otherwise, and lengths have the unit of the scene.
"""

from __future__ import annotations

import dataclasses
import json
import os
import re
import typing
import warnings

if typing.TYPE_CHECKING:
    import pandas

from ._errors import (BadData, CannotCreate, DeviceLost, Error, Exhausted, InternalError, IoError, MissingInput,
                      NoDevice, UsageError)

try:
    from . import _catoptric
except ImportError as error:
    _missing = re.search(r"(libvulkan\S*): cannot open shared object file", str(error))
    if _missing is None:
        raise
    raise ImportError(f"catoptric needs the Vulkan loader, but {_missing[1]} was not found: "
                      "apt-get install libvulkan1 mesa-vulkan-drivers") from None

from ._catoptric import (Camera, Device, Difference, Engine, Frame, Knob, Scene, Session, Technique, devices, diff,
                         encode_png, has_abandoned_device, load, read_picture, techniques, to_display, write_exr,
                         write_png)

__version__: str = _catoptric.version()
__all__ = [
    "BadData", "Camera", "CannotCreate", "ChosenPlan", "Device", "DeviceLost", "Difference", "Engine", "Error",
    "Exhausted", "Frame", "InternalError", "IoError", "Knob", "MissingInput", "NoDevice", "Scene", "Session",
    "Technique", "UsageError", "choose", "compare", "devices", "diff", "encode_png", "has_abandoned_device", "load",
    "read_picture", "techniques", "to_display", "views", "write_exr", "write_png"
]

Rows = list[dict[str, typing.Any]]


def _make_table(rows: Rows) -> "pandas.DataFrame | Rows":
    """Returns the rows as a pandas.DataFrame, or as they are if pandas is not installed."""
    try:
        import pandas
    except ImportError:
        return rows
    return pandas.DataFrame(rows)


def _compare(scene: Scene | str, names: typing.Iterable[str] | None, report: str | os.PathLike[str] | None,
             engine: Engine | None, **settings: typing.Any) -> _catoptric.Comparison:
    """Compares, writes the report if asked for, and issues warnings of the comparison."""
    if isinstance(names, str):
        names = [names]
    if report is not None:
        _catoptric.create_folder(report)  # before the measuring, so that the results have a place
    if isinstance(scene, str):
        scene = load(scene)
    found = _catoptric.compare(engine if engine is not None else Engine(), scene, list(names or ()), **settings)
    if report is not None:
        found.write(report)
    for sentence in found.warnings:
        warnings.warn(sentence, stacklevel=3)
    if found.stopped is not None:
        warnings.warn(f"the comparison ended early: {found.stopped}", RuntimeWarning, stacklevel=3)
    return found


def compare(scene: Scene | str, techniques: typing.Iterable[str] | None = None, *,
            size: tuple[int, int] = (512, 512), frames: int = 20, warmup: int = 8, camera: Camera | None = None,
            time: float = 0.0, exposure: float | None = None, ambient: float | None = None, seed: int = 1,
            model: str = "everything", reference: str = "", reference_seconds: float = 60.0,
            report: str | os.PathLike[str] | None = None,
            engine: Engine | None = None) -> "pandas.DataFrame | Rows":
    """Measures the time and the error of each technique, and returns a row for each.

    Errors compare a row's picture with a ray-traced reference, over the pixels that show a mirror. The defaults are
    those of the command ``catoptric compare``.

    Args:
        scene: A scene, or a name or path for ``load``.
        techniques: The rows: techniques or plans, such as "parallax:face=64". None: those that techniques propose.
        size: Width and height, pixels.
        frames: The number of measured frames of each row, in up to 6 rounds. 6 or more give the interval of gpu_ms.
        warmup: The number of frames that are rendered before the measured frames.
        camera: None: the scene's first camera.
        time: Seconds into the scene's motion.
        exposure: Stops. None: the file's exposure. If the file gives none, an exposure is measured.
        ambient: Light that reaches all surfaces. None: 0 with an environment, else 0.05.
        seed: The seed of sample patterns that are not a regular grid.
        model: "everything": each mirror is captured, in each frame. "required": only what the picture needs.
        reference: The technique that draws the reference. Empty: "raytrace:depth=16", or rays from lobes.
        reference_seconds: The most seconds that reduce the noise of the reference.
        report: A folder for report.html, report.json, rows.csv and the pictures. None: no files.
        engine: None: an engine on the default device.

    Returns:
        A pandas.DataFrame, or a list of dictionaries if pandas is not installed, with these columns:

        - technique, label: the technique, and the row's text.
        - gpu_ms, gpu_ms_low, gpu_ms_high: median time of a frame on the device and its 95 % interval, milliseconds.
        - frame_ms: median time of host and device work, milliseconds.
        - cpu_ms: median processor time of a frame, milliseconds; NaN unless the device is a processor.
        - judged_time: the time by which rows are judged: "cpu_ms" on a processor, else "gpu_ms" or "frame_ms".
        - noisy: whether other programs disturbed the times.
        - flip, rmse, mae, p99, max, off: errors over the mirrors, 0 to 1 (see ``Difference``).
        - psnr: dB; infinite for equal pictures.
        - nonfinite: pixels with a NaN or infinity.
        - flip_all, rmse_all: errors over the whole picture, 0 to 1.
        - front: whether no other row beats this row. Rows that tie may all be on the front.
        - scene_passes, scene_draws: renders of the scene per frame. scene_draws counts each face of a cube map.
        - memory_bytes: size of the frame's images.
        - model: "everything" or "required".

    Raises:
        UsageError: An unknown technique or knob, a value out of range, or a scene without a camera.
        NoDevice: No Vulkan driver is installed.

    Warns:
        RuntimeWarning: A failure ended the comparison early. The rows so far are returned.
    """
    found = _compare(scene, techniques, report, engine, size=size, camera=camera, time=time, exposure=exposure,
                     ambient=ambient, seed=seed, model=model, frames=frames, warmup=warmup, reference=reference,
                     reference_seconds=reference_seconds, views=0)
    return _make_table(found.rows())


def views(scene: Scene | str, techniques: typing.Iterable[str] | None = None, count: int = 30, *,
          size: tuple[int, int] = (512, 512), camera: Camera | None = None, time: float = 0.0,
          exposure: float | None = None, ambient: float | None = None, seed: int = 1, model: str = "everything",
          reference: str = "", reference_seconds: float = 60.0, report: str | os.PathLike[str] | None = None,
          engine: Engine | None = None) -> "pandas.DataFrame | Rows":
    """Measures the error of each technique in drawn views, and returns a row for each technique and view.

    A view is a camera that sees a mirror, at an instant within one period of the scene's motion. The same scene, time
    and seed draw the same views.

    Args:
        scene: A scene, or a name or path for ``load``.
        techniques: Techniques or plans. None: those that techniques propose.
        count: The number of views, at least 6.
        camera: The camera that determines the exposure if the file gives none. None: the scene's first camera.
        size, time, exposure, ambient, seed, model, reference, reference_seconds, report, engine: See ``compare``.

    Returns:
        A pandas.DataFrame, or a list of dictionaries if pandas is not installed, with these columns:

        - view: the number of the view, from 1.
        - technique, label: the technique, and its text.
        - flip, rmse, mae, psnr, p99, max, off, nonfinite, flip_all, rmse_all: see ``compare``.
        - seed, time, camera: the seed from which the camera was drawn, the instant in seconds, and the ``Camera``.

    Raises:
        UsageError: A count below 6, or an error that ``compare`` raises.
    """
    if count < 6:
        raise UsageError(f"count: wanted at least 6 views, found {count}")
    found = _compare(scene, techniques, report, engine, size=size, camera=camera, time=time, exposure=exposure,
                     ambient=ambient, seed=seed, model=model, frames=1, warmup=0, reference=reference,
                     reference_seconds=reference_seconds, views=count)
    return _make_table(found.views())


@dataclasses.dataclass(frozen=True)
class ChosenPlan:
    """A plan that keeps its limits, with its certificate, or the reason why none was found.

    Attributes:
        plan: A text for ``Session.frame`` and ``compare``, such as "1=reuse 2,3=secant". None: no plan keeps the limits.
        failure: Why no plan keeps the limits, a sentence. None if one does.
        document: The contents of plan.json, as ``catoptric choose`` writes them: rules ("plan"), "certificate",
            "proofs" and "candidates". If no plan keeps the limits, it holds the nearest plan with what that plan proves.
    """
    plan: str | None
    failure: str | None
    document: dict[str, typing.Any]

    def write(self, path: str | os.PathLike[str]) -> None:
        """Writes plan.json, which ``catoptric render --plan`` reads and ``catoptric choose --certify`` proves again.

        If no plan keeps the limits, the file holds the nearest plan with what that plan proves.
        """
        new = f"{os.fspath(path)}.{os.getpid()}.new"  # so that an older file stays until this one is complete
        try:
            with open(new, "w", encoding="ascii") as file:
                json.dump(self.document, file, indent=2)
                file.write("\n")
            os.replace(new, path)
        except BaseException:
            if os.path.exists(new):
                os.remove(new)
            raise


def choose(scene: Scene | str, techniques: typing.Iterable[str] | None = None, *, max_flip: float | None = None,
           max_rmse: float | None = None, max_ms: float | None = None, share: float = .95, confidence: float = .95,
           training_views: int = 0, cameras_per_instant: int = 3, proof_views: int = 0, proof_seed: int = 2,
           costs: str | os.PathLike[str] = "", size: tuple[int, int] = (512, 512), frames: int = 20, warmup: int = 8,
           camera: Camera | None = None, time: float = 0.0, exposure: float | None = None,
           ambient: float | None = None, seed: int = 1, model: str = "everything", reference: str = "",
           reference_seconds: float = 60.0, engine: Engine | None = None) -> ChosenPlan:
    """Chooses the cheapest plan that keeps a limit of error, or the closest within a limit of time.

    The plan is found in training views and proved on fresh views. Its certificate says: at least the share ``share`` of
    drawn views keeps the limit, with this confidence.

    Args:
        scene: A scene, or a name or path for ``load``.
        techniques: The candidates. None: those that techniques propose.
        max_flip, max_rmse: Limit of the error over the mirrors in a view, 0 to 1; one of the two at most.
        max_ms: Limit of the time of a frame, milliseconds. Alone: the plan with the least error is chosen.
        share: Share of views that must keep the limit, between 0 and 1.
        confidence: Confidence of the statement, between 0 and 1.
        training_views: Number of views in which candidates are judged, at least 6. 0: as many as show a breach of
            ``share`` with ``confidence``.
        cameras_per_instant: Number of neighbouring training views of one instant, which share captures.
        proof_views: Number of fresh views. 0: as few as can prove the share (59 for 95 % with 95 % confidence).
        proof_seed: The seed of the fresh views, another than ``seed``.
        costs: A file of another device's costs, from which times are predicted. Empty: times are measured.
        size, frames, warmup, camera, time, exposure, ambient, seed, model, reference, reference_seconds, engine: See
            ``compare``.

    Returns:
        The plan, or the reason why no plan keeps the limits.

    Raises:
        UsageError: No limit, two limits of error, or an error that ``compare`` raises.
    """
    if max_flip is not None and max_rmse is not None:
        raise UsageError("max_flip and max_rmse: wanted one of them at most, found both")
    if isinstance(techniques, str):
        techniques = [techniques]
    plan, failure, document = _catoptric.choose(
        engine if engine is not None else Engine(), load(scene) if isinstance(scene, str) else scene,
        list(techniques or ()), size=size, camera=camera, time=time, exposure=exposure, ambient=ambient, seed=seed,
        model=model, frames=frames, warmup=warmup, reference=reference, reference_seconds=reference_seconds,
        max_flip=max_flip, max_rmse=max_rmse, max_ms=max_ms, share=share, confidence=confidence,
        training_views=training_views, cameras_per_instant=cameras_per_instant, proof_views=proof_views,
        proof_seed=proof_seed, costs=os.fspath(costs))
    return ChosenPlan(plan or None, failure or None, json.loads(document))
