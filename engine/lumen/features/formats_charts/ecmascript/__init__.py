"""Translates conditions and values of statecharts between ECMAScript and Lumen's expressions.

Both are read into the tree of `lumen.expressions`, with the rest of ECMAScript as operators (`===`, `typeof`) and as
calls of methods (`.trim`, with the object as the first argument).
"""

from lumen.features.formats_charts.ecmascript.reader import ScriptNames, ScriptTranslator, read_condition, read_value
from lumen.features.formats_charts.ecmascript.script_parser import ScriptError, parse_script
from lumen.features.formats_charts.ecmascript.writer import Vocabulary, WrittenScript, write_expression

__all__ = [
    "ScriptError",
    "ScriptNames",
    "ScriptTranslator",
    "Vocabulary",
    "WrittenScript",
    "parse_script",
    "read_condition",
    "read_value",
    "write_expression",
]
