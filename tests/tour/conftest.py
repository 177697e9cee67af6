from pathlib import Path

import pytest

import lumen
from lumen.language.projects import Project
from tests import ROOT
from tests.copying import copied_project


@pytest.fixture(scope="session")
def project() -> Project:
    """The shipped exhibition."""
    return lumen.load(ROOT)


@pytest.fixture
def copy(tmp_path: Path) -> Path:
    """A copy of the shipped exhibition, to be changed."""
    return copied(tmp_path)


def copied(folder: Path) -> Path:
    """Copy the shipped exhibition into the folder, and return the folder."""
    return copied_project(ROOT, folder)
