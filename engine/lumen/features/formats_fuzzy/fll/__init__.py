"""FuzzyLite Language (FLL): an engine of FuzzyLite as a controller file, and a controller as an engine."""

from lumen.formats.fll.reader import read_fll
from lumen.formats.fll.writer import write_fll

__all__ = ["read_fll", "write_fll"]
