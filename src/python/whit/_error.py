"""The exception of the module, and its messages, which name what Python users know."""

from __future__ import annotations

import errno
import os
import re
from typing import Any, Optional


def _errno_of(message: str, file: str) -> Optional[int]:
    """The system's number of an error, from the words at the end of its message; None: unknown."""
    for code in errno.errorcode:
        if message.endswith(os.strerror(code)):
            return code
    return None if os.path.exists(file) else errno.ENOENT


class Error(Exception):
    """An error in a scene, an option or a file.

    It is a ValueError as well for wrong usage and bad scenes, an OSError with `errno` and
    `filename` for files that cannot be read or written (FileNotFoundError where there is none), and
    a MemoryError for limits. str() is the message in one line. An attribute is None if it is
    unknown.
    """

    exit_status: int
    """Exit status of the program whit: 1 other, 2 wrong usage, 3 a bad scene or image, 4 cannot
    read or write, 5 a limit or memory ran out, 130 ended by a progress function."""
    file: Optional[str]
    """The file, or the name of a scene made of arrays."""
    place: Optional[str]
    """Line ("12", "12:5") or JSON pointer ("/lights/0") in the file."""
    expected: Optional[str]
    """The content that was expected there."""

    def __new__(cls, message: str, exit_status: int = 3, file: Optional[str] = None,
                *rest: Any, **named: Any) -> Error:
        kind = cls
        if cls is Error:
            kind = {2: UsageError, 3: UsageError, 4: FileError, 5: LimitError}.get(exit_status, cls)
            if kind is FileError and file and _errno_of(message, file) == errno.ENOENT:
                kind = MissingFileError
        return (OSError if issubclass(kind, OSError) else Exception).__new__(kind, message)

    def __init__(self, message: str, exit_status: int = 3, file: Optional[str] = None,
                 place: Optional[str] = None, expected: Optional[str] = None) -> None:
        super().__init__(message)
        self.exit_status = exit_status
        self.file = file
        self.place = place
        self.expected = expected
        if isinstance(self, OSError) and file:
            self.errno = _errno_of(message, file)
            self.strerror = message
            self.filename = file

    def __str__(self) -> str:
        return self.args[0]  # OSError would put errno and filename around it

    def __reduce__(self):
        return type(self), (str(self), self.exit_status, self.file, self.place, self.expected)


class UsageError(Error, ValueError):
    pass


class FileError(Error, OSError):
    pass


class MissingFileError(FileError, FileNotFoundError):
    pass


class LimitError(Error, MemoryError):
    pass


_NAMES = (  # what the library says, and what Python says; the first that fits counts
    (r"it was loaded without LoadOptions::moves", "the scene was made without moves=True"),
    (r"no channel '(\w+)': set\(.*\)", r"no channel '\1': render(channels=['\1'])"),
    (r"is not among what was to be moved when .* was loaded",
     "is not in the argument movable=[...] of whit.Scene()"),
    (r"WIDTHxHEIGHT in pixels, each (.*), as 1280x720", r"(width, height) in pixels, each \1"),
    (r"three numbers x,y,z without blanks, as 0,1.5,-2", "three numbers (x, y, z)"),
    (r"\bsetTime\b", "set_time"),
    (r"\bsetTransform\b", "set_transform"),
    (r"\bupdateMesh\b", "update_mesh"),
    (r"expected POINTER=VALUE, a JSON pointer .*", "expected a JSON pointer such as /lights/0"),
    (r"--set (/\S+)=true", r'settings={"\1": True}'),
    (r"--set ", ""),
    (r"--up y", 'settings={"/up": "y"}'),
    (r"or y, z or x: the axis that is up in", 'whit.Scene(settings={"/up": "z"}) has z up in'),
    (r"preset of other options, see below", "preset of other options"),
    (r"--viewpoint (outside|inside)", r'settings={"/viewpoint": "\1"}'),
    (r"--(strict|allow-outside)\b", lambda found: found[1].replace("-", "_") + "=True"),
    (r"--max-memory\b", "max_memory_gb"),
    (r"(?<![\w-])--([a-z][a-z-]*)", lambda found: found[1].replace("-", "_")),
)


def in_python(text: str) -> str:
    """A text of the library with Python's names in place of those of C++ and the command line."""
    for pattern, name in _NAMES:
        text = re.sub(pattern, name, text)
    return text


def of_library(message: str, status: int, *place: Optional[str]) -> Error:
    return Error(in_python(message), status, *(text and in_python(text) for text in place))
