"""`lumen new DIR`: the shipped project, to be made one's own."""

import argparse
import shutil
from pathlib import Path

from lumen.errors import UsageError
from lumen.loading.files import PROJECT_FOLDERS
from lumen.loading.packaged import MAIN_FILE, shipped_root


def configure(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("folder", metavar="DIR", type=Path, help="where to put it; must not exist, or be empty")


def run(options: argparse.Namespace) -> int:
    folder: Path = options.folder
    if folder.exists() and (not folder.is_dir() or any(folder.iterdir())):
        raise UsageError(f"{folder} is there already and not empty: name a new folder")
    source = shipped_root()
    try:
        folder.mkdir(parents=True, exist_ok=True)
        shutil.copy(source / MAIN_FILE, folder)
        for name in PROJECT_FOLDERS:
            shutil.copytree(source / name, folder / name, dirs_exist_ok=True)
    except OSError as error:
        raise UsageError(f"can't write {error.filename or folder}: {error.strerror}") from None
    print(f"{folder} holds a whole exhibition now. Next:")
    print(f"  cd {folder}")
    print("  lumen run --story visitor    a scripted visitor meets the robot")
    print("  lumen lint                   after every change: what is wrong, and where")
    print("  behaviors/tour.yaml          what the robot does and says; change it while it runs")
    return 0
