"""The parts of a start as text that people can read and compare."""

from pathlib import Path
from typing import Any

from tests.golden.exhibitions import plain
from tests.golden.warm import Done


def written(folder: Path, name: str, title: str, done: Done, project: Path) -> None:
    """Write `NAME.txt`, and into `reaches/NAME.txt` what each part reaches, which is nearer to how it is built."""
    (folder / "reaches").mkdir(exist_ok=True)
    lines = [title, f"exit code: {done.code}"]
    if not done.nodes:
        lines += ["not begun:", *_indented(plain(done.out + done.err, project).splitlines())]
    for node in done.nodes:
        lines += _node(node)
    lines += ["subscribes to, in this order:", *_indented(done.subscribed)]
    lines += ["threads:", *_indented(done.threads), "threads that have not ended:", *_indented(done.left)]
    (folder / f"{name}.txt").write_text("\n".join(lines) + "\n", "utf-8")
    reaches = [f"{part['part']}: {', '.join(part['reaches'])}" for node in done.nodes for part in node["parts"]]
    if reaches:
        (folder / "reaches" / f"{name}.txt").write_text("\n".join(reaches) + "\n", "utf-8")


def _node(node: dict[str, Any]) -> list[str]:
    claims = "nothing" if node["claims"] is None else ", ".join(node["claims"])
    parts = [_part(part) for part in node["parts"]]
    return [
        f"node, which claims {claims}{', and leaps' * node['leaps']}",
        *_indented(["parts, in this order:", *_indented(parts)]),
        *_indented(["watch each step, in this order:", *_indented(node["observers"])]),
        *_indented(["called before the parts at each tick:", *_indented(node["each tick before the parts"])]),
    ]


def _part(part: dict[str, Any]) -> str:
    needs = f", needs {' and '.join(part['needs'])}" if "needs" in part else ""
    return f"{part['part']}{needs}{', patient' * ('patient' in part)}{', waits' * ('waits' in part)}"


def _indented(lines: list[str]) -> list[str]:
    return [f"  {line}" for line in lines]
