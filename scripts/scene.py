"""Writes models/scene.xml: the robot on a floor, for MuJoCo's viewer, with the body's postures as keyframes.

python scripts/scene.py
"""

import sys
from collections.abc import Iterable
from pathlib import Path

import mujoco
import numpy as np

import lumen
from lumen.features.simulation.entity import Nao

ROOT = Path(__file__).parents[1]
POSTURES = ("Stand", "StandInit", "StandZero", "Crouch")
SCENE = """<mujoco model="nao scene">
  <!--
    The NAO on a floor, free to fall: `python -m mujoco.viewer --mjcf models/scene.xml`. Written by scripts/scene.py;
    the keyframes are postures of nao.yaml. `attach` needs MuJoCo 3.2.
  -->
  <option timestep="0.002" integrator="implicitfast" cone="pyramidal"/>
  <statistic center="0 0 0.3" extent="0.8"/>
  <visual>
    <headlight diffuse="0.6 0.6 0.6" ambient="0.3 0.3 0.3" specular="0 0 0"/>
    <rgba haze="0.15 0.25 0.35 1"/>
    <global azimuth="150" elevation="-15" offwidth="1920" offheight="1080"/>
  </visual>

  <asset>
    <texture name="sky" type="skybox" builtin="gradient" rgb1="0.3 0.5 0.7" rgb2="0 0 0" width="512" height="3072"/>
    <texture name="floor" type="2d" builtin="checker" mark="edge" rgb1="0.2 0.3 0.4" rgb2="0.1 0.2 0.3"
      markrgb="0.8 0.8 0.8" width="300" height="300"/>
    <material name="floor" texture="floor" texuniform="true" texrepeat="5 5" reflectance="0.2"/>
    <model name="nao" file="nao.xml"/>
  </asset>

  <worldbody>
    <light pos="0 0 3.5" dir="0 0 -1" directional="true"/>
    <geom name="floor" type="plane" size="0 0 0.05" material="floor" friction="0.8 0.005 0.0001" solref="0.015 1"/>
    <body name="nao">
      <freejoint name="nao"/>
      <attach model="nao" body="Torso" prefix="nao/"/>
    </body>
  </worldbody>

  <keyframe>
{keys}
  </keyframe>
</mujoco>
"""


def scene(models: Path) -> str:
    """Return the text of the file; the robot's MJCF and meshes are in `models`."""
    nao = Nao(lumen.load(ROOT).body, models)
    empty = SCENE.format(keys="").replace('file="nao.xml"', f'file="{models / "nao.xml"}"')
    model = mujoco.MjModel.from_xml_string(empty)
    motors = [model.actuator(number).name.removeprefix("nao/") for number in range(model.nu)]
    return SCENE.format(keys="\n".join(_key(name, model, motors, nao) for name in POSTURES))


def _key(posture: str, model: mujoco.MjModel, motors: list[str], nao: Nao) -> str:
    pose, angles = nao.pose(posture), nao.body.postures[posture]
    joints = [joint.name for joint in nao.mjcf_model.find_all("joint")]
    qpos = np.zeros(model.nq)
    qpos[:7] = *pose.xpos, *pose.xquat
    for joint, value in zip(joints, pose.qpos, strict=True):
        qpos[model.joint(f"nao/{joint}").qposadr[0]] = value
    return (
        f'    <key name="{posture}"\n      qpos="{_row(qpos)}"\n      ctrl="{_row(angles[name] for name in motors)}"/>'
    )


def _row(values: Iterable[float]) -> str:
    return " ".join(f"{value:.6g}" for value in values)


if __name__ == "__main__":
    (ROOT / "models/scene.xml").write_text(scene(ROOT / "models"), "utf-8")
    sys.exit(0)
