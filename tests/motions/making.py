"""Helpers of the tests of motions: the shipped robot, and motions built from the text of a file."""

from functools import cache

from hypothesis import strategies as st

from lumen.language.diagnostics import Diagnostic
from lumen.language.motions import Interpolation, Keyframe, MotionDefinition
from lumen.language.robots import Body
from lumen.project.bodies import build_body
from lumen.project.document_report import DocumentReport
from lumen.project.motions import build_motion
from lumen.project.schema import check_schema
from lumen.project.yaml_reader import parse
from tests import ROOT

SHIPPED = ("goodbye", "dance", "sing", "photo")


@cache
def nao() -> Body:
    document, _ = parse("models/nao.yaml", (ROOT / "models/nao.yaml").read_bytes())
    assert document is not None
    body = build_body(document.data, DocumentReport(document), name="nao")
    assert body is not None
    return body


def read(
    text: str, name: str = "test", motions: dict[str, MotionDefinition] | None = None
) -> tuple[MotionDefinition | None, list[Diagnostic]]:
    """Return the motion in the text of a file, None if it has too many faults, and all findings."""
    document, diagnostics = parse(f"motions/{name}.yaml", text.encode())
    assert document is not None
    report = DocumentReport(document)
    data = check_schema(document, "motion", report)
    return build_motion(data, report, name=name, body=nao(), motions=motions), [*diagnostics, *report.diagnostics]


def made(text: str, **motions: MotionDefinition) -> MotionDefinition:
    """Return the motion in the text of a file, which must be free of findings."""
    motion, diagnostics = read(text, motions=motions)
    assert diagnostics == []
    assert motion is not None
    return motion


TURNING = [name for name in nao().joints if name not in nao().hands]


@st.composite
def motions(draw: st.DrawFn, how: tuple[Interpolation, ...] = tuple(Interpolation)) -> MotionDefinition:
    """Draw any motion of a few joints inside their limits, without handles, starting in Stand."""
    tracks, longest = {}, 0.0
    for joint in draw(st.lists(st.sampled_from(TURNING), min_size=1, max_size=4, unique=True)):
        limits = nao().joints[joint]
        steps = draw(st.lists(st.floats(0.05, 3.0), min_size=1, max_size=6))
        times = [sum(steps[: i + 1]) for i in range(len(steps))]
        angles = st.floats(limits.minimum, limits.maximum)
        tracks[joint] = tuple(Keyframe(t, draw(angles), draw(st.sampled_from(how))) for t in times)
        longest = max(longest, times[-1])
    stand = nao().postures["Stand"]
    return MotionDefinition("any", longest, tracks, start="Stand", origin={joint: stand[joint] for joint in tracks})
