"""Each component of ui.js in each of its states, in both themes: photographed, and judged by axe."""

import base64
import io
from collections.abc import Iterator

import pytest
from PIL import Image

from tests import ROOT
from tests.features.console.examples import Examples
from tests.features.console.test_conversation import violations
from tests.features.console.viewer import Viewer

pytestmark = pytest.mark.slow
PAGE = "examples/index.html"
PICTURES = ROOT / ".cache/pictures"
"""Where the photographs are kept, for whoever changes a look."""
NAMES = """
const done = arguments[0];
Promise.all([import("/pages/ui.js"), import("/examples/examples.js")]).then(([ui, examples]) =>
  done([Object.keys(ui), Object.keys(examples.EXAMPLES), Object.keys(examples.DIALOGS), examples.DRAW_NOTHING]));
"""


@pytest.fixture(scope="module")
def examples() -> Iterator[str]:
    with Examples() as one:
        yield one.address


def photograph(viewer: Viewer, name: str) -> Image.Image:
    """The whole page, which is also kept as a file."""
    size = viewer.run("return [document.documentElement.scrollWidth, document.documentElement.scrollHeight]")
    fields = {"clip": {"x": 0, "y": 0, "width": size[0], "height": size[1], "scale": 1}, "captureBeyondViewport": True}
    taken = base64.b64decode(viewer.command("Page.captureScreenshot", fields)["data"])
    PICTURES.mkdir(parents=True, exist_ok=True)
    (PICTURES / f"{name}.png").write_bytes(taken)
    return Image.open(io.BytesIO(taken)).convert("RGB")


def test_each_export_has_an_example(viewer: Viewer, examples: str) -> None:
    viewer.open(examples, PAGE)
    exports, shown, dialogs, drawing_nothing = viewer.driver.execute_async_script(NAMES)
    assert sorted([*shown, *dialogs, *drawing_nothing]) == sorted(exports)


@pytest.mark.parametrize("theme", ["light", "dark"])
def test_each_example_is_seen_and_axe_finds_nothing(viewer: Viewer, examples: str, theme: str) -> None:
    viewer.open(examples, PAGE, ready=".example", theme=theme)
    assert violations(viewer) == []
    assert viewer.complaints() == []
    picture = photograph(viewer, f"examples_{theme}")
    places = viewer.run(
        "return [...document.querySelectorAll('.example')].map((e) =>"
        " [`${e.dataset.of}: ${e.dataset.state}`, e.getBoundingClientRect().toJSON(), scrollY])"
    )
    blank = []
    for name, box, scrolled in places:
        left, top = int(box["left"]), int(box["top"] + scrolled)
        below_caption = top + 24
        part = picture.crop((left, below_caption, int(box["right"]), top + int(box["height"])))
        blank += [name] if len(part.getcolors(1 << 20) or ()) < 2 else []
    assert blank == []
    assert len(places) > 30


@pytest.mark.parametrize("theme", ["light", "dark"])
@pytest.mark.parametrize("dialog", ["Dialog", "Ask"])
def test_a_dialog_is_seen_and_axe_finds_nothing(viewer: Viewer, examples: str, theme: str, dialog: str) -> None:
    viewer.open(examples, f"{PAGE}?dialog={dialog}", ready="dialog[open]", theme=theme)
    assert violations(viewer) == []
    photograph(viewer, f"{dialog.lower()}_{theme}")


def test_the_themes_differ(viewer: Viewer, examples: str) -> None:
    grounds = []
    for theme in ("light", "dark"):
        viewer.open(examples, PAGE, ready=".example", theme=theme)
        grounds.append(photograph(viewer, f"examples_{theme}").getpixel((2, 2)))
    assert grounds[0] != grounds[1]
