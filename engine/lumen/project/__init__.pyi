from lumen.language.projects import Project as Project
from lumen.project import load as load

__all__ = ["Project", "load"]
