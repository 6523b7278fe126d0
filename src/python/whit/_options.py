"""The options of a render, from the library's table."""

from __future__ import annotations

import difflib
from typing import Any, NamedTuple

import numpy as np

from . import _whit
from ._error import in_python


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
            return ("x" if self.words == "WxH" else ",").join(str(v) for v in value)
        raise TypeError(f"{self.keyword}: expected {self.words or 'on|off'}, found {type(value).__name__}")


OPTIONS = {option.keyword: option for option in (Option(*row) for row in _whit.option_table())}


def texts(given: dict[str, Any], of: str = "render") -> list[tuple[str, str]]:
    """Names and values of the options that are not None, in the order of the table."""
    for keyword in given:
        if keyword not in OPTIONS:
            near = difflib.get_close_matches(keyword, OPTIONS, 1)
            hint = f"; is {near[0]!r} meant?" if near else ""
            raise TypeError(f"{of}() got an unexpected keyword argument {keyword!r}{hint}")
    return [(option.name, option.text(given[keyword])) for keyword, option in OPTIONS.items()
            if given.get(keyword) is not None]


def documentation() -> str:
    """One line for each option."""
    lines = []
    for option in OPTIONS.values():
        preset = f" [{option.preset}]" if option.preset else ""
        lines.append(f"{option.keyword} ({option.words or 'on|off'}){preset}: {in_python(option.help)}")
    return "\n".join(f"    {line}" for line in lines)
