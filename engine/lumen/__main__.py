"""`python -m lumen`."""

import sys

from lumen.cli.main import main

sys.exit(main())
