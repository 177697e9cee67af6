"""`python -m tests.mistakes` prints how many of people's common mistakes lint reports well, and the others."""

import argparse
import sys
import time

from lumen.lint import check_files
from tests.mistakes.rows import rows
from tests.mistakes.scores import Judged, judge, score


def main() -> int:
    parser = argparse.ArgumentParser(prog="python -m tests.mistakes", description=__doc__)
    parser.add_argument("--only", default="", help="rows whose name holds this text, with all that lint says of them")
    options = parser.parse_args()
    began = time.process_time()
    judged = [judge(row) for row in rows("table") if options.only in row.name]
    for each in judged:
        if options.only or not (each.placed and each.named and each.single):
            print(told(each))
    alarms, legal = 0, 0
    for row in rows("legal") if not options.only else ():
        legal += 1
        for diagnostic in check_files(row.root, row.files)[1]:
            alarms += 1
            print(f"# {row.name}: a false alarm\n    {diagnostic}")
    if judged:
        found = score(judged)
        placed, named, single = (f"{part:.1f} %" for part in found.percent())
        print(f"{found.rows} mistakes: right line {placed}, names the remedy {named}, one finding {single}")
    print(f"{legal} legal variants: {alarms} false alarms; {time.process_time() - began:.0f} s of CPU")
    return int(alarms > 0 or any(not (j.placed and j.named and j.single) for j in judged))


def told(judged: Judged) -> str:
    row = judged.row
    what = [] if judged.placed else ["another line"]
    what += [] if judged.named else [f"does not say {' or '.join(row.says)}"]
    what += [] if judged.single else [f"{len(judged.found)} findings"]
    return "\n".join([f"# {row.name} ({row.file}:{row.line}): {', '.join(what)}", *(f"    {d}" for d in judged.found)])


if __name__ == "__main__":
    sys.exit(main())
