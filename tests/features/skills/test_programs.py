"""The programs of skills: performed, cancelled, replaced, and ended if they misbehave."""

import json
import os
import signal
import sys
import time
from collections.abc import Iterator
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from lumen.features.skills import performer, workshop
from lumen.features.skills.process import SkillProcess
from lumen.language.commands import Rest, Stop
from lumen.project import load
from tests.features.skills.changing import project_in
from tests.features.skills.stage import Stage, stage
from tests.provided import program
from tests.waiting import APART, HANG, UNLIMITED, until

pytestmark = pytest.mark.process

CODE = "skills/act.py"
HEAD = "import os, sys, time, threading, subprocess\nfrom lumen.skills import skill\n\n@skill\ndef act(call):\n"


@pytest.fixture
def acting(tmp_path: Path) -> Iterator[Stage]:
    """A project whose skill `act` the tests write."""
    root = project_in(
        tmp_path, {"skills/act.yaml": ("", "performed-by: {python: skills/act.py}\nmemory: 120\n"), CODE: ("", "\n")}
    )
    with stage(root) as made:
        yield made


def code(made: Stage, body: str) -> None:
    """Write the body of the skill."""
    made.write(CODE, HEAD + "".join(f"    {line}\n" for line in body.splitlines()))


def until_there(file: Path) -> str:
    """Return code with which a skill waits until this file exists."""
    return f"while not os.path.exists({str(file)!r}): call.wait(0.01)"


def alive(pid: int) -> bool:
    try:
        return Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0] != "Z"
    except OSError:
        return False


def test_a_skill_gets_its_arguments_waits_and_returns_a_result(tmp_path: Path) -> None:
    with stage(project_in(tmp_path)) as made:
        assert made.perform("spray", duration="20ms", nozzle="right") == {"litres": 0.2}
        assert made.perform("spray", duration="20ms", nozzle="left") == {"litres": 0.2}
        assert made.told == ["spraying with the right nozzle", "spraying with the left nozzle"]
        assert made.reported == []


def test_one_process_performs_call_after_call_and_calls_at_once_have_several(acting: Stage) -> None:
    code(acting, 'print(f"pid {os.getpid()}")\n' + until_there(acting.root / "go"))
    (acting.root / "go").touch()
    acting.perform("act")
    acting.perform("act")
    assert len(set(acting.told)) == 1
    (acting.root / "go").unlink()
    ids = [acting.start("act"), acting.start("act")]
    acting.until(lambda: len(acting.told) == 4)
    (acting.root / "go").touch()
    for id in ids:
        acting.end(id)
    assert len(set(acting.told)) == 2


def test_one_call_too_many_at_once_is_refused(acting: Stage, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(workshop, "MAX_PROCESSES", 2)
    code(acting, "print('ready')\ncall.wait(1000)")
    for count in (1, 2):
        acting.start("act")
        acting.until(lambda count=count: acting.told == ["ready"] * count)
    assert acting.perform("act") == "2 calls of `act` are under way already"


@pytest.mark.parametrize(
    ("body", "reason"),
    [
        ("1 / 0", "`act` failed: act.py:6: ZeroDivisionError: division by zero"),
        ("sys.exit('no water')", "`act` failed: act.py:6: SystemExit: no water"),
        ("return 3", "`act` answered 3: answer an object with names and values"),
        ("return {1, 2}", "`act` failed: TypeError: Object of type set is not JSON serializable"),
        ("call.wait('soon')", "`act` failed: act.py:6: ValueError: `soon` is not a duration"),
        (
            "print('so long')\nos._exit(4)",
            "the program of `act` is gone: it ended with exit code 4 after the line `so long`",
        ),
        ("os.kill(os.getpid(), 11)", "the program of `act` is gone: it was ended by SIGSEGV"),
        ("os.closerange(3, 20)\ntime.sleep(1000)", "the program of `act` is gone: it closed its standard output"),
        ("print('x' * 2_000_000)", "the program of `act` is gone: it printed more than 1 MB during a call"),
        ("while True: print('water')", "the program of `act` is gone: it printed more than 1 MB during a call"),
        ("while True: call.say('water')", "the program of `act` was killed: it had more than 200 texts and messages"),
        ("x = bytearray(200_000_000)\ncall.wait(1000)", "the program of `act` was killed: it used"),
        ("x = bytearray(700_000_000)", "`act` failed: act.py:6: MemoryError"),
    ],
)
def test_a_skill_that_fails_or_misbehaves_costs_its_verb_only(acting: Stage, body: str, reason: str) -> None:
    code(acting, body)
    assert acting.perform("act")[: len(reason)] == reason
    code(acting, "return {}")
    assert acting.perform("act") == {}


@pytest.mark.parametrize(
    ("body", "killed"),
    [
        ("print('ready')\ncall.wait(1000)", False),
        ("print('ready')\nwhile not call.cancelled: time.sleep(0.01)", False),
        ("print('ready')\ntime.sleep(1000)", True),
        ("print('ready')\nwhile True: pass", True),
        ("print('ready')\nos.dup2(os.open('/dev/null', 0), 0)\nthreading.Event().wait()", True),
    ],
)
@pytest.mark.parametrize("stop", [Stop(), Rest(), None])
def test_a_stop_never_waits_for_a_skill_and_one_that_hangs_is_killed(
    acting: Stage, body: str, killed: bool, stop: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    if not killed:
        monkeypatch.setattr(performer, "GRACE", UNLIMITED)  # a slow machine must not kill it
    code(acting, body)
    id = acting.start("act")
    acting.until_told("ready")
    (process,) = acting.workshop.processes("act")
    if stop:
        acting.executor.start("stop", stop)
    else:
        acting.executor.cancel(id)
    acting.tick()
    assert acting.events[id].name == f"cancelled.command.{id}"  # at the very next tick
    acting.until(lambda: not acting.workshop.is_busy("act"))
    assert process.alive is not killed
    told = ["the program of `act` was killed: it did not end within 500 ms of its cancel"]
    assert acting.reported == (told if killed else [])


def test_a_cancel_that_comes_too_late_does_no_harm(acting: Stage) -> None:
    code(acting, "print(os.getpid())")
    acting.perform("act")
    (process,) = acting.workshop.processes("act")
    process.order(cancel=True)
    process.order(go=True)
    acting.perform("act")
    assert len(set(acting.told)) == 1


def test_all_children_of_a_killed_program_end_whatever_they_do_to_get_away(acting: Stage) -> None:
    # `print` writes a number and the end of its line apart, between which another child may write.
    child = "import os, time; os.setsid(); os.write(1, f'{os.getpid()}\\n'.encode()); time.sleep(1000)"
    code(acting, f"for _ in range(3): subprocess.Popen([sys.executable, '-c', {child!r}])\ntime.sleep(1000)")
    id = acting.start("act")
    acting.until(lambda: len(acting.told) == 3)
    pids = [int(line) for line in acting.told]
    assert all(alive(pid) for pid in pids)
    acting.executor.cancel(id)
    until(lambda: not any(alive(pid) for pid in pids))


def test_a_second_answer_is_printed_and_ignored(acting: Stage) -> None:
    command = [
        sys.executable,
        "-c",
        'import sys\nfor line in sys.stdin:\n print(\'{"result": {}}\\n{"result": {}}\', flush=True)',
    ]
    made = SkillProcess("twice", command, str(acting.root), 100, acting.told.append)
    made.begin("twice", {}, lambda: None)
    assert made.await_end(HANG)
    until(lambda: acting.told)
    assert acting.told == ['an answer came after the end of its call, and is ignored: {"result": {}}']
    assert made.take() == [{"result": {}}]
    made.close()


def test_a_group_is_killed_once_since_its_number_may_be_another_programs_later(
    acting: Stage, monkeypatch: pytest.MonkeyPatch
) -> None:
    made = SkillProcess("short", ["sh", "-c", "exit 1"], str(acting.root), 100, acting.told.append)
    assert made.await_end(HANG)
    made.kill()  # here at the latest, if not by the thread that noticed the end
    killed = list[int]()
    monkeypatch.setattr(os, "killpg", lambda group, number: killed.append(group))
    made.close()
    assert killed == []


def test_a_call_of_a_program_that_has_just_ended_ends(acting: Stage) -> None:
    made = SkillProcess("short", ["sh", "-c", "exit 1"], str(acting.root), 100, acting.told.append)
    until(made.has_news)
    made.begin("short", {}, lambda: None)
    assert made.has_news()
    assert made.take() == [{"ended": "it ended with exit code 1"}]
    made.close()


def test_the_end_of_a_program_is_noticed_if_its_child_keeps_the_output_open(acting: Stage) -> None:
    command = ["sh", "-c", f"setsid sleep 1000 & {APART}; echo $! > child; exit 1"]
    made = SkillProcess("gone", command, str(acting.root), 100, acting.told.append)
    made.begin("gone", {}, lambda: None)
    assert made.await_end(HANG)
    until(lambda: made.has_news())
    assert made.take() == [{"ended": "it ended with exit code 1"}]
    made.close()
    os.kill(int((acting.root / "child").read_text()), signal.SIGKILL)


def test_a_warm_program_that_crashes_is_started_again_only_after_the_pause(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    now = 100.0
    monkeypatch.setattr(workshop, "time", SimpleNamespace(monotonic=lambda: now, time=time.time))
    manifest = "performed-by: {python: skills/act.py}\nwarm: true\n"
    root = project_in(tmp_path, {"skills/act.yaml": ("", manifest), CODE: ("", f"{HEAD}    pass\n1 / 0\n")})
    with stage(root) as made:
        for crashes in (1, 2, 3):
            for _ in range(3):
                made.workshop.look()
            assert made.workshop.states["act"]["crashes"] == len(made.reported) == crashes
            now += 60.0


def test_a_program_that_crashed_is_started_again_after_a_pause(acting: Stage, monkeypatch: pytest.MonkeyPatch) -> None:
    now = 100.0
    monkeypatch.setattr(workshop, "time", SimpleNamespace(monotonic=lambda: now, time=time.time))
    code(acting, "os._exit(1)")
    assert "exit code 1" in acting.perform("act")
    for pause in (0.5, 1.0):
        id = acting.start("act")
        acting.until_told(f"its program is started again in {pause} s")
        assert acting.workshop.states["act"]["state"] == "paused"
        now += pause
        assert "exit code 1" in acting.end(id)
    assert len([line for line in acting.told if "again" in line]) == 2


def test_changed_code_is_used_at_the_next_call_and_nothing_is_broken_off(acting: Stage) -> None:
    code(acting, f"print('old')\n{until_there(acting.root / 'go')}\nreturn {{'version': 1}}")
    first = acting.start("act")
    acting.until_told("old")
    code(acting, "return {'version': 2}")
    assert acting.perform("act") == {"version": 2}
    (acting.root / "go").touch()
    assert acting.end(first) == {"version": 1}


def test_code_that_python_cannot_read_is_reported_once_and_the_old_code_stays(acting: Stage) -> None:
    code(acting, "return {'version': 1}")
    acting.perform("act")
    code(acting, "return {'version': ")
    acting.workshop.look()
    assert acting.perform("act") == {"version": 1}
    assert acting.reported == [
        "skills/act.py:6:12 Python can't read this: '{' was never closed; the code before stays in use"
    ]
    code(acting, "return {'version': 3}")
    assert acting.perform("act") == {"version": 3}


def test_each_call_of_code_that_python_cannot_read_has_the_place_of_the_error(acting: Stage) -> None:
    code(acting, "return {'version': ")
    for _ in range(3):
        assert acting.perform("act") == "skills/act.py:6:12 Python can't read this: '{' was never closed"
    assert len(acting.reported) == 1
    code(acting, "return {'version': 2}")
    assert acting.perform("act") == {"version": 2}


def test_a_module_beside_the_code_counts_as_code(acting: Stage) -> None:
    acting.write("skills/pump.py", "LITRES = 1\n")
    code(acting, "import pump\nreturn {'litres': pump.LITRES}")
    assert acting.perform("act") == {"litres": 1}
    acting.write("skills/pump.py", "LITRES = 22\n")
    assert acting.perform("act") == {"litres": 22}


def test_a_skill_reports_progress_speaks_and_publishes(acting: Stage) -> None:
    bodies: list[Any] = []
    acting.bus.subscribe("#", lambda message: bodies.append(message.body))
    code(acting, "call.progress(0.5, 'half')\ncall.say('Fog!')\ncall.publish('nowhere', 1)")
    assert acting.perform("act") == {}
    assert acting.told == ["50% half"]
    assert acting.reported == ["there is no route `nowhere`"]
    until(lambda: bodies)
    assert bodies == [{"type": "texttospeech", "method": "say", "parameter": {"text": "Fog!", "language": "en"}}]


def test_a_removed_skill_is_ended_and_refused(acting: Stage) -> None:
    code(acting, "print('ready')\ncall.wait(1000)")
    id = acting.start("act")
    acting.until_told("ready")
    (acting.root / "skills/act.yaml").unlink()
    acting.workshop.use(load(acting.root))
    assert acting.end(id) == "the program of `act` is gone: the skill was removed"
    assert acting.perform("act") == "the project has no skill `act` any more"


def test_a_skill_in_javascript(acting: Stage, tmp_path: Path) -> None:
    node = program("node")
    script = (
        "const lines = require('readline').createInterface({input: process.stdin});\n"
        "lines.on('line', line => {\n"
        "  const order = JSON.parse(line);\n"
        "  if ('call' in order && order.arguments) {\n"
        "    console.log('hello from node');\n"
        "    console.log(JSON.stringify({call: order.call, result: {joke: 'fog ' + order.skill}}));\n"
        "  }\n"
        "});\n"
    )
    acting.write("skills/joke.js", script)
    acting.write("skills/joke.yaml", f"performed-by: {{command: [{json.dumps(str(node))}, skills/joke.js]}}\n")
    with stage(acting.root) as made:
        assert made.perform("joke") == {"joke": "fog joke"}
        assert made.told == ["hello from node"]


def test_a_command_that_is_not_there_fails_with_its_name(acting: Stage) -> None:
    acting.write("skills/joke.yaml", "performed-by: {command: [nowhere-to-be-found]}\n")
    with stage(acting.root) as made:
        assert made.perform("joke") == (
            "the program of `joke` can't be started: nowhere-to-be-found: no such file or directory"
        )


def test_an_idle_program_uses_no_processor_time(acting: Stage) -> None:
    code(acting, "return {}")
    acting.perform("act")
    (process,) = acting.workshop.processes("act")
    until(lambda: _sleeps(process))  # its answer may arrive before it has finished
    before = _ticks(process)
    acting.perform("spray", duration="300ms", nozzle="left")
    assert _ticks(process) == before


def _sleeps(process: SkillProcess) -> bool:
    """Return whether all threads of the process wait."""
    stats = [file.read_text() for file in Path(f"/proc/{process.pid}/task").glob("*/stat")]
    return bool(stats) and all(stat.rpartition(")")[2].split()[0] == "S" for stat in stats)


def _ticks(process: SkillProcess) -> int:
    fields = Path(f"/proc/{process.pid}/stat").read_text().rpartition(")")[2].split()
    return int(fields[11]) + int(fields[12])


def test_nothing_of_a_skill_runs_in_the_process_of_the_engine(acting: Stage) -> None:
    code(acting, "print(os.getpid())")
    acting.perform("act")
    assert int(acting.told[0]) != os.getpid()
    assert "act" not in sys.modules
