"""Subtitles and a title for a film's pictures, drawn over the pixels with Pillow."""

import unicodedata
from functools import lru_cache
from typing import NamedTuple

import lumen.features.simulation.installed  # noqa: F401  # first: reports missing packages

# isort: split
import numpy as np
from numpy.typing import NDArray
from PIL import Image, ImageDraw, ImageFont

FONTS = ("DejaVuSans.ttf", "NotoSans-Regular.ttf", "LiberationSans-Regular.ttf", "Arial.ttf", "arial.ttf")
"""The system fonts to try, in order; without any, Pillow's own font is used, which has no accents."""

SUBTITLE_HEIGHT, TITLE_HEIGHT = 0.05, 0.1
"""The height of a line, as a share of the picture's height."""

MAX_LINES = 2
"""The maximum number of lines of a subtitle: more would hide the robot and reveal words before they are spoken."""

SUBTITLE_WIDTH = 0.72
"""The maximum width of a line of subtitles, as a share of the picture's width."""

CLAUSE_ENDS = ".,;:!?…"
ROBOT_COLOUR, VISITOR_COLOUR = (255, 255, 255), (255, 221, 130)
_BOX = (12, 16, 24, 185)

Font = ImageFont.FreeTypeFont | ImageFont.ImageFont
Colour = tuple[int, int, int]


class Overlay(NamedTuple):
    """Letters on a background: an image with opacity, and its place in a picture."""

    pixels: NDArray[np.uint8]
    """The image in RGBA, Shape (height, width, 4)."""
    left: int
    """The distance from the picture's left edge [px]."""
    top: int
    """The distance from the picture's upper edge [px]."""

    def lay_on(self, picture: NDArray[np.uint8], opacity: float = 1.0) -> None:
        """Blend the overlay into a picture, Shape (height, width, 3), in place; `opacity` is from 0 to 1."""
        height, width = self.pixels.shape[:2]
        part = picture[self.top : self.top + height, self.left : self.left + width]
        alpha = self.pixels[:, :, 3:].astype(np.uint16) * round(256 * opacity) // 256
        part[:] = (part * (255 - alpha) + self.pixels[:, :, :3] * alpha) // 255


@lru_cache(maxsize=64)
def subtitle_pages(text: str, width: int, height: int) -> tuple[str, ...]:
    """Return the text as successive subtitles of at most MAX_LINES lines, split at the end of a clause if possible.

    `width` and `height` are the picture's size [px].
    """
    font, plain = _font(round(height * SUBTITLE_HEIGHT * 0.78))

    def fits(words: list[str]) -> bool:
        return len(_wrapped(_written(" ".join(words), plain), font, round(width * SUBTITLE_WIDTH))) <= MAX_LINES

    pages: list[list[str]] = [[]]
    for word in text.split():
        if not pages[-1] or fits([*pages[-1], word]):
            pages[-1].append(word)
            continue
        last = pages.pop()
        ends = [i for i, each in enumerate(last, 1) if each[-1] in CLAUSE_ENDS and 2 * i >= len(last)]
        at = ends[-1] if ends else len(last)
        pages += [last[:at], [*last[at:], word]]
    return tuple(" ".join(page) for page in pages)


@lru_cache(maxsize=64)
def subtitle(text: str, colour: Colour, width: int, height: int) -> Overlay:
    """Return an overlay with the text in lines at the bottom of a picture of this size [px]."""
    font, plain = _font(round(height * SUBTITLE_HEIGHT * 0.78))
    lines = _wrapped(_written(text, plain), font, round(width * SUBTITLE_WIDTH))
    return _drawn(lines, font, colour, width, round(height * 0.94))


@lru_cache(maxsize=8)
def title(text: str, width: int, height: int) -> Overlay:
    """Return an overlay with a title in the lower third of a picture of this size [px]."""
    font, plain = _font(round(height * TITLE_HEIGHT * 0.78))
    lines = _wrapped(_written(text, plain), font, round(width * 0.86))
    return _drawn(lines, font, ROBOT_COLOUR, width, round(height * 0.88))


def _drawn(lines: list[str], font: Font, colour: Colour, width: int, bottom: int) -> Overlay:
    canvas = Image.new("RGBA", (width, bottom))
    pen = ImageDraw.Draw(canvas)
    text = "\n".join(lines)
    box = pen.multiline_textbbox((0, 0), text, font=font, align="center")
    wide, tall = round(box[2] - box[0]), round(box[3] - box[1])
    margin = max(round(tall / len(lines) * 0.45), 2)
    left, top = max((width - wide) // 2 - margin, 0), max(bottom - tall - 2 * margin, 0)
    right, low = min(left + wide + 2 * margin, width), bottom
    pen.rounded_rectangle((left, top, right - 1, low - 1), radius=margin, fill=_BOX)
    pen.multiline_text((left + margin - box[0], top + margin - box[1]), text, font=font, fill=colour, align="center")
    return Overlay(np.asarray(canvas.crop((left, top, right, low))), left, top)


def _wrapped(text: str, font: Font, most: int) -> list[str]:
    """Return the text in lines of similar length, at most `most` pixels wide unless a single word is wider."""
    words = text.split()
    text = " ".join(words)
    for count in range(1, 9):
        wanted = max(font.getlength(text) / count * 1.12, 1.0)
        if count > 1 or wanted <= most * 1.12:
            for width in (min(most, wanted), most):
                lines = _filled(words, font, width)
                if len(lines) <= count and all(font.getlength(line) <= most for line in lines):
                    return lines
    return _filled(words, font, most)


def _filled(words: list[str], font: Font, most: float) -> list[str]:
    lines = [""]
    for word in words:
        longer = f"{lines[-1]} {word}".strip()
        if lines[-1] and font.getlength(longer) > most:
            lines.append(word)
        else:
            lines[-1] = longer
    return lines


@lru_cache(maxsize=4)
def _font(size: int) -> tuple[Font, bool]:
    """Return a font of this height [px], and True if the font has only ASCII letters."""
    for name in FONTS:
        try:
            return ImageFont.truetype(name, size, layout_engine=ImageFont.Layout.BASIC), False
        except OSError:
            continue
    return ImageFont.load_default(size), True


def _written(text: str, plain: bool) -> str:
    """Return the text without unprintable characters, and without accents if the font is `plain`."""
    text = "".join(c for c in text if c.isprintable() or c.isspace())
    if not plain:
        return text
    spread = unicodedata.normalize("NFKD", text).replace("–", "-").replace("—", "-")
    return "".join(c for c in spread if c.isascii() or c in "“”‘’…")
