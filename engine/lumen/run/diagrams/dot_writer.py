"""A diagram for Graphviz: the same boxes, rows and arrows, laid out by `dot`."""

from collections.abc import Iterator

from lumen.run.diagrams.diagram import Diagram, StateBox

_HEAD = """\
digraph {
  compound=true; rankdir=TB; fontname="Helvetica"; labeljust=l; labelloc=t; bgcolor=white; nodesep=0.3
  node [shape=box, style="rounded,filled", fillcolor=white, color="#5b7492", fontname="Helvetica", fontsize=12]
  edge [color="#8496ac", arrowsize=0.7]"""


def dot_text(diagram: Diagram) -> str:
    """Return a diagram as DOT text that ends with a newline; `dot -Tsvg` draws it."""
    ids = {box.id: f"s{number}" for number, box in enumerate(diagram.all())}
    boxes = {box.id: box for box in diagram.all()}
    lines = [_HEAD, f"  label={_quoted(diagram.title)}"]
    lines += [line for box in diagram.boxes for line in _box(box, ids, 1)]
    lines += [_arrow(boxes[one], boxes[other], ids) for one, other in diagram.arrows if one in ids and other in ids]
    return "\n".join([*lines, "}"]) + "\n"


def _box(box: StateBox, ids: dict[str, str], depth: int) -> Iterator[str]:
    indent, id = "  " * depth, ids[box.id]
    label = _quoted("\n".join([("● " if box.first else "") + box.title, *box.rows]), left=True)
    if not box.within:
        look = ", peripheries=2" if box.final else ', fillcolor="#fff3cf"' if box.marked else ""
        yield f"{indent}{id} [label={label}{look}]"
        return
    yield f"{indent}subgraph cluster_{id} {{"
    yield f'{indent}  label={label}; style="rounded,filled"; fillcolor="#f4f7fb"; color="#b9c8da"'
    yield from (line for inner in box.within for line in _box(inner, ids, depth + 1))
    yield f"{indent}}}"


def _arrow(one: StateBox, other: StateBox, ids: dict[str, str]) -> str:
    """Return the line of an arrow; an arrow to or from a frame ends at the frame."""
    looks = [f"{end}=cluster_{ids[box.id]}" for end, box in (("ltail", one), ("lhead", other)) if box.within]
    shown = f" [{', '.join(looks)}]" if looks else ""
    return f"  {ids[_leaf(one).id]} -> {ids[_leaf(other).id]}{shown}"


def _leaf(box: StateBox) -> StateBox:
    return _leaf(next((inner for inner in box.within if inner.first), box.within[0])) if box.within else box


def _quoted(text: str, *, left: bool = False) -> str:
    escaped = text.replace("\\", "\\\\").replace('"', '\\"').replace("\n", "\\l" if left else "\\n")
    return f'"{escaped}{chr(92) + "l" if left and chr(10) in text else ""}"'
