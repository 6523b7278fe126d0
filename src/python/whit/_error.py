"""The exception of the module."""

from __future__ import annotations

from typing import Optional


class Error(Exception):
    """An error in a scene, an option or a file.

    str() is the message in one line. An attribute is None if it is unknown.
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

    def __init__(self, message: str, exit_status: int = 3, file: Optional[str] = None,
                 place: Optional[str] = None, expected: Optional[str] = None) -> None:
        super().__init__(message)
        self.exit_status = exit_status
        self.file = file
        self.place = place
        self.expected = expected

    def __reduce__(self):
        return Error, (str(self), self.exit_status, self.file, self.place, self.expected)
