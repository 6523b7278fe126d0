"""The exception of the module."""

from __future__ import annotations

from typing import Optional


class Error(Exception):
    """What is wrong with a scene, an option or a file.

    str() says all of it in a line for people. Of what the attributes say, None is what is not
    known.
    """

    exit_status: int
    """Of the program whit: 1 other, 2 wrong usage, 3 a bad scene or image, 4 cannot read or write,
    5 a limit or memory ran out, 130 ended by a progress function."""
    file: Optional[str]
    """The file, or the name of a scene made of arrays."""
    place: Optional[str]
    """Line ("12", "12:5") or JSON pointer ("/lights/0") in the file."""
    expected: Optional[str]
    """What should be there."""

    def __init__(self, message: str, exit_status: int = 3, file: Optional[str] = None,
                 place: Optional[str] = None, expected: Optional[str] = None) -> None:
        super().__init__(message)
        self.exit_status = exit_status
        self.file = file
        self.place = place
        self.expected = expected

    def __reduce__(self):
        return Error, (str(self), self.exit_status, self.file, self.place, self.expected)
