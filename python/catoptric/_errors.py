"""Exceptions of the library. Each class has the exit code of the program ``catoptric`` as ``failure``."""

__name__ = "catoptric"  # tracebacks name the classes as programs do


class Error(Exception):
    """The base of all exceptions that Catoptric raises.

    The text says what failed, where, what was expected and what was found.

    Attributes:
        failure: The exit code that the program ``catoptric`` would return.
    """

    failure: int = 70


class UsageError(Error, ValueError):
    """An unknown name, or a value out of range."""

    failure = 2


class BadData(Error, ValueError):
    """An input file has invalid contents, or two pictures have different sizes."""

    failure = 65


class MissingInput(Error, FileNotFoundError):
    """An input file does not exist."""

    failure = 66


class NoDevice(Error, RuntimeError):
    """There is no Vulkan device, or none has the features that the engine needs."""

    failure = 69


class InternalError(Error, RuntimeError):
    """A bug of the library, or a part of it that cannot be loaded."""

    failure = 70


class CannotCreate(Error, OSError):
    """An output file or folder cannot be created."""

    failure = 73


class IoError(Error, OSError):
    """Reading or writing failed half-way."""

    failure = 74


class Exhausted(Error, MemoryError):
    """Out of memory, or over a limit of the device."""

    failure = 75


class DeviceLost(Error, RuntimeError):
    """The device is lost. Its engine and sessions cannot be used any more: make another engine."""

    failure = 76
