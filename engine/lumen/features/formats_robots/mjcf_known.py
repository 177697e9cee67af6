"""The parts of an MJCF that a body file needs, and those that only MuJoCo uses, which stay in the model.

The names are those of MuJoCo 3 (`mj_printSchema`). MuJoCo rejects any other name.
"""

from lumen.project.formats.known import FormatTable, Known

_STAYS = "used only by MuJoCo; stays in the model"


def _known(read: str, stays: str) -> Known:
    return Known(frozenset(read.split()), meaningless=dict.fromkeys(stays.split(), _STAYS))


_FRAME = "name childclass pos quat euler axisangle xyaxes zaxis"
_PARTS = "<joint> <freejoint> <camera> <site> <body> <frame>"
_ELSEWHERE = "<include> <attach> <replicate> <composite> <flexcomp>"
_OF_BODIES = f"<inertial> <geom> <light> <plugin> {_ELSEWHERE}"
_MOTOR = "name class joint gear forcerange ctrlrange"
_MOTOR_STAYS = (
    "actdim actearly actlimited actrange area armature bias biasprm biastype body cogging controller "
    "cranklength cranksite ctrllimited damping dampratio delay diameter dynprm dyntype ffrange force "
    "forcelimited fpmax fvmax gain gainprm gaintype group imax inductance inheritrange input instance "
    "interp jointinparent ki kp kv lengthrange lmax lmin lugre motorconst nominal nsample plugin posrange "
    "range refsite resistance saturation scale site slewmax slidersite tausmooth tendon thermal timeconst "
    "user velrange vmax"
)
ACTUATORS = (
    "position",
    "velocity",
    "motor",
    "general",
    "intvelocity",
    "damper",
    "cylinder",
    "muscle",
    "adhesion",
    "pid",
    "orientation",
    "dcmotor",
    "plugin",
)
_ACTUATORS = " ".join(f"<{name}>" for name in ACTUATORS)
_SENSORS = (
    "<actuatorfrc> <actuatorpos> <actuatorvel> <ballangvel> <ballquat> <camprojection> <clock> <contact> "
    "<distance> <e_kinetic> <e_potential> <force> <frameangacc> <frameangvel> <framelinacc> <framelinvel> "
    "<framepos> <framequat> <framexaxis> <frameyaxis> <framezaxis> <fromto> <insidesite> "
    "<jointactuatorfrc> <jointlimitfrc> <jointlimitpos> <jointlimitvel> <jointpos> <jointvel> "
    "<magnetometer> <normal> <plugin> <rangefinder> <subtreeangmom> <subtreecom> <subtreelinvel> "
    "<tactile> <tendonactuatorfrc> <tendonlimitfrc> <tendonlimitpos> <tendonlimitvel> <tendonpos> "
    "<tendonvel> <torque> <touch> <user> <velocimeter>"
)
KNOWN: FormatTable = {
    "<mujoco>": _known(
        "model <compiler> <default> <worldbody> <actuator> <equality> <sensor> <asset>",
        "<option> <size> <statistic> <visual> <extension> <deformable> <contact> <tendon> <keyframe> <custom>"
        " <include>",
    ),
    "<compiler>": _known(
        "angle eulerseq autolimits",
        (
            "<lengthrange> alignfree assetdir balanceinertia boundinertia boundmass conflict coordinate "
            "discardvisual fitaabb fusestatic inertiafromgeom inertiagrouprange meshdir passthrough savecanonical "
            "savecompiled saveinertial settotalmass strippath texturedir usethread"
        ),
    ),
    "<default>": _known(
        f"class <default> <joint> <camera> {_ACTUATORS}",
        "<mesh> <texture> <material> <geom> <site> <light> <pair> <equality> <tendon> <include>",
    ),
    "<worldbody>": _known(f"{_FRAME} {_PARTS}", _OF_BODIES),
    "<body>": _known(f"{_FRAME} {_PARTS}", f"fuse gravcomp mocap simple sleep user {_OF_BODIES}"),
    "<frame>": _known(f"{_FRAME} {_PARTS}", _OF_BODIES),
    "<joint>": _known(
        "name class type pos axis range limited actuatorfrcrange",
        (
            "actuatorfrclimited actuatorgravcomp armature damping frictionloss group margin ref solimpfriction "
            "solimplimit solreffriction solreflimit springdamper springref stiffness user"
        ),
    ),
    "<freejoint>": _known("name", "align group"),
    "<camera>": _known(
        "name class pos quat euler axisangle xyaxes zaxis fovy",
        ("focal focalpixel ipd mode output principal principalpixel projection resolution sensorsize target user"),
    ),
    "<actuator>": _known(_ACTUATORS, "<include>"),
    **{f"<{name}>": _known(_MOTOR, f"{_MOTOR_STAYS} <plugin> <config>") for name in ACTUATORS},
    "<asset>": _known("<material>", "<mesh> <hfield> <skin> <texture> <model> <include>"),
    "<sensor>": _known("<gyro> <accelerometer>", f"{_SENSORS} <include>"),
    "<equality>": _known("<joint>", "<connect> <weld> <tendon> <flex> <flexvert> <flexstrain> <include>"),
    "<equality> <joint>": _known("joint1 joint2 polycoef active", "class name solimp solref"),
}
