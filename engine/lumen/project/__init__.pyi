from lumen.language.projects import Project as Project
from lumen.standalone.project import load as load

__all__ = ["Project", "load"]
