"""Import and export of controllers as engines in FuzzyLite Language (FLL)."""

from lumen.features.formats_fuzzy.fll.reader import read_fll
from lumen.features.formats_fuzzy.fll.writer import write_fll

__all__ = ["read_fll", "write_fll"]
