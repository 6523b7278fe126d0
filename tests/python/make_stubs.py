"""Writes src/python/whit/__init__.pyi: what __init__.py beside it declares, with a keyword for
every option.

    PYTHONPATH=build/python python3 tests/python/make_stubs.py           # writes it
    PYTHONPATH=build/python python3 tests/python/make_stubs.py --check   # status 1 where it differs
"""

import ast
import pathlib
import sys

from whit import _options

FOLDER = pathlib.Path(__file__).resolve().parents[2] / "src" / "python" / "whit"
HEADER = "# By make_stubs.py, of __init__.py and the library's table of options.\n"


# The Python types of options, by the words that stand for their values.
TYPES = {
    "": "bool", "on|off": "bool", "N": "int", "X": "float", "DEG": "float", "HEIGHT": "float",
    "x,y,z": "Sequence[float]",
    "WxH": "Union[str, tuple[int, int]]",
    "x0,y0,x1,y1": "Union[str, tuple[int, int, int, int]]",
    "EV|auto": 'Union[float, Literal["auto"]]',
    "NAME": "Union[str, Camera]",
}


def _annotation(words):
    if words in TYPES:
        return TYPES[words]
    if "COLOR" in words:
        return "Union[str, Sequence[float]]"
    if "|" in words:
        choices = [w if w.isdigit() else f'"{w}"' for w in words.split("|")]
        return f"Literal[{', '.join(choices)}]"
    if "," in words:
        return "Union[str, Sequence[str]]"
    return "str"


def _options_of_render():
    text = ", ".join(f"{option.keyword}: Optional[{_annotation(option.words)}] = None"
                     for option in _options.OPTIONS.values())
    function = ast.parse(f"def render(self, *, {text}): ...").body[0]
    return function.args.kwonlyargs, function.args.kw_defaults


def _stub(node):
    """The declaration without its body."""
    if isinstance(node, ast.ClassDef):
        node.body = [_stub(m) for m in node.body if isinstance(m, (ast.FunctionDef, ast.AnnAssign))]
    elif isinstance(node, ast.AnnAssign):  # _native()
        text = f"@property\ndef {node.target.id}(self) -> {ast.unparse(node.annotation)}: ..."
        node = ast.parse(text).body[0]
    elif isinstance(node, ast.FunctionDef):
        node.body = [ast.Expr(ast.Constant(...))]
        if node.name == "render":
            names, presets = _options_of_render()
            node.args.kwonlyargs += names
            node.args.kw_defaults += presets
            node.args.kwarg = None
    return node


def stubs() -> str:
    module = ast.parse((FOLDER / "__init__.py").read_text())
    kept = []
    for node in module.body:
        if isinstance(node, ast.ImportFrom) and node.module == "typing":
            kept.append(ast.parse("from typing import Any, Callable, Iterator, KeysView, Literal, "
                                  "Mapping, Optional, Sequence, Union").body[0])
        elif isinstance(node, ast.ImportFrom) and node.level == 1:
            if node.module in ("_arrays", "_camera", "_error", "_rays"):
                name = node.names[0].name
                node.names[0].asname = name
                kept.append(node)
        elif isinstance(node, ast.ClassDef) or (isinstance(node, ast.Import)
                                                and node.names[0].name != "operator"):
            kept.append(_stub(node))
        elif isinstance(node, ast.Assign) and isinstance(node.targets[0], ast.Name):
            if node.targets[0].id == "__version__":
                kept.append(ast.parse("__version__: str").body[0])
            else:
                kept.append(node)
    return HEADER + "\n".join(ast.unparse(node) for node in kept) + "\n"


def main() -> int:
    path = FOLDER / "__init__.pyi"
    text = stubs()
    if "--check" not in sys.argv:
        path.write_text(text)
        return 0
    if path.read_text() == text:
        return 0
    print(f"{path} is not what make_stubs.py makes of __init__.py and the options", file=sys.stderr)
    return 1


if __name__ == "__main__":
    sys.exit(main())
