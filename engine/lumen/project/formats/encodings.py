"""Decode a file whose encoding is not declared: UTF-8, UTF-16 if it has a byte order mark, else a guess."""

import re
from codecs import BOM_UTF16_BE, BOM_UTF16_LE

from lumen.language.diagnostics import Place
from lumen.project.formats.conversion_findings import ConversionFindings

_LATIN_WORD = re.compile(rb"[A-Za-z][\x80-\xff]|[\x80-\xff][A-Za-z]")
_CYRILLIC_WORD = re.compile(rb"[\xc0-\xff\xa8\xb8]{2,}")


def text_of(file: str, content: bytes, findings: ConversionFindings) -> str:
    """Return the text of a file without its byte order mark; a guessed encoding is reported in `findings`.

    The guess is Windows-1251 or Latin-1. Bytes that it leaves undefined become backslash escapes.
    """
    if content.startswith((BOM_UTF16_LE, BOM_UTF16_BE)):
        return content.decode("utf-16", errors="replace")
    try:
        return content.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        line = content.count(b"\n", 0, error.start) + 1
    name, codec = ("Windows-1251", "cp1251") if _is_cyrillic(content) else ("Latin-1", "latin-1")
    message = f"the file is not UTF-8: it is read as {name}"
    findings.changed(Place(file, line, 1), message, "check the names, or save the file as UTF-8")
    return content.decode(codec, errors="backslashreplace")


def _is_cyrillic(content: bytes) -> bool:
    """Return True if letters of Windows-1251 are next to each other more often than next to Latin letters."""
    return len(_CYRILLIC_WORD.findall(content)) > len(_LATIN_WORD.findall(content))
