"""What the package says of itself in an index, made when it is built: addresses, and a README whose links work there.

With `LUMEN_REPOSITORY=https://example.org/us/lumen` in the environment, links and pictures of the README lead to that
repository, and its addresses stand beside it. Without it nothing is claimed: links to files become their texts, and
pictures are left out. A hook of Hatchling.
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
        """Called by Hatchling, with the table `project`."""
        repository = os.environ.get("LUMEN_REPOSITORY", "").rstrip("/")
        text = (Path(self.root) / "README.md").read_text(encoding="utf-8")
        metadata["readme"] = {"content-type": "text/markdown", "text": readme(text, repository)}
        metadata["urls"] = urls(repository)


def readme(text: str, repository: str) -> str:
    """The README for who reads it elsewhere."""

    def moved(found: re.Match[str]) -> str:
        if not repository:
            return "" if found["picture"] else found["text"]
        kind = "raw" if found["picture"] else "blob"
        return f"{found['picture']}[{found['text']}]({repository}/{kind}/HEAD/{found['target']})"

    return _LINK.sub(moved, text)


def urls(repository: str) -> dict[str, str]:
    """The addresses of a repository, none where there is none."""
    pages = {"Documentation": "blob/HEAD/docs/README.md", "Changelog": "blob/HEAD/CHANGELOG.md", "Issues": "issues"}
    more = {name: f"{repository}/{page}" for name, page in pages.items()}
    return {"Homepage": repository, "Source": repository, **more} if repository else {}
