"""Build the extension of VS Code: `python scripts/vsix.py --output lumen.vsix`. Needs npm the first time.

A VSIX is a zip with the extension's folder, the packages that it runs on, and two lists of its content.
"""

import argparse
import json
import subprocess
import sys
import zipfile
from pathlib import Path
from xml.sax.saxutils import escape, quoteattr

ROOT = Path(__file__).parents[1]
EXTENSION, CLIENT = ROOT / "editors/vscode", ROOT / ".cache/vscode/node_modules"
FILES = ("package.json", "extension.js", "terminal.js", "README.md", "LICENSE")
KEPT = (".js", ".json", ".md", ".txt")
"""Kinds of files to keep of the packages; sources, types and maps are left out."""
SAME_TIME = (1980, 1, 1, 0, 0, 0)

TYPES = """<?xml version="1.0" encoding="utf-8"?>
<Types xmlns="http://schemas.openxmlformats.org/package/2006/content-types">
{}
</Types>
"""
MANIFEST = """<?xml version="1.0" encoding="utf-8"?>
<PackageManifest Version="2.0.0" xmlns="http://schemas.microsoft.com/developer/vsx-schema/2011">
  <Metadata>
    <Identity Language="en-US" Id={name} Version={version} Publisher={publisher}/>
    <DisplayName>{title}</DisplayName>
    <Description xml:space="preserve">{description}</Description>
    <Categories>{categories}</Categories>
    <License>extension/LICENSE</License>
    <Properties><Property Id="Microsoft.VisualStudio.Code.Engine" Value={engine}/></Properties>
  </Metadata>
  <Installation><InstallationTarget Id="Microsoft.VisualStudio.Code"/></Installation>
  <Dependencies/>
  <Assets>
    <Asset Type="Microsoft.VisualStudio.Code.Manifest" Path="extension/package.json" Addressable="true"/>
    <Asset Type="Microsoft.VisualStudio.Services.Content.Details" Path="extension/README.md" Addressable="true"/>
    <Asset Type="Microsoft.VisualStudio.Services.Content.License" Path="extension/LICENSE" Addressable="true"/>
  </Assets>
</PackageManifest>
"""


def main() -> str | None:
    """Write the file; return the reason if that is impossible."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0] if __doc__ else "")
    parser.add_argument("--output", type=Path, default=Path("lumen.vsix"), metavar="FILE")
    output = parser.parse_args().output
    if subprocess.run([sys.executable, ROOT / "scripts/fetch.py", ".cache/vscode"], check=False).returncode:
        return "the language client could not be fetched"
    build(output)
    print(f"{output.absolute()}: {output.stat().st_size / 1e3:.0f} kB")
    return None


def build(output: Path) -> None:
    """Write the extension; equal files give equal bytes."""
    data = json.loads((EXTENSION / "package.json").read_text("utf-8"))
    files = {f"extension/{name}": (EXTENSION / name).read_bytes() for name in FILES}
    if not (packages := sorted(CLIENT.rglob("*"))):
        raise SystemExit(f"nothing is in {CLIENT}: the extension would be without its language client")
    for file in packages:
        wanted = file.suffix in KEPT or file.name.upper().startswith(("LICEN", "NOTICE"))
        if file.is_file() and wanted and not file.name.endswith((".d.ts", ".map")):
            files[f"extension/node_modules/{file.relative_to(CLIENT).as_posix()}"] = file.read_bytes()
    manifest = MANIFEST.format(
        name=quoteattr(data["name"]),
        version=quoteattr(data["version"]),
        publisher=quoteattr(data["publisher"]),
        title=escape(data["displayName"]),
        description=escape(data["description"]),
        categories=escape(",".join(data["categories"])),
        engine=quoteattr(data["engines"]["vscode"]),
    )
    types = {Path(name).suffix: "application/octet-stream" for name in files} | {".vsixmanifest": "text/xml"}
    rows = [f'  <Default Extension="{kind}" ContentType="{what}"/>' for kind, what in sorted(types.items()) if kind]
    lists = {
        "[Content_Types].xml": TYPES.format("\n".join(rows)).encode(),
        "extension.vsixmanifest": manifest.encode(),
    }
    with zipfile.ZipFile(output, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, content in {**lists, **files}.items():
            archive.writestr(zipfile.ZipInfo(name, SAME_TIME), content, zipfile.ZIP_DEFLATED)


if __name__ == "__main__":
    sys.exit(main())
