"""Metadata of the package for an index, made when it is built: addresses, and a README whose links work there.

With `LUMEN_REPOSITORY=https://example.org/us/lumen` in the environment, links and pictures of the README lead to that
repository, and its addresses are added. Without it, links to files become their texts, and pictures are left out. This
is a hook of Hatchling.
"""

import os
import re
from pathlib import Path
from typing import Any

from hatchling.metadata.plugin.interface import MetadataHookInterface

_LINK = re.compile(r"(?P<picture>!?)\[(?P<text>[^]\n]*)\]\((?P<target>(?![a-z]+:|#)[^)\s]+)\)")
"""A link of Markdown to a file of the repository."""


class PackageMetadata(MetadataHookInterface):
    """Fills in `readme` and `urls` of pyproject.toml, which are dynamic."""

    def update(self, metadata: dict[str, Any]) -> None:
        """Add both to the table `project`; called by Hatchling."""
        repository = os.environ.get("LUMEN_REPOSITORY", "").rstrip("/")
        text = (Path(self.root) / "README.md").read_text(encoding="utf-8")
        metadata["readme"] = {"content-type": "text/markdown", "text": readme(text, repository)}
        metadata["urls"] = urls(repository)


def readme(text: str, repository: str) -> str:
    """Return the README for readers outside of the repository."""

    def moved(found: re.Match[str]) -> str:
        if not repository:
            return "" if found["picture"] else found["text"]
        kind = "raw" if found["picture"] else "blob"
        return f"{found['picture']}[{found['text']}]({repository}/{kind}/HEAD/{found['target']})"

    return _LINK.sub(moved, text)


def urls(repository: str) -> dict[str, str]:
    """Return the addresses of a repository; empty without one."""
    pages = {"Documentation": "blob/HEAD/docs/README.md", "Changelog": "blob/HEAD/CHANGELOG.md", "Issues": "issues"}
    more = {name: f"{repository}/{page}" for name, page in pages.items()}
    return {"Homepage": repository, "Source": repository, **more} if repository else {}
