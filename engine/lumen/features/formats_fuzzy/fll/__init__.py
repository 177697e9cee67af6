"""Import of FuzzyLite Language (FLL), which describes engines, as controller files, and export of controllers."""

from lumen.features.formats_fuzzy.fll.reader import read_fll
from lumen.features.formats_fuzzy.fll.writer import write_fll

__all__ = ["read_fll", "write_fll"]
