"""A ticket on paper, by the command $TICKET_COMMAND; without it the transcript shows the ticket."""

import os
import shlex
import subprocess
import textwrap

from lumen.skills import skill


@skill
def ticket(call, text):
    lines = textwrap.wrap(text, 32)
    if command := os.environ.get("TICKET_COMMAND"):
        subprocess.run(shlex.split(command), input="\n".join(lines), text=True, timeout=10, check=True)
    for number, line in enumerate(lines, 1):
        print(line)
        call.progress(number / len(lines))
    return {"lines": len(lines)}
