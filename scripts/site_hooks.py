"""The additions of `make docs` to docs/ before MkDocs makes a site of it (the `hooks` of mkdocs.yml).

The menu is docs/README.md: its headings, and below each the pages that it links to; a folder's README brings all of its
folder. The reference of the YAML files and messages is made from schemas/. A link to a schema leads to its page there,
a link to any other file of the repository to a page that shows the file.
"""

import posixpath
import re
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from mkdocs.config.defaults import MkDocsConfig
from mkdocs.structure.files import File, Files
from mkdocs.structure.pages import Page
from scripts.schema_pages import pages

ROOT = Path(__file__).parents[1]
DOCS = ROOT / "docs"
REFERENCE = "schemas"
SHOWN = "repository"
"""The folders of generated pages."""

HEADING = re.compile(r"(?m)^## (.+)$")
ENTRY = re.compile(r"(?m)^- \[([^\]]+)\]\(([^)#]+)\)")
LINK = re.compile(r"(\]\()([^)\s#]+)(#[^)\s]*)?(\))")
LANGUAGES = {".py": "python", ".yaml": "yaml", ".json": "json", ".mjs": "js", ".toml": "toml", ".service": "ini"}

Menu = list[Any]


def on_config(config: MkDocsConfig) -> MkDocsConfig:
    """Set the menu; called by MkDocs."""
    config["nav"] = menu((DOCS / "README.md").read_text(encoding="utf-8"), {*made(), *_written()})
    return config


def on_files(files: Files, config: MkDocsConfig) -> Files:
    """Add the generated pages and their pictures; called by MkDocs."""
    shown = made()
    for path, text in shown.items():
        files.append(File.generated(config, path, content=text))
    for path, picture in pictures(shown).items():
        files.append(File.generated(config, path, abs_src_path=str(picture)))
    return files


def on_page_markdown(markdown: str, page: Page, config: MkDocsConfig, files: Files) -> str:
    """Rewrite the links of a page; called by MkDocs."""
    source = page.file.src_uri
    return LINK.sub(lambda found: f"{found[1]}{led(found[2], source)}{found[3] or ''}{found[4]}", markdown)


def menu(index: str, written: set[str]) -> Menu:
    """Return the site's menu: headings with the pages that they list; for a folder's README all of its folder."""
    titles = ["Start", *HEADING.findall(index)]
    sections: Menu = [{"Start": ["README.md"]}]
    for title, text in zip(titles[1:], HEADING.split(index)[2::2], strict=True):
        sections.append(
            {title: [_entry(label, led(link, "README.md"), written) for label, link in ENTRY.findall(text)]}
        )
    return sections


def _entry(label: str, path: str, written: set[str]) -> dict[str, Any]:
    folder, _, file = path.rpartition("/")
    if file != "README.md":
        return {label: path}
    inside = sorted(page for page in written if posixpath.dirname(page) == folder and page != path)
    return {label: [path, *inside]}


def _written() -> set[str]:
    if not (found := {file.relative_to(DOCS).as_posix() for file in DOCS.rglob("*.md")}):
        raise SystemExit(f"no page is in {DOCS}")
    return found


def made() -> dict[str, str]:
    """Return the generated pages by path: the reference, and files of the repository that pages link to."""
    written = {f"{REFERENCE}/{path}": text for path, text in pages(ROOT / "schemas").items()}
    waiting = [(page, (DOCS / page).read_text(encoding="utf-8")) for page in sorted(_written())]
    while waiting:
        page, text = waiting.pop()
        for file in filter(None, (outside(found[2], page) for found in LINK.finditer(text))):
            path = shown_at(file)
            if path in written or file.startswith("docs/") or _is_picture(file):
                continue
            if (ROOT / file).is_file():
                written[path] = _shown(file)
                waiting.append((path, written[path]))
    return written


def pictures(shown: Mapping[str, str]) -> dict[str, Path]:
    """Return the pictures on pages that show files of the repository, by their path in the site."""
    links = ((found[2], page) for page, text in shown.items() for found in LINK.finditer(text))
    files = (file for link, page in links if (file := outside(link, page)) and not file.startswith("docs/"))
    return {shown_at(file): ROOT / file for file in files if _is_picture(file) and (ROOT / file).is_file()}


def _is_picture(file: str) -> bool:
    return file.endswith((".png", ".webp", ".svg"))


def outside(link: str, page: str) -> str | None:
    """Return the file of the repository that a link from a page leads to; None if it is inside docs/."""
    if ":" in link:
        return None
    if page.startswith(f"{SHOWN}/"):
        target = posixpath.normpath(posixpath.join(posixpath.dirname(page.removeprefix(f"{SHOWN}/")), link))
    else:
        target = posixpath.normpath(posixpath.join("docs", posixpath.dirname(page), link))
    return None if target.startswith("docs/") and not page.startswith(f"{SHOWN}/") else target


def led(link: str, page: str) -> str:
    """Return a link as it is within the site."""
    target = outside(link, page)
    if target is None:
        return link
    to = target.removeprefix("docs/") if target.startswith("docs/") else shown_at(target)
    return posixpath.relpath(to, posixpath.dirname(page) or ".")


def shown_at(file: str) -> str:
    """Return the page of the site that shows a file of the repository."""
    if match := re.fullmatch(r"schemas/(.+)\.schema\.json", file):
        return f"{REFERENCE}/{match[1]}.md"
    if file.rstrip("/") in ("schemas", "schemas/messages"):
        return f"{REFERENCE}{file.rstrip('/').removeprefix('schemas')}/README.md"
    return f"{SHOWN}/{file}" if file.endswith(".md") or _is_picture(file) else f"{SHOWN}/{file}.md"


def _shown(file: str) -> str:
    text = (ROOT / file).read_text(encoding="utf-8")
    if file.endswith(".md"):
        return text
    language = LANGUAGES.get(Path(file).suffix, "text")
    return f"# {file}\n\n````{language}\n{text}\n````\n"
