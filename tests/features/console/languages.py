"""Texts of the console in its languages, and a search for English text on an Indonesian page."""

import re

from tests import ROOT
from tests.features.console.viewer import Viewer

TEXTS = ROOT / "engine/lumen/features/console/pages/texts"
SHOWN = """
const names = ".place, .state-name, option, code, .values, .way-head > :last-child, th[scope=row]";
const quoted = `[lang]:not(html):not([lang=id]), rest-button .broken, ${names}`;
const found = [], named = ["title", "aria-label", "aria-description", "aria-valuetext", "placeholder", "alt"];
for (const element of document.querySelectorAll("body *")) {
  if (element.closest(quoted)) continue;
  for (const node of element.childNodes) if (node.nodeType === Node.TEXT_NODE) found.push(node.textContent);
  for (const name of named) found.push(element.getAttribute(name) ?? "");
}
return [...new Set(found.map((text) => text.trim()).filter(Boolean))];
"""
ENGLISH_WORDS = re.compile(
    r"\b(the|is|are|was|were|has|have|not|when|with|from|that|this|which|after|before|and|or|of|by|it|its|for|no|"
    r"hears|says|plays|does|cannot|must|press|sign|robot's|files|saved|stopped|open|closed|unknown)\b",
    re.IGNORECASE,
)
QUOTED = re.compile(r"“[^”]*”|\S*[._|/=]\S*|→ \S+")
"""Quoted words, and names of the project: neither is translated."""


def texts(code: str) -> dict[str, str]:
    """Return the texts of the pages in a language, by their names."""
    source = (TEXTS / f"{code}.js").read_text("utf-8")
    return dict(re.findall(r'"([\w. -]+)": "((?:[^"\\]|\\.)*)"', source))


def phrases() -> list[tuple[str, str]]:
    """Return the sentences of the console and the engine, each with its Indonesian."""
    return re.findall(r'\["((?:[^"\\]|\\.)*)",\s+"((?:[^"\\]|\\.)*)"\]', (TEXTS / "phrases_id.js").read_text("utf-8"))


def english_on(viewer: Viewer) -> list[str]:
    """Return the English texts of the page: each is a text of the English pages, or has common English words."""
    english, indonesian = {*texts("en").values()}, {*texts("id").values()}
    shown = map(str, viewer.run(SHOWN))
    return [text for text in shown if text in english - indonesian or ENGLISH_WORDS.search(QUOTED.sub("", text))]
