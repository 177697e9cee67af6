"""FuzzyLite Language (FLL): an engine of FuzzyLite as a controller file, and a controller as an engine."""

from lumen.features.formats_fuzzy.fll.reader import read_fll
from lumen.features.formats_fuzzy.fll.writer import write_fll

__all__ = ["read_fll", "write_fll"]
