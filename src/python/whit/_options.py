"""The options of a render, from the library's table."""

from __future__ import annotations

from typing import Any, NamedTuple, Sequence

import numpy as np

from . import _whit
from ._error import Error, in_python


class Option(NamedTuple):
    name: str  # of the command line, "light-samples"
    words: str  # possible values
    help: str
    preset: str  # its default; empty where the scene decides

    @property
    def keyword(self) -> str:
        return self.name.replace("-", "_")

    def text(self, value: Any) -> str:
        """The value as on the command line."""
        if isinstance(value, (np.generic, np.ndarray)):
            value = value.tolist()
        if isinstance(value, bool):
            return "on" if value else "off"
        if isinstance(value, (int, float, str)):
            return str(value)
        if isinstance(value, (list, tuple)):
            if "COLOR" in self.words:
                return _hexadecimal(self.keyword, value)
            return ("x" if self.words == "WxH" else ",").join(str(v) for v in value)
        raise TypeError(f"{self.keyword}: expected {self.words or 'on|off'}, found {type(value).__name__}")


def _hexadecimal(what: str, color: Sequence[float]) -> str:
    """sRGB values from 0 to 1, or codes to 255 where one is above 1, as six digits."""
    scale = 255 if max(color, default=0) <= 1 else 1
    codes = [round(scale * value) for value in color if 0 <= value <= 255]
    if len(codes) != 3 or len(color) != 3:
        expected = "red, green and blue from 0 to 1, or codes from 0 to 255"
        raise Error(f"{what}: expected {expected}, found {color}", 2, expected=expected)
    return "".join(f"{code:02x}" for code in codes)


OPTIONS = {option.keyword: option for option in (Option(*row) for row in _whit.option_table())}


_ELSEWHERE = {  # what is no option in Python, but is set in another way
    "time": "Scene.set_time(seconds), or path_time for the camera path",
    **dict.fromkeys(("moves", "movable", "settings", "sky"), "an argument of whit.Scene()"),
}


def _hint(keyword: str, session: Any) -> str:
    """What is meant by an unknown option: the library knows those of other programs, too."""
    if keyword in _ELSEWHERE:
        return f"; use {_ELSEWHERE[keyword]}"
    name = keyword.replace("_", "-")
    try:
        session.option(name)
        meant = f"; did you mean {name!r}?"
    except Error as error:
        meant = str(error).partition(f"{name!r}")[2]
    return meant.replace("-", "_") or "; help(whit.Scene.render) lists all"


def texts(given: dict[str, Any], session: Any, of: str = "render") -> list[tuple[str, str]]:
    """Names and values of the options that are not None, in the order of the table."""
    for keyword in given:
        if keyword not in OPTIONS:
            raise TypeError(f"{of}() got an unexpected keyword argument {keyword!r}"
                            f"{_hint(keyword, session)}")
    return [(option.name, option.text(given[keyword])) for keyword, option in OPTIONS.items()
            if given.get(keyword) is not None]


def documentation() -> str:
    """One line for each option."""
    lines = []
    for option in OPTIONS.values():
        preset = f" [{option.preset}]" if option.preset else ""
        lines.append(f"{option.keyword} ({option.words or 'on|off'}){preset}: {in_python(option.help)}")
    return "\n".join(f"    {line}" for line in lines)
