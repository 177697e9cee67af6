import pytest

import lumen
from lumen.language.projects import Project
from tests.tour.names import ROOT


@pytest.fixture(scope="session")
def project() -> Project:
    """The shipped exhibition."""
    return lumen.load(ROOT)
