"""Translates conditions and values of statecharts between ECMAScript and Lumen's expressions.

Both are parsed into the trees of `lumen.expressions`. There, ECMAScript's methods are functions, such as `.trim` with
the object as the first argument, and `===` and `typeof` are operators.
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
