"""No change to an imported file is silent: a changed word or number, or a missing line, changes the result or the
findings. Text between « and » has no meaning for a robot.
"""

import re
from collections.abc import Iterator
from typing import Any

import lumen
from lumen.features.formats_fuzzy.fcl import read_fcl
from lumen.features.formats_fuzzy.fis import read_fis
from lumen.features.formats_fuzzy.fll import read_fll
from lumen.features.formats_robots.reading import read_robot
from lumen.project.formats.conversion_findings import ForeignFileError
from lumen.project.formats.importers import read_gesture
from lumen.project.packaged import shipped_root
from tests.tables import for_each

CONTROLLERS = {"fll": read_fll, "fcl": read_fcl, "fis": read_fis}
BODY = lumen.load(shipped_root()).body

SAMPLES = {
    "mamdani.fis": """\
[System]
«Name='tipper'
»Type='mamdani'
«Version=2.0
NumInputs=2
NumOutputs=1
NumRules=3
»AndMethod='prod'
OrMethod='probor'
ImpMethod='prod'
AggMethod='sum'
DefuzzMethod='bisector'

[Input1]
Name='service'
Range=[0 10]
«NumMFs=3
»MF1='poor':'gaussmf',[1.5 2]
MF2='good':'trapmf',[1 3 5 7]
MF3='great':'sigmf',[2 7.5]

[Input2]
Name='food'
Range=[0 10]
«NumMFs=2
»MF1='rancid':'trimf',[0 1 3]
MF2='delicious':'gbellmf',[2 4 8]

[Output1]
Name='tip'
Range=[0 30]
«NumMFs=3
»MF1='cheap':'trimf',[0 5 10]
MF2='average':'trimf',[10 15 20]
MF3='generous':'trimf',[20 25 30]

[Rules]
1 1, 1 (1) : 2
2 0, 2 (0.5) : «1»
3 -2, 3 (1) : 1
""",
    "sugeno.fis": """\
[System]
«Name='s'
»Type='sugeno'
«NumInputs=1
NumOutputs=1
NumRules=2
»AndMethod='prod'
OrMethod='probor'
DefuzzMethod='wtsum'

[Input1]
Name='x'
Range=[-5 5]
«NumMFs=2
»MF1='small':'zmf',[-4 1]
MF2='large':'pimf',[-1 0 2 4]

[Output1]
Name='y'
Range=[0 1]
«NumMFs=2
»MF1='c':'constant',[0.5]
MF2='l':'linear',[0.2 0.7]

[Rules]
1, 1 (1) : «1»
2, 2 (0.25) : «1»
""",
    "tipper.fcl": """\
FUNCTION_BLOCK «tipper»
VAR_INPUT
  «service : REAL;»
  food : REAL (0 .. 10);
END_VAR
VAR_OUTPUT
  «tip : REAL;»
END_VAR
FUZZIFY service
  TERM poor := (0, 1) (4, 0);
  TERM good := (1, 0) (4, 1) (6, 1) (9, 0);
  TERM great := gauss 9 1.5;
  RANGE := (0 .. 10);
END_FUZZIFY
FUZZIFY food
  TERM rancid := trian 0 1 3;
  TERM delicious := trape 5 7 8 10;
END_FUZZIFY
DEFUZZIFY tip
  TERM cheap := (0, 0) (5, 1) (10, 0);
  TERM generous := trian 20 25 30;
  METHOD : MM;
  DEFAULT := 3;
  RANGE := (0 .. 30);
END_DEFUZZIFY
RULEBLOCK «No1»
  AND : PROD;
  ACT : PROD;
  ACCU : BSUM;
  RULE «1» : IF service IS poor AND food IS rancid THEN tip IS cheap;
  RULE «2» : IF service IS good AND NOT (food IS rancid) THEN tip IS generous WITH 0.5;
  RULE «3» : IF service IS great AND food IS delicious THEN tip IS generous;
END_RULEBLOCK
END_FUNCTION_BLOCK
""",
    "avoid.fll": """\
Engine: «Obstacle»
InputVariable: obstacle
  description: what it sees
  «enabled: true»
  range: 0.000 1.000
  lock-range: true
  term: left Ramp 1.000 0.000
  term: right Triangle 0.000 0.500 1.000
  term: mid Gaussian 0.5 0.1 0.9
OutputVariable: steer
  description: where it goes
  «enabled: true»
  range: 0.000 1.000
  lock-range: true
  aggregation: AlgebraicSum
  defuzzifier: Bisector 50
  default: 0.5
  lock-previous: true
  term: left Ramp 1.000 0.000
  term: right Ramp 0.000 1.000
RuleBlock: «main»
  «enabled: true»
  conjunction: AlgebraicProduct
  disjunction: AlgebraicSum
  implication: AlgebraicProduct
  activation: Threshold >= 0.2
  rule: if obstacle is left or obstacle is mid then steer is right
  rule: if obstacle is right and obstacle is not mid then steer is very left with 0.5
""",
    "wave.motion": """\
#WEBOTS_MOTION,V1.0,RShoulderPitch,HeadYaw
00:00:200,«Pose1»,1.1,0.1
00:00:480,«Pose2»,0.9,*
00:01:000,«Pose3»,1.0,0.2
""",
    "wave.xar": """\
<ChoregrapheBox «xmlns="http://www.aldebaran-robotics.com/schema/choregraphe/box.xsd"» xar_version="3">
<Box «name="root" id="-1" localization="8" tooltip="Root" x="0" y="0"»>
<Timeline enable="1" fps="25" start_frame="2" end_frame="«55»" «size="60"»>
<ActuatorList «model="nao"»>
<ActuatorCurve «name="value"» actuator="RShoulderPitch" «recordable="0"» mute="0" unit="0">
<Key frame="25" value="30">
<Tangent side="right" interpType="bezier" abscissaParam="8" ordinateParam="3" />
</Key>
<Key frame="50" value="60" «smooth="1" symmetrical="0"» />
<Key frame="«60»" value="«70»" />
</ActuatorCurve>
<ActuatorCurve «name="value"» actuator="RHand" «recordable="0"» mute="0" unit="1">
<Key frame="30" value="0.5" />
</ActuatorCurve>
</ActuatorList>
</Timeline>
</Box>
</ChoregrapheBox>
""",
    "wave.py": """\
«from naoqi import ALProxy
motion = ALProxy("ALMotion", "nao.local", 9559)
»
def wave(angle):
    names = ["RShoulderPitch", "RElbowRoll"]
    times = [[1.0, 2.0], [1.5, 2.5]]
    «motion».angleInterpolation(names, [[angle, 1.0], [0.6, 1.2]], times, «True»)
    «time».sleep(0.5)
    «tts».say("Hello")

«posture».goToPosture("StandInit", 0.8)
for «_» in range(2):
    wave(0.5)
«motion».angleInterpolation("HeadYaw", 0.4, 1.0, «True»)
«motion».angleInterpolationBezier(["Head"], [[2.0], [2.0]], [[[0.3, [1, «0.0, 0.0»]]], [[0.1, [1, «0.0, 0.0»]]]])
""",
    "bot.urdf": """\
<robot name="«bot»">
<link name="base"/>
<link name="neck"/>
<link name="face"/>
<link name="finger"/>
<joint name="head_yaw" type="revolute"><parent link="base"/><child link="neck"/>«<origin xyz="0 0 1"/>»
«<axis xyz="0 0 1"/>»
<limit lower="-1.5" upper="1.4" effort="10" velocity="2"/></joint>
<joint name="head_pitch" type="revolute"><parent link="neck"/><child link="face"/>«<axis xyz="0 1 0"/>»
<limit lower="-0.5" upper="0.7" effort="8" velocity="3"/></joint>
<joint name="finger_joint" type="revolute"><parent link="face"/><child link="finger"/>«<axis xyz="0 1 0"/>»
<limit «lower="0.1" upper="0.5" effort="1" velocity="1"»/>
<mimic joint="head_pitch" multiplier="«0.5»" offset="«0.1»"/></joint>
</robot>
""",
    "bot.xml": """\
<mujoco «model="bot"»>
<compiler angle="degree" autolimits="true"/>
<default>
<default class="head"><joint axis="«0 0 1»" range="«-»90 80"/></default>
</default>
<worldbody>
<body name="base" «pos="0 0 0.5"»>
<body name="«neck»" «pos="0 0 0.2"»>
<joint name="head_yaw" type="hinge" class="head" actuatorfrcrange="-5 5"/>
<body name="face" «pos="0 0 0.1"»>
<joint name="head_pitch" «axis="0 1 0"» range="-30 40"/>
</body>
</body>
</body>
</worldbody>
<actuator>
<position name="«m1»" joint="head_yaw" ctrlrange="-1 1"/>
<motor name="«m2»" joint="head_pitch" gear="«3»" ctrlrange="-2 2.5"/>
</actuator>
</mujoco>
""",
}

_WORD = re.compile(r"[+-]?\d+(?:\.\d+)?|[A-Za-z_][\w-]*")
_FREE = re.compile("«[^»]*»", re.DOTALL)


def imported(name: str, text: str) -> Any:
    """Import a file; return the result and the findings, or the reason for a refusal."""
    try:
        if name.endswith((".urdf", ".xml")):
            return read_robot(name, text.encode(), "bot", "bot.xml")
        read = CONTROLLERS.get(name.rpartition(".")[2])
        return read(name, text.encode(), "sample") if read else read_gesture(name, text.encode(), BODY)
    except ForeignFileError as error:
        return error.diagnostic


def changes(text: str) -> Iterator[tuple[str, str]]:
    """Yield a description of each change, and the text with only that change."""
    free = [match.span() for match in _FREE.finditer(text)]
    plain = str.maketrans("", "", "«»")
    for match in _WORD.finditer(text):
        if not any(begin <= match.start() < end for begin, end in free):
            word, line = match[0], text.count("\n", 0, match.start()) + 1
            for new in _others(word):
                changed = text[: match.start()] + new + text[match.end() :]
                yield f"line {line}: {word} -> {new or 'nothing'}", changed.translate(plain)
    for match in re.finditer(r".+\n", text):
        if not any(begin < match.end() and match.start() < end for begin, end in free):
            yield f"without: {match[0].strip()}", (text[: match.start()] + text[match.end() :]).translate(plain)


def _others(word: str) -> tuple[str, ...]:
    if not word[-1].isdigit() or word[0].isalpha():
        return f"{word}q", ""
    more = f"{float(word) + 0.37:g}" if "." in word else str(int(word) + 1)
    return more, f"q{word}", *([f"-{word.lstrip('+')}"] if word[0] != "-" and float(word) else [])


@for_each("name", list(SAMPLES))
def test_no_word_and_no_line_changes_silently(name: str) -> None:
    plain = imported(name, SAMPLES[name].replace("«", "").replace("»", ""))
    assert isinstance(plain, tuple), plain
    tried = list(changes(SAMPLES[name]))
    assert len(tried) > 20
    assert [what for what, text in tried if imported(name, text) == plain] == []
