import shutil
from pathlib import Path

import pytest

import lumen
from lumen.language.projects import Project
from lumen.project.project_folders import MAIN_FILE
from tests import ROOT
from tests.copying import SHIPPED_FOLDERS


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
    shutil.copy(ROOT / MAIN_FILE, folder)
    for part in SHIPPED_FOLDERS:
        shutil.copytree(ROOT / part, folder / part)
    return folder
